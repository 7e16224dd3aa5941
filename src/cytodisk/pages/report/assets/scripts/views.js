"use strict";
// The views of a movie's cell, drawn from what is chosen.
(() => {
  const page = window.cytodisk;
  const { byId, svg, write } = page;
  const [BLUE, ORANGE, MISSING] = ["#0072b2", "#d55e00", "#d9d9d9"]; // of Okabe and Ito, and of no value
  const DISK = 640; // of a canvas, in its own pixels
  const MOST_DOTS = 100; // frames that a line shows as dots
  const figures = {}; // name → { canvas or chart, toPage, at, data }
  page.figures = figures;
  let drawn = {};
  let shownCell = null; // picture of the frame that is drawn
  page.redraw = () => {
    drawn = {};
    page.draw();
  };

  // Draws a view anew if anything that it depends on has changed.
  const when = (name, key, paint) => {
    const text = JSON.stringify(key);
    if (drawn[name] === text) return;
    drawn[name] = text;
    paint();
  };

  const focusWindow = () => {
    const at = page.focus();
    return at ? page.windowOf(at.layer, at.sector) : null;
  };
  const inner = () => page.data.cytoplasm_layers ?? Infinity;
  const palettes = {};
  const packed = (name) => (palettes[name] ??= page.packed(page.study.palettes[name]));

  // The correlation by window as a picture shows it.
  const peakLook = (peak) => {
    const { windows, lags } = page.pair();
    const lagged = peak === "lag";
    const values = windows[peak].values.map((value) => value * (lagged ? page.lagScale() : 1));
    const top = lagged ? page.largest(lags) * page.lagScale() || 1 : Math.ceil(10 * page.largest(values)) / 10 || 1;
    const q = windows.q.values;
    const tested = q.some(Number.isFinite);
    const all = [...q.keys()];
    return {
      values: [...values], limits: [-top, top], palette: peak, unit: lagged ? page.data.lag_unit : "r", tested,
      marks: all.filter((k) => q[k] < 0.05), pale: all.filter((k) => q[k] >= 0.05 && Number.isFinite(values[k])),
    };
  };

  // What the cell is coloured by.
  const cellLook = (decoded) => {
    const { shows, channel, index } = page.state;
    if (page.data.pairs.length && ["correlation", "lag"].includes(shows)) return peakLook(shows);
    if (shows === "velocity") {
      const limit = page.data.speed_limit;
      return { values: [...page.row(page.data.velocity, index)], limits: [-limit, limit], palette: "correlation", unit: page.data.units.velocity, marks: [] };
    }
    const { limits, unit } = page.channel();
    const grey = decoded.channels?.[channel];
    if (shows === "pixels" && grey) {
      const ends = page.data.picture.limits[channel];
      return { grey, ends, limits: page.stretched(ends), palette: "signal", unit };
    }
    return { values: [...page.row(page.channelValues(), index)], limits: page.stretched(limits), palette: "signal", unit };
  };

  const SHOWN = { velocity: () => "edge velocity, in the outermost windows", pixels: () => page.channel().name, means: page.channelWords, correlation: () => `peak correlation, ${page.pair().label}`, lag: () => `lag of the peak; positive: ${page.pair().with} follows` };

  const drawCell = async () => {
    const { index, channel, cell, grid, rim, shows } = page.state;
    const decoded = await page.frameAt(index);
    if (index !== page.state.index || cell !== page.state.cell) return; // a later frame is on its way
    const highlighted = focusWindow();
    const look = cellLook(decoded);
    const picture = { shape: page.data.picture.shape, labels: decoded.labels, grey: look.grey, ends: look.ends };
    const [limit, speeds] = [page.data.speed_limit, page.row(page.data.velocity, index)];
    const colours = Array.from(speeds, (speed) => page.packedColour(speed, [-limit, limit], packed("correlation")));
    page.paint(byId("cell-picture"), picture, {
      ...look, colours: packed(look.palette), grid, chosen: highlighted, rim: rim ? colours : null, inner: inner() * page.data.sectors,
    });
    shownCell = picture;
    drawAround();
    page.drawBar(byId("bar-cell"), look.limits, page.study.palettes[look.palette], look.unit);
    write("cell-shows", SHOWN[look.grey || shows !== "pixels" ? shows : "means"]());
    for (const id of ["black", "white", "auto", "reset"]) if (byId(id)) byId(id).disabled = "marks" in look || (id === "auto" && !look.grey);
    page.shown = { index, highlighted, channel, cell, limits: look.limits };
    const reason = page.data.reasons[index];
    write("cell-note", reason ? `no map: ${reason}` : "");
    if (page.changedAt) page.drawMilliseconds = performance.now() - page.changedAt;
    page.changedAt = null;
  };

  const drawAround = () => {
    const { layers, sectors } = page.data;
    const [canvas, over] = [byId("cell-picture"), byId("cell-over")];
    const factor = page.fitCell(canvas, over, shownCell.shape);
    const pixel = (page.data.picture.size[1] / shownCell.shape[1]) * (page.study.pixel_size_um ?? 1);
    page.drawOver(over, shownCell, { factor, layers, sectors, pixel, unit: page.study.length_unit, numbered: true });
  };

  page.autoCell = () => (shownCell?.grey ? page.autoContrast(shownCell) : null);

  const lines = () => ({ radii: page.data.radii, sectors: page.data.sectors });
  const drawDisk = () => {
    const { limits, unit } = page.channel();
    const values = [...page.row(page.channelValues(), page.state.index)];
    const palette = page.study.palettes.signal;
    page.drawDisk(byId("disk-picture"), lines(), values, { limits, palette, chosen: focusWindow(), nucleus: page.data.cytoplasm_layers });
    page.drawBar(byId("bar-disk"), limits, palette, unit);
    write("disk-title", page.channelWords());
    figures.disk.data = { values, limits };
  };

  const drawPeaks = () => {
    const { signal, with: other, differs, peak_notes: notes, windows } = page.pair();
    const { peak } = page.state;
    const look = peakLook(peak);
    const palette = page.study.palettes[peak];
    page.drawDisk(byId("peaks-picture"), lines(), look.values, { ...look, palette, chosen: focusWindow(), nucleus: page.data.cytoplasm_layers });
    page.drawBar(byId("bar-peaks"), look.limits, palette, look.unit);
    figures.peaks.data = look;
    const missing = !windows.correlation.values.every(Number.isFinite);
    const key = look.tested ? "hatched: not significant (q ≥ 0.05)" : "significance was not computed";
    write("peaks-key", missing ? `${key}; grey: not correlated` : key);
    write("peak-notes", notes.join("\n"));
    write("peaks-name", peak === "lag" ? "Lag of the peak" : "Peak correlation");
    for (const name of ["peaks", "curve"]) {
      write(`${name}-title`, `${signal} with ${other}`);
      write(`${name}-differs`, differs);
    }
    write("curve-hint", `positive lag: ${other} follows ${signal}`);
  };

  // A chart that fills its element; its group "over" is drawn more often than the rest.
  const drawChart = (name, key, options, fill) => {
    const root = byId(`figure-${name}`);
    if (!root || !root.clientWidth) return;
    const [width, height] = [root.clientWidth, root.clientHeight];
    when(name, [width, height, page.state.cell, ...key], () => {
      const chart = page.chart({ width, height, ...options });
      chart.over = svg("g");
      const data = fill(chart) ?? {};
      chart.root.append(chart.over);
      root.replaceChildren(chart.root);
      figures[name] = { ...figures[name], chart, data, ...placing(chart) };
      delete drawn[`${name} over`];
    });
  };

  // From a chart's own coordinates to those of the page, and back; null outside its axes.
  const placing = ({ root, left, right, top, bottom, x, y, toX, toY }) => {
    const scale = (box) => box.width / Number(root.getAttribute("width"));
    return {
      toPage: (at, height) => {
        const box = root.getBoundingClientRect();
        return [box.left + toX(at) * scale(box), box.top + toY(height) * scale(box)];
      },
      at: ({ clientX, clientY }) => {
        const box = root.getBoundingClientRect();
        const [px, py] = [(clientX - box.left) / scale(box), (clientY - box.top) / scale(box)];
        if (px <= left || px >= right || py <= top || py >= bottom) return null;
        return { x: x[0] + ((px - left) / (right - left)) * (x[1] - x[0]), y: y[0] + ((bottom - py) / (bottom - top)) * (y[1] - y[0]) };
      },
    };
  };

  const timeEnds = () => {
    const { frames, every, time_step: step } = page.data;
    return [(frames[0] - every / 2) * step, (frames.at(-1) + every / 2) * step];
  };

  // Time × sector as an image; values by sector and time.
  const drawMap = (name, key, values, { limits, palette, unit, xLabel }, more = null) => {
    const { frames, sectors } = page.data;
    const yNames = page.numberedSectors(sectors).map((at) => ({ at, label: String(at) }));
    const options = { x: timeEnds(), y: [-0.5, sectors - 0.5], yNames, xLabel, yLabel: "sector", label: `${name} by time and sector` };
    drawChart(name, [...key, limits], options, (chart) => {
      const { marks, left, top, right, bottom } = chart;
      const map = values();
      const canvas = Object.assign(document.createElement("canvas"), { width: frames.length, height: sectors });
      const pixels = Uint32Array.from(map, (value) => page.packedColour(value, limits, packed(palette)));
      const turned = new Uint32Array(pixels.length); // sector 0 lies below
      for (let row = 0; row < sectors; row++) turned.set(pixels.subarray(row * frames.length, (row + 1) * frames.length), (sectors - 1 - row) * frames.length);
      canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(turned.buffer), frames.length, sectors), 0, 0);
      const place = { x: left, y: top, width: right - left, height: bottom - top, preserveAspectRatio: "none" };
      marks.append(svg("image", { href: canvas.toDataURL(), ...place, style: "image-rendering: pixelated" }));
      page.drawBar(byId(`bar-${name}`), limits, page.study.palettes[palette], unit);
      if (more) more(chart);
      return { values: [...map], limits };
    });
  };

  const drawActivity = () => {
    if (!figures.activity) return;
    const { channel, layer, colours } = page.state;
    const { layers, sectors, frames, layer_places: places, layer_depths: depths } = page.data;
    const { values } = page.channelValues();
    const { limits, layer_limits: byLayer, unit } = page.channel();
    const of = (k) => values[((k % frames.length) * layers + layer) * sectors + Math.floor(k / frames.length)];
    const map = () => Float32Array.from({ length: sectors * frames.length }, (_, k) => of(k));
    drawMap("activity", [channel, layer], map, { limits: colours === "all" ? limits : byLayer[layer], palette: "signal", unit, xLabel: null });
    write("activity-title", `${page.channelWords()}, layer ${layer}${places[layer]}${depths[layer]}`);
  };

  const drawVelocity = () => {
    const { sectors, frames, velocity, speed_limit: limit, units, time_label: xLabel } = page.data;
    const map = () => Float32Array.from({ length: sectors * frames.length }, (_, k) => velocity.values[(k % frames.length) * sectors + Math.floor(k / frames.length)]);
    drawMap("velocity", [], map, { limits: [-limit, limit], palette: "correlation", unit: units.velocity, xLabel });
  };

  // One number against time; grey: frames without a map.
  const drawStrip = (name, title, values) => {
    const { frames, reasons, every, time_step: step } = page.data;
    byId(`figure-${name}`).hidden = !values;
    if (!values) return;
    const options = { x: timeEnds(), y: page.range(values, 0.12), xLabel: null, top: 17, ticks: 2, label: `${title} against time` };
    drawChart(name, [title], options, (chart) => {
      const { marks, toX, toY, top, bottom, left } = chart;
      const half = (every * step) / 2;
      const missing = frames.map((frame, k) => [(frame * step) - half, (frame * step) + half, reasons[k]]).filter(([, , reason]) => reason);
      for (const [start, end] of missing) marks.append(svg("rect", { x: toX(start), y: top, width: toX(end) - toX(start), height: bottom - top, fill: MISSING }));
      marks.append(svg("text", { x: left, y: 11, class: "strip-title" }, title));
      const xs = frames.map((frame) => frame * step);
      marks.append(svg("path", { d: page.linePath(chart, xs, values), fill: "none", stroke: BLUE, "stroke-width": 1.4 }));
      const alone = (k) => !page.known(values[k - 1]) && !page.known(values[k + 1]);
      values.forEach((value, k) => {
        if (page.known(value) && (values.length <= MOST_DOTS || alone(k))) marks.append(svg("circle", { cx: toX(xs[k]), cy: toY(value), r: 1.6, fill: BLUE }));
      });
      return { values, missing: missing.map(([start, end]) => [start, end]) };
    });
  };

  const drawStrips = () => {
    const { quality } = page.data;
    const { name, unit, whole_mean: mean } = page.channel();
    for (const strip of quality) drawStrip(strip.name, strip.title, Array.from(strip.values.values));
    if (byId("figure-intensity")) drawStrip("intensity", `mean ${name} of the cell (${unit})`, mean && Array.from(mean.values));
  };

  // Mean of each layer in this frame, windows counted by their area, and the quartiles of its sectors.
  const quartile = (sorted, share) => {
    const at = share * (sorted.length - 1);
    const low = Math.floor(at);
    return sorted[low] + (at - low) * ((sorted[low + 1] ?? sorted[low]) - sorted[low]);
  };

  const layerSummary = (values, areas, layer) => {
    const numbers = [...Array(page.data.sectors).keys()].map((sector) => page.windowOf(layer, sector));
    const known = numbers.filter((number) => Number.isFinite(values[number]));
    if (!known.length) return { mean: NaN, low: NaN, high: NaN };
    const whole = known.reduce((sum, number) => sum + areas[number], 0);
    const mean = known.reduce((sum, number) => sum + values[number] * areas[number], 0) / whole;
    const sorted = known.map((number) => values[number]).sort((a, b) => a - b);
    return { mean, low: quartile(sorted, 0.25), high: quartile(sorted, 0.75) };
  };

  const band = (chart, xs, low, high, look) => {
    const known = [...xs.keys()].filter((k) => page.known(low[k]) && page.known(high[k]));
    if (known.length < 2) return;
    const points = [...known.map((k) => [xs[k], low[k]]), ...known.reverse().map((k) => [xs[k], high[k]])];
    const d = `M${points.map(([x, value]) => `${chart.toX(x).toFixed(1)} ${chart.toY(value).toFixed(1)}`).join("L")}Z`;
    chart.marks.append(svg("path", { d, ...look }));
  };

  const line = (chart, xs, ys, look) => chart.marks.append(svg("path", { d: page.linePath(chart, xs, ys), fill: "none", ...look }));
  const dot = (chart, x, y, look) => {
    if (page.known(x) && page.known(y)) chart.marks.append(svg("circle", { cx: chart.toX(x), cy: chart.toY(y), ...look }));
  };

  const drawProfile = () => {
    const { index, channel, layer: chosenLayer } = page.state;
    const { layers, area, median_depths: depths, units, profile_colours: shades } = page.data;
    const { limits, unit } = page.channel();
    const order = [...Array(layers).keys()].reverse(); // from the nucleus' centre on the left
    const x = order.map((layer) => layers - 0.5 - layer);
    const outline = layers - inner();
    const xNames = order.map((layer, k) => ({ at: x[k], label: String(layer), below: page.known(depths[layer]) ? page.digits(depths[layer]) : "" }));
    const options = { x: [0, layers], y: limits, xNames, xLabel: `layer, and below it its depth (${units.depth})`, ticks: 4, label: "profile from the nucleus to the membrane" };
    const layer = page.focus()?.layer ?? chosenLayer;
    drawChart("profile", [index, channel, layer], options, (chart) => {
      const found = order.map((one) => layerSummary(page.row(page.channelValues(), index), page.row(area, index), one));
      [[0, outline, "nucleus"], [outline, layers, "cytoplasm"]].forEach(([from, to, words], k) => {
        const place = { x: chart.toX(from), y: chart.top, width: chart.toX(to) - chart.toX(from), height: chart.bottom - chart.top };
        chart.marks.append(svg("rect", { ...place, fill: shades[k], "fill-opacity": 0.35, stroke: "#333333" }));
        chart.marks.append(svg("text", { x: (chart.toX(from) + chart.toX(to)) / 2, y: chart.top + 13, "text-anchor": "middle" }, words));
      });
      const [mean, low, high] = ["mean", "low", "high"].map((name) => found.map((one) => one[name]));
      band(chart, x, low, high, { fill: BLUE, "fill-opacity": 0.2 });
      line(chart, x, mean, { stroke: BLUE, "stroke-width": 1.6 });
      mean.forEach((value, k) => dot(chart, x[k], value, { r: 2.5, fill: BLUE }));
      dot(chart, x[layers - 1 - layer], mean[layers - 1 - layer], { r: 6, fill: "none", stroke: "black", "stroke-width": 2 });
      return { mean, low, high };
    });
    write("profile-title", `${page.channelWords()} (${unit}) in this frame; band: quartiles of sectors`);
  };

  const drawCurve = () => {
    const { lags, layers, layer_curves: layerCurves, layer_partial: partial, without, curves, windows } = page.pair();
    const at = page.focus();
    const layer = at?.layer ?? page.state.layer;
    const lag = lags.map((value) => value * page.lagScale());
    const number = at && page.windowOf(at.layer, at.sector);
    const of = (array) => Array.from(page.row({ ...array, shape: [0, lag.length] }, number));
    const mean = Array.from(page.row(layerCurves, layer));
    const bar = at ? windows.threshold.values[number] : layers.threshold.values[layer];
    const known = at && curves;
    const [low, high] = known ? [of(curves.low), of(curves.high)] : [[], []];
    const top = Math.min(1, Math.ceil(5 * (page.largest([...mean, bar, ...low, ...high]) || 1)) / 5);
    const x = lag.length > 1 ? [lag[0], lag.at(-1)] : [-1, 1];
    const options = { x, y: [-top, top], xLabel: `lag (${page.data.lag_unit})`, yLabel: "correlation r", label: "correlation against lag" };
    drawChart("curve", [page.state.pair, number, layer], options, (chart) => {
      const nothing = lag.map(() => bar);
      band(chart, lag, nothing.map((value) => -value), nothing, { fill: "#e4e4e4" });
      line(chart, x, [0, 0], { stroke: "#999999" });
      line(chart, [0, 0], [-top, top], { stroke: "#999999" });
      line(chart, lag, mean, { stroke: BLUE, "stroke-width": 2, "stroke-dasharray": "6 4" });
      if (without) line(chart, lag, Array.from(page.row(partial, layer)), { stroke: BLUE, "stroke-dasharray": "1.5 3" });
      const data = { lag, layer: mean, high: nothing };
      if (!at) return data;
      if (known) {
        band(chart, lag, low, high, { fill: ORANGE, "fill-opacity": 0.22 });
        data.window = of(curves.correlation);
        line(chart, lag, data.window, { stroke: ORANGE, "stroke-width": 2 });
      }
      dot(chart, windows.lag.values[number] * page.lagScale(), windows.correlation.values[number], { r: 4, fill: "white", stroke: ORANGE, "stroke-width": 2 });
      return data;
    });
    const correlated = at && Number.isFinite(windows.correlation.values[number]);
    const name = at && `${page.layerWords(at.layer)}, sector ${at.sector}`;
    const bandWords = known ? ", band: 95 % at each lag by itself" : "";
    write("curve-window", !at ? "point at a window" : correlated ? `${name}${bandWords}` : `${name}: not correlated`);
    const [r, peak, q] = ["correlation", "lag", "q"].map((key) => layers[key].values[layer]);
    const [left, qLeft] = ["correlation_partial", "q_partial"].map((key) => layers[key].values[layer]);
    const rest = Number.isFinite(left) ? `; dotted: ${without}, r ${page.fixed(left)}, q ${page.chance(qLeft)}` : "";
    const found = `r ${page.fixed(r)} at ${page.lagWords(peak) || page.frameWords(peak)}, q ${page.chance(q)}${rest}`;
    write("curve-layer", `mean of ${page.layerWords(layer)}: ${Number.isFinite(r) ? found : "not correlated"}`);
    const chance = Number.isFinite(bar) ? ", 95 % over all lags" : ": not known";
    write("curve-null", `chance for the ${at ? "window" : "mean"}${chance}`);
  };

  // What the charts through time share: lines at moments, and the highlighted window.
  const MAPS = ["activity", "velocity", "waves"];
  const drawMoments = () => {
    const { index, hover } = page.state;
    const at = page.focus();
    const under = hover?.index === undefined || hover.index === index ? null : hover.index;
    const half = (page.data.every * page.data.time_step) / 2;
    for (const name of [...MAPS, ...page.study.strips]) {
      const { chart } = figures[name] ?? {};
      if (!chart) continue;
      const isMap = MAPS.includes(name);
      when(`${name} over`, [index, under, isMap && at], () => {
        const { over, toX, toY, left, right, top, bottom } = chart;
        const upright = (x, look) => svg("path", { d: `M${x} ${top}V${bottom}`, fill: "none", ...look });
        const now = toX(page.timeAt(index));
        const marks = [upright(now, { stroke: "white", "stroke-width": 3.5 }), upright(now, { stroke: "black", "stroke-width": 1.4 })];
        if (under !== null) marks.push(upright(toX(page.timeAt(under)), { stroke: "black", "stroke-dasharray": "2 2" }));
        if (isMap && at) {
          const [low, high] = [toY(at.sector - 0.5), toY(at.sector + 0.5)];
          const rows = { d: `M${left} ${low}H${right}M${left} ${high}H${right}`, stroke: name === "activity" ? "white" : "black", "stroke-width": 0.8 };
          const [start, end] = [-half, half].map((by) => toX(page.timeAt(at.index) + by));
          const box = { x: start, y: high, width: end - start, height: low - high, fill: "none" };
          marks.push(svg("path", rows), svg("rect", { ...box, stroke: "black", "stroke-width": 3.5 }), svg("rect", { ...box, stroke: "white", "stroke-width": 1.5 }));
        }
        over.replaceChildren(...marks);
      });
    }
  };

  Object.assign(page, { when, drawChart, drawMap, chartLine: line, chartDot: dot }); // for the other sections

  // What a cell of the study lacks is not on the page.
  const showParts = () => {
    const { pairs, channels } = page.data;
    byId("explorer").classList.toggle("without-pairs", !pairs.length);
    for (const element of document.querySelectorAll("[data-needs]")) {
      element.hidden = !{ pairs: pairs.length, signal: channels.some(({ mean }) => mean) }[element.dataset.needs];
    }
  };

  page.connectViews = () => {
    const onDisk = (canvas) => (event) => page.placeOf(page.windowOnDisk(canvas, lines(), event));
    const diskPoint = (canvas) => (u, v) => {
      const { left, top, width, height } = canvas.getBoundingClientRect();
      return [left + page.diskShare(u) * width, top + page.diskShare(v) * height];
    };
    const canvases = { disk: byId("disk-picture"), peaks: byId("peaks-picture") };
    for (const [name, canvas] of Object.entries(canvases)) {
      if (!canvas) continue;
      Object.assign(canvas, { width: DISK, height: DISK });
      figures[name] = { canvas, under: onDisk(canvas), toPage: diskPoint(canvas) };
    }
    const cell = byId("cell-picture");
    figures.cell = {
      canvas: cell,
      under: (event) => page.placeOf(page.windowOnCell(cell, shownCell?.labels, event)),
      toPage: (x, y) => {
        const { left, top, width, height } = cell.getBoundingClientRect();
        const { size, corners } = page.data.picture;
        const [boxTop, boxLeft] = corners[page.state.index];
        return [left + ((x + 0.5 - boxLeft) / size[1]) * width, top + ((y + 0.5 - boxTop) / size[0]) * height];
      },
    };
    const index = (at) => page.indexOfFrame(at.x / page.data.time_step);
    const find = (name, inMap) => (event) => {
      const at = figures[name].at?.(event);
      return at ? { index: index(at), ...(inMap && { layer: page.state.layer, sector: Math.round(at.y) }) } : null;
    };
    for (const name of [...MAPS, ...page.study.strips]) {
      const element = byId(`figure-${name}`);
      if (element) figures[name] = { canvas: element, under: find(name, MAPS.includes(name)) };
    }
    let resting = null;
    new ResizeObserver(() => {
      if (matchMedia("print").matches) return; // paper scales what is on the screen
      clearTimeout(resting);
      resting = setTimeout(() => page.draw(), 30);
    }).observe(byId("explorer"));
  };

  page.draw = () => {
    if (!page.data) return; // no cell is open yet
    const { index, channel, pair, peak, cell, grid, rim, shows, layer } = page.state;
    const at = page.focus();
    const window = at && [at.layer, at.sector];
    const frame = byId("cell-picture").closest(".cell-frame");
    when("parts", [cell], showParts);
    const contrast = ["black", "white"].map((id) => byId(id)?.value);
    when("cell", [cell, index, channel, window, grid, rim, shows, pair, contrast, frame.clientWidth, frame.clientHeight], drawCell);
    when("disk", [cell, index, channel, window], drawDisk);
    drawActivity();
    drawVelocity();
    drawStrips();
    if (byId("figure-profile")) drawProfile();
    page.drawResults();
    drawMoments();
    if (page.data.pairs.length) {
      when("peaks", [cell, pair, peak, window], drawPeaks);
      when("curve words", [cell, pair, window, layer, byId("figure-curve").clientWidth], drawCurve);
    }
    page.drawControls();
  };
})();
