"use strict";
// Sections below the linked views: what predicts what, and waves.
(() => {
  const page = window.cytodisk;
  const { byId, svg, write } = page;
  const [BLUE, ORANGE] = ["#0072b2", "#d55e00"]; // of Okabe and Ito
  let section = null; // cell that the controls are filled for
  let pair = null; // [signal, signal] whose gain is drawn

  const say = (id, sentences) => byId(id).replaceChildren(...sentences.map((words) => page.make("p", {}, words)));
  const value = (id) => Number(byId(id).value || 0);

  const prediction = () => page.data.predictions[value("prediction")];
  const waves = () => page.data.waves[value("wave-signal")];

  // Both directions of a pair, the one that is asked for first.
  const bothWays = ({ links }) => {
    const [a, b] = pair;
    return [links.find((link) => link.source === a && link.target === b), links.find((link) => link.source === b && link.target === a)].filter(Boolean);
  };

  const pairsOf = ({ links }) => {
    const found = [];
    for (const { source, target } of links) if (!found.some(([a, b]) => a === target && b === source)) found.push([source, target]);
    return found;
  };

  const rank = ({ best_q: q, doubtful }) => (q ?? 1) + (doubtful ? 1 : 0);
  const strongest = ({ links }) => links.reduce((best, link) => (rank(link) < rank(best) ? link : best), links[0]);

  // Gain by layer, from the edge in; filled: q < 0.05 and counted; dotted: without what geometry gives.
  const drawGain = () => {
    const found = prediction();
    const ways = bothWays(found);
    const { layers, median_depths: depths, units } = page.data;
    const x = [...Array(layers).keys()];
    const all = ways.flatMap(({ gain_excess: gain, gain_excess_partial: partial }) => [...gain.values, ...partial.values]);
    const xNames = x.map((layer) => ({ at: layer, label: String(layer), below: page.known(depths[layer]) ? page.digits(depths[layer]) : "" }));
    const options = {
      x: [-0.5, layers - 0.5], y: page.range([0, ...all].filter(page.known), 0.12), xNames, ticks: 4, label: "gain beyond chance by layer",
      xLabel: `layer (0: edge), below it its depth (${units.depth})`, yLabel: "gain beyond chance (nat)",
    };
    page.drawChart("gain", [value("prediction"), pair, page.state.layer], options, (chart) => {
      page.chartLine(chart, [-0.5, layers - 0.5], [0, 0], { stroke: "#999999" });
      const chosen = page.state.layer;
      chart.marks.prepend(svg("rect", { x: chart.toX(chosen - 0.5), y: chart.top, width: chart.toX(chosen + 0.5) - chart.toX(chosen - 0.5), height: chart.bottom - chart.top, fill: "#eef4fb" }));
      ways.forEach(({ gain_excess: gain, gain_excess_partial: partial, q, lost }, k) => {
        const colour = [ORANGE, BLUE][k];
        page.chartLine(chart, x, [...partial.values], { stroke: colour, "stroke-dasharray": "1.5 3" });
        page.chartLine(chart, x, [...gain.values], { stroke: colour, "stroke-width": 2, "stroke-dasharray": k ? "6 4" : null });
        x.forEach((layer) => {
          const fill = q.values[layer] < 0.05 && !lost.values[layer] ? colour : "white";
          page.chartDot(chart, layer, gain.values[layer], { r: 4.5, fill, stroke: colour, "stroke-width": 1.5 });
        });
      });
      return { gain: ways.map(({ gain_excess: gain }) => [...gain.values]) };
    });
    const keys = ways.map(({ source, target, given }, k) => {
      const mark = page.make("i", { class: k ? "back" : "there" });
      return page.make("span", {}, mark, ` ${found.names[source]} → ${found.names[target]}${given ? ` (given ${given})` : ""}`);
    });
    const partial = ways.some(({ gain_excess_partial: one }) => one.values.some(Number.isFinite));
    byId("gain-key").replaceChildren(...keys, page.make("span", {}, `filled: q < 0.05${ways.some(({ lost }) => lost.values.some((one) => one > 0)) ? ", and counted" : ""}${partial ? "; dotted: without what geometry alone would give" : ""}`));
    const layer = page.state.layer;
    const numbers = ways.map(({ source, target, gain_excess: gain, q, effect, lost }) => {
      const more = effect.values[layer] > 0 ? "more" : "less";
      const means = lost.values[layer] ? page.notCounted : `more ${found.names[source]} is followed by ${more} ${found.names[target]}`;
      const sign = q.values[layer] < 0.05 ? `; ${means}` : "";
      return `${found.names[source]} → ${found.names[target]} in layer ${layer}: gain ${page.digits(gain.values[layer])}, q ${page.chance(q.values[layer])}${sign}`;
    });
    write("gain-numbers", `${numbers.join(". ")}.`);
    say("gain-reasons", [...new Set(ways.flatMap(({ reasons }) => reasons))]);
  };

  const choosePair = (chosen) => {
    pair = chosen;
    byId("prediction-pair").value = pairsOf(prediction()).findIndex(([a, b]) => chosen.includes(a) && chosen.includes(b));
    page.draw();
  };

  const fillPairs = () => {
    const found = prediction();
    const { source, target } = strongest(found);
    page.fill("prediction-pair", pairsOf(found).map(([a, b], k) => [k, `${found.names[a]} and ${found.names[b]}`]));
    byId("prediction-pair").closest("label").hidden = found.links.length < 3;
    choosePair([source, target]);
  };

  const drawPredictions = () => {
    const found = prediction();
    say("prediction-finding", found.finding);
    const root = byId("figure-network");
    const size = [root.clientWidth, root.clientHeight];
    page.when("network", [section, value("prediction"), pair, size], () => {
      const chosen = ({ source, target }) => pair.includes(source) && pair.includes(target);
      const choose = ({ source, target }) => choosePair([source, target]);
      root.replaceChildren(page.network(found, { width: size[0], height: size[1], chosen, choose }));
    });
    drawGain();
  };

  // Where a phase passes 0, at a crest: (frame, sector) pairs, frames with a share between two of them.
  const crests = ({ values, shape: [frames, sectors] }) => {
    const found = [];
    for (let sector = 0; sector < sectors; sector++) {
      for (let k = 1; k < frames; k++) {
        const [before, after] = [values[(k - 1) * sectors + sector], values[k * sectors + sector]];
        const passes = Math.abs(after - before) < Math.PI && before * after <= 0 && before !== after;
        if (passes) found.push([k - 1 + before / (before - after), sector]);
      }
    }
    return found;
  };

  const waveLayer = (found) => (found.edge ? 0 : found.phase[page.state.layer] ? page.state.layer : found.chosen);

  const isWave = ({ layers }, layer) => layers.some((row) => row.layer === layer && row.kind && row.kind !== "none");

  const drawKymograph = () => {
    const found = waves();
    const layer = waveLayer(found);
    const phase = found.phase[layer];
    const { frames, sectors, velocity, speed_limit: limit, units, layers, time_label: xLabel, time_step: step } = page.data;
    const byPhase = byId("wave-shows").value === "phase";
    const channel = page.data.channels[found.channel];
    const of = (k) => {
      const [frame, sector] = [k % frames.length, Math.floor(k / frames.length)];
      if (byPhase) return phase.values[frame * sectors + sector];
      return found.edge ? velocity.values[frame * sectors + sector] : channel.mean.values[(frame * layers + layer) * sectors + sector];
    };
    const map = () => Float32Array.from({ length: sectors * frames.length }, (_, k) => of(k));
    const look = byPhase ? { limits: [-Math.PI, Math.PI], palette: "phase", unit: "rad, 0: crest" }
      : found.edge ? { limits: [-limit, limit], palette: "correlation", unit: units.velocity }
        : { limits: channel.layer_limits[layer], palette: "signal", unit: channel.unit };
    page.drawMap("waves", [section, value("wave-signal"), layer, byPhase, byId("wave-crests").checked], map, { ...look, xLabel }, (chart) => {
      if (!byId("wave-crests").checked || !isWave(found, layer)) return;
      const bar = chart.toY(0) - chart.toY(1);
      let d = "";
      for (const [place, sector] of crests(phase)) {
        const frame = frames[0] + place * page.data.every;
        d += `M${chart.toX(frame * step).toFixed(1)} ${(chart.toY(sector) + bar / 2).toFixed(1)}v${(-bar).toFixed(1)}`;
      }
      const dark = found.edge || byPhase;
      chart.marks.append(svg("path", { d, stroke: dark ? "black" : "white", "stroke-width": 2, class: "crests" }));
    });
    const bars = isWave(found, layer) ? "bars: crests of the wave" : "no wave beyond chance, so no crests";
    write("waves-title", `${found.edge ? "edge velocity" : `${found.signal}, layer ${layer}`}; ${bars}`);
  };

  const COLUMNS = [
    ["layer", "layer", (row) => String(row.layer)],
    ["kind", "kind", (row) => row.kind || "–"],
    ["waves around", "number of waves around the cell", (row) => (page.known(row.mode) ? String(row.mode) : "–")],
    ["period", "from crest to crest at one place", (row) => (page.known(row.period_s) ? `${page.digits(row.period_s)} s` : page.withUnit(row.period, "frames"))],
    ["speed along the edge", "positive: towards higher sectors, clockwise in the image", (row) => page.withUnit(row.speed_um_s, "µm/s")],
    ["direction", "1 or −1: all run one way; 0: standing", (row) => page.fixed(row.direction)],
    ["persistence", "how long it keeps its course", (row) => page.withUnit(row.persistence_s, "s")],
    ["order", "0 on average without waves", (row) => page.fixed(row.order)],
    ["p", "share of surrogates with at least this order", (row) => page.chance(row.p)],
    ["q", "p, adjusted for the layers", (row) => page.chance(row.q)],
    ["inside", "which way the wave runs at this depth", (row) => row.inside || "–"],
    ["speed inwards", "of the wave, by the depth of windows", (row, unit) => page.withUnit(row.inward_speed, unit)],
  ];

  const drawNumbers = () => {
    const found = waves();
    const inside = found.layers.some(({ inside: words }) => words);
    const columns = COLUMNS.filter(([name]) => (inside || !["inside", "speed inwards"].includes(name)) && (!found.edge || name !== "layer"));
    const head = page.make("tr", {}, ...columns.map(([name, title]) => page.make("th", { scope: "col", title }, name)));
    const rows = found.layers.map((row) => {
      const cells = row.reason ? [page.make("td", {}, String(row.layer)), page.make("td", { colspan: columns.length - 1 }, row.reason)]
        : columns.map(([, , text]) => page.make("td", {}, text(row, found.inside_unit)));
      const current = !found.edge && row.layer === waveLayer(found);
      const element = page.make("tr", { "aria-current": String(current) }, ...cells);
      if (!found.edge) element.addEventListener("click", () => page.set({ layer: row.layer }));
      return element;
    });
    byId("wave-numbers").replaceChildren(page.make("thead", {}, head), page.make("tbody", {}, ...rows));
  };

  const drawWaves = () => {
    say("wave-finding", waves().finding);
    drawKymograph();
    page.when("wave numbers", [section, value("wave-signal"), page.state.layer], drawNumbers);
  };

  page.drawResults = () => {
    const { predictions, waves: all, cell } = page.data;
    const parts = [["predictions", predictions], ["waves", all]];
    for (const [name, found] of parts) if (byId(name)) byId(name).hidden = !found.length;
    if (section !== cell) {
      section = cell;
      page.fill("prediction", predictions.map(({ label }, k) => [k, label]));
      page.fill("wave-signal", all.map(({ label }, k) => [k, label]));
      if (byId("predictions") && predictions.length) fillPairs();
    }
    if (byId("predictions") && predictions.length) drawPredictions();
    if (byId("waves") && all.length) drawWaves();
  };

  byId("prediction")?.addEventListener("change", fillPairs);
  byId("prediction-pair")?.addEventListener("change", () => choosePair(pairsOf(prediction())[value("prediction-pair")]));
  for (const id of ["wave-signal", "wave-shows", "wave-crests"]) byId(id)?.addEventListener("change", () => page.draw());
})();
