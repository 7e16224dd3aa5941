"use strict";
// Profile by depth, cells and experiments of a scalar, and effect sizes, as charts.
(() => {
  const page = window.cytodisk;
  const { byId } = page;
  const chartState = { scalar: 0 };
  page.chartState = chartState;
  const { svg } = page;
  const MOST_DOTS = 1500; // cells of a condition that are drawn

  const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
  const colourOf = (condition) => page.data.colours[condition] ?? "#777777";
  const replace = (id, element) => byId(id).replaceChildren(element);

  // One line an experiment, and the mean of experiments of each condition in bold.
  page.drawProfiles = () => {
    const { data } = page;
    const channel = data.channels[page.atlasState.channel]?.name;
    const lines = data.profiles.filter((line) => line.channel === channel && data.conditions.includes(line.condition));
    byId("profiles").parentElement.hidden = !lines.some((line) => line.layer.length > 1); // one layer has no depth
    if (byId("profiles").parentElement.hidden) return;
    const increases = (values) => values.every((value, k) => page.known(value) && (k === 0 || value > values[k - 1]));
    const deep = lines.every((line) => increases(line.depth)); // not so in a nucleus
    const xs = (line) => (deep ? line.depth : line.layer);
    const x = page.range(lines.flatMap(xs), 0.04);
    const y = page.range(lines.flatMap((line) => line.mean));
    const unit = data.depth_unit ? ` (${data.depth_unit})` : "";
    const inside = data.disk?.cytoplasm_layers;
    const layersLabel = `layer, from the edge (0) inwards${inside ? `; nucleus from ${inside}` : ""}`;
    const xLabel = deep ? `median depth below the cell's edge${unit}` : layersLabel;
    const chart = page.chart({ width: 430, height: 300, x, y, xLabel, yLabel: data.channels[page.atlasState.channel].value, label: `profile of ${channel} by depth, a line an experiment` });
    for (const line of lines) {
      const path = { d: page.linePath(chart, xs(line), line.mean), fill: "none", stroke: colourOf(line.condition), "stroke-width": 1, "stroke-opacity": 0.45 };
      const words = `${line.condition}${line.experiment ? `, ${line.experiment}` : ""}`;
      chart.marks.append(svg("path", path, svg("title", {}, words)));
    }
    for (const condition of data.conditions) {
      const own = lines.filter((line) => line.condition === condition);
      if (!own.length) continue;
      const layers = [...new Set(own.flatMap((line) => line.layer))].sort((a, b) => a - b);
      const at = (array) => layers.map((layer) => mean(own.map((line) => line[array][line.layer.indexOf(layer)]).filter(page.known)));
      const path = page.linePath(chart, deep ? at("depth") : layers, at("mean"));
      chart.marks.append(svg("path", { d: path, fill: "none", stroke: colourOf(condition), "stroke-width": 3 }));
    }
    replace("profiles", chart.root);
  };

  // A place beside the middle that is the same at each drawing.
  const jitter = (k) => ((((k + 1) * 0.6180339887) % 1) - 0.5) * 0.5;

  page.drawScalar = () => {
    const { data } = page;
    const scalar = data.scalars[chartState.scalar];
    if (!scalar) return;
    const values = Array.from(data.cells.values[scalar.name].values);
    const { condition, experiment, name, link } = data.cells;
    const rows = values.map((value, k) => ({ value, k, condition: condition[k], experiment: experiment[k] })).filter((row) => page.known(row.value));
    const xNames = data.conditions.map((words, at) => ({ at, label: words.length > 18 ? `${words.slice(0, 17)}…` : words }));
    const yLabel = `${scalar.label}${scalar.unit ? ` (${scalar.unit})` : ""}`;
    const y = page.range(rows.map((row) => row.value));
    const x = [-0.6, data.conditions.length - 0.4];
    const chart = page.chart({ width: 430, height: 340, x, y, xNames, yLabel, label: `${scalar.label} of each cell and experiment by condition` });
    const shown = data.conditions.map((words) => rows.filter((row) => row.condition === words)).map((own) => {
      const every = Math.max(own.length / MOST_DOTS, 1);
      const drawn = Array.from({ length: Math.min(own.length, MOST_DOTS) }, (_, k) => own[Math.floor(k * every)]);
      return { drawn, all: own.length };
    });
    const opacity = rows.length > 400 ? 0.18 : 0.35;
    for (const row of shown.flatMap(({ drawn }) => drawn)) {
      const at = data.conditions.indexOf(row.condition);
      const words = `${name[row.k]}: ${page.digits(row.value)} ${scalar.unit}`;
      const go = link[row.k] ? () => (location.href = page.cellAddress(link[row.k], scalar.name)) : null;
      const look = { fill: colourOf(row.condition), "fill-opacity": opacity, class: go ? "goes" : null, onclick: go };
      chart.marks.append(svg("circle", { cx: chart.toX(at + jitter(row.k)), cy: chart.toY(row.value), r: 3.2, ...look }, svg("title", {}, words)));
    }
    const names = [...new Set(rows.map((row) => row.experiment))].filter(Boolean);
    const middles = new Map();
    for (const one of names) {
      data.conditions.forEach((words, at) => {
        const own = rows.filter((row) => row.condition === words && row.experiment === one).map((row) => row.value);
        if (own.length) middles.set(`${at} ${one}`, { at, one, words, value: mean(own), cells: own.length });
      });
    }
    for (const one of names) {
      const own = [...middles.values()].filter((middle) => middle.one === one);
      if (own.length < 2) continue; // of a paired design
      const path = page.linePath(chart, own.map(({ at }) => at), own.map(({ value }) => value));
      chart.marks.append(svg("path", { d: path, fill: "none", stroke: "#888888", "stroke-width": 1.2 }));
    }
    for (const { at, one, words, value, cells } of middles.values()) {
      const own = [...middles.values()].filter((middle) => middle.at === at).map((middle) => middle.one);
      const number = names.length === own.length ? names.indexOf(one) : own.indexOf(one);
      const spread = own.length > 1 ? (own.indexOf(one) / (own.length - 1) - 0.5) * 0.4 : 0;
      const shift = names.length === own.length && data.conditions.length > 1 ? 0 : spread;
      const look = { fill: colourOf(words), stroke: "#111111", "stroke-width": 1.2 };
      const title = svg("title", {}, `${one}, ${words}: mean ${page.digits(value)} ${scalar.unit} of ${cells} cells`);
      const mark = page.mark(number, 7, chart.toX(at + shift), chart.toY(value), look);
      mark.append(title);
      chart.marks.append(mark);
    }
    data.conditions.forEach((words, at) => {
      const own = [...middles.values()].filter((middle) => middle.at === at).map((middle) => middle.value);
      if (!own.length) return;
      const [x1, x2, height] = [chart.toX(at - 0.32), chart.toX(at + 0.32), chart.toY(mean(own))];
      chart.marks.append(svg("path", { d: `M${x1} ${height}H${x2}`, stroke: "#111111", "stroke-width": 2 }));
    });
    replace("superplot", chart.root);
    byId("scalar-what").textContent = [scalar.what, ...page.scalarWords(scalar.name)].filter(Boolean).join("; ");
    byId("superplot-key").textContent = names.length
      ? "Small: a cell. Large: mean of an experiment. Line: mean of experiments. A grey line joins an experiment that has both conditions."
      : "Each point is a cell; experiments are unknown, so nothing can be said beyond these cells.";
    if (shown.some(({ drawn, all }) => drawn.length < all)) byId("superplot-key").textContent += ` At most ${MOST_DOTS} cells of each condition are drawn; means are of all.`;
  };

  const valueOf = (row, name) => row[page.data.tables.scalars.columns.findIndex((column) => column.name === name)];
  const rowsOf = (name) => {
    const shown = page.comparison()?.condition;
    const rows = page.data.tables.scalars?.rows ?? [];
    return rows.filter((row) => (valueOf(row, "condition") ?? shown) === shown && (!name || valueOf(row, "scalar") === name));
  };

  page.scalarWords = (name) =>
    rowsOf(name).map((row) => {
      const at = (column) => valueOf(row, column) ?? NaN;
      const spread = page.known(at("low")) ? ` (${page.digits(at("low"))} to ${page.digits(at("high"))})` : "";
      const p = page.known(at("p_fwer")) ? `, p ${page.chance(at("p"))}, corrected (${page.data.correction}) ${page.chance(at("p_holm"))}` : ", not tested";
      if (!page.known(at("effect_size"))) return `difference ${page.digits(at("difference"))}, not tested`;
      return `difference ${page.digits(at("difference"))}, g ${page.digits(at("effect_size"))}${spread}${p}`;
    });

  // Effect sizes with their intervals, the largest first; a click shows the scalar cell by cell.
  page.drawForest = () => {
    const rows = rowsOf().filter((row) => page.known(valueOf(row, "effect_size")));
    if (!rows.length) return byId("forest").replaceChildren(page.data.tested ? "No effect sizes: there is no spread between experiments to measure by." : "No effect sizes: nothing was tested.");
    const size = (row) => Math.abs(valueOf(row, "effect_size"));
    const shown = rows.sort((a, b) => size(b) - size(a)).slice(0, 30);
    const ends = shown.flatMap((row) => ["low", "high", "effect_size"].map((name) => valueOf(row, name)));
    const yNames = shown.map((row, k) => ({ at: -k, label: page.labelOf(valueOf(row, "scalar")) }));
    const longest = Math.max(...yNames.map(({ label }) => label.length));
    const height = 58 + 19 * shown.length;
    const chart = page.chart({
      width: 430, height, x: page.range([0, ...ends]), y: [-shown.length + 0.3, 0.7], yNames, left: Math.min(210, 24 + 6.6 * longest),
      xLabel: "effect size g with its 95 % interval", label: "effect sizes of all scalars",
    });
    chart.marks.append(svg("path", { d: `M${chart.toX(0)} ${chart.top}V${chart.bottom}`, stroke: "#999999" }));
    shown.forEach((row, k) => {
      const [low, high, g, p] = ["low", "high", "effect_size", "p_holm"].map((name) => valueOf(row, name));
      const sure = page.known(p) && p <= page.data.level;
      const line = { d: `M${chart.toX(low)} ${chart.toY(-k)}H${chart.toX(high)}`, stroke: sure ? "#111111" : "#888888", "stroke-width": 1.6 };
      const show = () => page.showScalar(valueOf(row, "scalar"));
      const group = svg("g", { class: "goes", onclick: show });
      if (page.known(low)) group.append(svg("path", line));
      const look = { fill: sure ? "#111111" : "#ffffff", stroke: sure ? "#111111" : "#888888", "stroke-width": 1.5 };
      group.append(svg("circle", { cx: chart.toX(g), cy: chart.toY(-k), r: 4.5, ...look }));
      const words = `${page.labelOf(valueOf(row, "scalar"))}: g ${page.digits(g)}, p corrected ${page.chance(p ?? NaN)}`;
      group.append(svg("title", {}, words));
      chart.marks.append(group);
    });
    replace("forest", chart.root);
    const more = rows.length - shown.length;
    byId("forest-key").textContent = `Filled: p corrected for all scalars (${page.data.correction}) at most ${page.data.level}.${more > 0 ? ` The ${more} smallest are in the table.` : ""}`;
  };

  // Means over lags by condition, with their standard errors over experiments, of one layer.
  page.drawCurves = () => {
    const { data } = page;
    const { lags, layers } = data;
    const layer = Number(byId("layer").value);
    const cut = (name, condition) => page.ofAtlas(name, condition).slice(layer * lags.length, (layer + 1) * lags.length);
    const names = data.conditions;
    const bands = names.map((name) => {
      const [middle, sem] = [cut("mean", name), cut("sem", name)];
      return { name, middle, low: middle.map((value, k) => value - sem[k]), high: middle.map((value, k) => value + sem[k]) };
    });
    const y = page.range([0, ...bands.flatMap(({ middle, low, high }) => [...middle, ...low, ...high])]);
    const chart = page.chart({ width: 700, height: 340, x: page.range(lags, 0.02), y, xLabel: data.lag_label, yLabel: data.channels[page.atlasState.channel].value, label: `curves of layer ${layer} of ${layers}` });
    chart.marks.append(svg("path", { d: `M${chart.left} ${chart.toY(0)}H${chart.right}`, stroke: "#bbbbbb" }));
    for (const { name, middle, low, high } of bands) {
      const colour = colourOf(name);
      const known = [...lags.keys()].filter((k) => page.known(low[k]));
      if (known.length > 1) {
        const points = [...known.map((k) => [lags[k], low[k]]), ...known.reverse().map((k) => [lags[k], high[k]])];
        const d = `M${points.map(([x, value]) => `${chart.toX(x).toFixed(1)} ${chart.toY(value).toFixed(1)}`).join("L")}Z`;
        chart.marks.append(svg("path", { d, fill: colour, "fill-opacity": 0.15 }));
      }
      chart.marks.append(svg("path", { d: page.linePath(chart, lags, middle), fill: "none", stroke: colour, "stroke-width": 2.5 }, svg("title", {}, name)));
    }
    if (page.comparison()) {
      const p = page.ofWindows("p_holm").slice(layer * lags.length, (layer + 1) * lags.length);
      lags.forEach((lag, k) => {
        if (p[k] <= data.level) chart.marks.append(svg("circle", { cx: chart.toX(lag), cy: chart.bottom - 6, r: 3, fill: "#111111" }, svg("title", {}, `p corrected ${page.chance(p[k])}`)));
      });
    }
    replace("curves", chart.root);
  };
})();
