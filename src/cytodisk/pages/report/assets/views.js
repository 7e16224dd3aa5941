"use strict";
// The figures: made by Bokeh, filled from what is chosen.
(() => {
  const page = window.cytodisk;
  const figures = {};
  const drawn = {};
  page.figures = figures;

  // Takes out stops of the Tab key, as no key does anything there.
  const passOver = (root) => {
    for (const element of root.querySelectorAll("*")) {
      element.removeAttribute("tabindex");
      if (element.shadowRoot) passOver(element.shadowRoot);
    }
  };

  page.embed = async ({ documents, items }) => {
    await Bokeh.embed.embed_items(documents, items);
    for (const figure of Bokeh.documents.at(-1).roots()) {
      figures[figure.name] = figure;
      passOver(document.getElementById(`figure-${figure.name}`));
    }
  };

  const part = (figure, name) => figures[figure].select(name)[0];

  // Draws a view anew if anything that it depends on has changed.
  const when = (name, key, paint) => {
    const text = JSON.stringify(key);
    if (drawn[name] === text) return;
    drawn[name] = text;
    paint();
  };

  const setColumns = (source, columns) => {
    const data = source.data instanceof Map ? Object.fromEntries(source.data) : source.data;
    source.data = { ...data, ...columns };
  };

  const setImage = (figure, name, values, shape) => {
    const source = part(figure, name);
    const image = source.data instanceof Map ? source.data.get("image") : source.data.image;
    setColumns(source, { image: [new image[0].constructor(values, shape)] });
  };

  // Two dollar signs would be read as a formula.
  const plain = (words) => words.replaceAll("$$", "$\u200b$");

  const setColours = (figure, [low, high], unit) => {
    part(figure, "colours").setv({ low, high });
    part(figure, "unit").text = plain(unit);
  };

  const text = (id, words) => {
    const element = document.getElementById(id);
    if (element && element.textContent !== words) element.textContent = words;
  };
  page.write = text;

  const channelWords = () => {
    const { name, mean } = page.channel();
    return mean ? `mean ${name}` : name;
  };

  const drawCell = async () => {
    const { index, channel } = page.state;
    const decoded = await page.frameAt(index);
    if (index !== page.state.index) return; // a later frame is on its way
    const at = page.focus();
    const highlighted = at ? page.windowOf(at.layer, at.sector) : null;
    const { shape } = page.data.picture;
    when("pixels", [index, channel], () => {
      const byWindow = page.row(page.channelValues(), index);
      setImage("cell", "pixels", page.cellValues(decoded, byWindow), shape);
    });
    setImage("cell", "lines", page.cellLines(decoded, highlighted), shape);
    setColours("cell", page.cellLimits(decoded), page.channel().unit);
    page.labels = decoded.labels;
    page.shown = { index, highlighted, channel };
    const reason = page.data.reasons[index];
    text("cell-note", reason ? `no map: ${reason}` : "");
    if (page.changedAt) page.drawMilliseconds = performance.now() - page.changedAt;
    page.changedAt = null;
  };

  const drawDisk = () => {
    const { limits, unit } = page.channel();
    setColumns(part("disk", "pixels"), { value: page.row(page.channelValues(), page.state.index) });
    setColours("disk", limits, unit);
    text("disk-title", channelWords());
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

  const drawProfile = () => {
    const { index } = page.state;
    const { layers, area } = page.data;
    const { limits, unit } = page.channel();
    const values = page.row(page.channelValues(), index);
    const areas = page.row(area, index);
    const order = [...Array(layers).keys()].reverse(); // from the nucleus' centre on the left
    const found = order.map((layer) => layerSummary(values, areas, layer));
    const x = order.map((layer) => layers - 0.5 - layer);
    part("profile", "band").data = { x, low: found.map(({ low }) => low), high: found.map(({ high }) => high) };
    part("profile", "line").data = { x, y: found.map(({ mean }) => mean) };
    figures.profile.y_range.setv({ start: limits[0], end: limits[1] });
    text("profile-title", `${channelWords()} (${unit}) in this frame; band: quartiles of sectors`);
  };

  const drawProfileFocus = () => {
    const layer = page.focus()?.layer ?? page.state.layer;
    const line = part("profile", "line").data;
    const at = page.data.layers - 1 - layer;
    const [x, y] = line instanceof Map ? [line.get("x"), line.get("y")] : [line.x, line.y];
    part("profile", "chosen").data = { x: [x[at]], y: [y[at]] };
  };

  const drawActivity = () => {
    const { layer, colours } = page.state;
    const { layers, sectors, frames } = page.data;
    const { values } = page.channelValues();
    const of = (k) => values[((k % frames.length) * layers + layer) * sectors + Math.floor(k / frames.length)];
    const map = Float32Array.from({ length: sectors * frames.length }, (_, k) => of(k));
    const { limits, layer_limits: byLayer, unit } = page.channel();
    setImage("activity", "pixels", map, [sectors, frames.length]);
    setColours("activity", colours === "all" ? limits : byLayer[layer], unit);
    text("activity-title", `${channelWords()}, layer ${layer}${page.data.layer_places[layer]}${page.data.layer_depths[layer]}`);
  };

  const drawIntensity = () => {
    const { name, unit, whole_mean: mean, whole_range: range } = page.channel();
    const words = mean ? `mean ${name} of the cell (${unit})` : "mean intensity: not of window areas";
    figures.intensity.title.text = plain(words);
    setColumns(part("intensity", "line"), { y: page.data.frames.map((_, k) => (mean ? mean.values[k] : NaN)) });
    if (mean) figures.intensity.y_range.setv({ start: range[0], end: range[1] });
  };

  // What the figures through time share: lines at moments, and the highlighted window.
  const timeAt = (index) => page.data.frames[index] * page.data.time_step;

  const drawTime = () => {
    const { index, hover } = page.state;
    const under = hover?.index;
    for (const line of figures.activity.select("now")) line.location = timeAt(index);
    part("activity", "under").location = under === undefined || under === index ? NaN : timeAt(under);
  };

  const drawFocus = () => {
    const at = page.focus();
    part("disk", "chosen").indices = at ? [page.windowOf(at.layer, at.sector)] : [];
    const half = 0.5 * page.data.every * page.data.time_step;
    const [left, right] = at ? [timeAt(at.index) - half, timeAt(at.index) + half] : [];
    const [low, high] = at ? [at.sector - 0.5, at.sector + 0.5] : [];
    part("activity", "row").data = { y: at ? [low, high] : [] };
    part("activity", "highlight").data = at
      ? { x: [left, right, right, left, left], y: [low, low, high, high, low] }
      : { x: [], y: [] };
  };

  const largest = (values) => values.reduce((top, value) => Math.max(top, Math.abs(value) || 0), 0);

  const drawPeaks = () => {
    const { windows, lags, signal, with: other, differs, label, peak_notes: notes } = page.pair();
    const { peak } = page.state;
    const lagged = peak === "lag";
    const values = windows[peak].values.map((value) => value * (lagged ? page.lagScale() : 1));
    const top = lagged ? largest(lags) * page.lagScale() || 1 : Math.ceil(10 * largest(values)) / 10 || 1;
    setColumns(part("peaks", "pixels"), { value: values });
    const pale = (q, k) => q >= 0.05 && Number.isFinite(values[k]);
    part("peaks", "not_significant").indices = [...windows.q.values.keys()].filter((k) => pale(windows.q.values[k], k));
    part("peaks", "colours").palette = page.data.palettes[peak];
    setColours("peaks", [-top, top], !lagged ? "correlation" : page.data.interval_s === null ? "frames" : "s");
    const tested = windows.q.values.some(Number.isFinite);
    const missing = !windows.correlation.values.every(Number.isFinite);
    const key = tested ? "hatched: not significant (q ≥ 0.05)" : "significance was not computed";
    text("peaks-key", missing ? `${key}; grey: not correlated` : key);
    text("peak-notes", notes.join("\n"));
    text("peaks-name", lagged ? "Lag of the peak" : "Peak correlation");
    document.getElementById("pair").title = label; // which may be longer than the list is wide
    for (const name of ["peaks", "curve"]) {
      text(`${name}-title`, `${signal} with ${other}`);
      text(`${name}-differs`, differs);
    }
    text("curve-hint", `positive lag: ${other} follows ${signal}`);
  };

  const drawCurve = () => {
    const { lags, layers, layer_curves: layerCurves, layer_partial: partial, without, curves, windows } = page.pair();
    const at = page.focus();
    const layer = at?.layer ?? page.state.layer;
    const lag = lags.map((value) => value * page.lagScale());
    const number = at && page.windowOf(at.layer, at.sector);
    const of = (array) => page.row({ ...array, shape: [0, lag.length] }, number);
    const mean = page.row(layerCurves, layer);
    const bar = at ? windows.threshold.values[number] : layers.threshold.values[layer];
    const known = at && curves;
    const none = { lag: [], r: [], low: [], high: [] };
    const [low, high] = known ? [of(curves.low), of(curves.high)] : [[], []];
    part("curve", "layer").data = { lag, r: mean };
    part("curve", "without").data = without ? { lag, r: page.row(partial, layer) } : { lag: [], r: [] };
    part("curve", "null").data = { lag, low: lag.map(() => -bar), high: lag.map(() => bar) };
    part("curve", "window").data = known ? { lag, r: of(curves.correlation) } : none;
    part("curve", "band").data = known ? { lag, low, high } : none;
    part("curve", "peak").data = at
      ? { lag: [windows.lag.values[number] * page.lagScale()], r: [windows.correlation.values[number]] }
      : none;
    const top = Math.min(1, Math.ceil(5 * (largest([...mean, bar, ...low, ...high]) || 1)) / 5);
    figures.curve.y_range.setv({ start: -top, end: top });
    const ends = lag.length > 1 ? [lag[0], lag.at(-1)] : [-1, 1];
    figures.curve.x_range.setv({ start: ends[0], end: ends[1] });
    const correlated = at && Number.isFinite(windows.correlation.values[number]);
    const name = at && `${page.layerWords(at.layer)}, sector ${at.sector}`;
    const band = known ? ", band: 95 % at each lag by itself" : "";
    text("curve-window", !at ? "point at a window" : correlated ? `${name}${band}` : `${name}: not correlated`);
    const [r, peak, q] = ["correlation", "lag", "q"].map((key) => layers[key].values[layer]);
    const [left, qLeft] = ["correlation_partial", "q_partial"].map((key) => layers[key].values[layer]);
    const rest = Number.isFinite(left) ? `; dotted: ${without}, r ${page.fixed(left)}, q ${page.chance(qLeft)}` : "";
    const found = `r ${page.fixed(r)} at ${page.lagSeconds(peak) || page.frameWords(peak)}, q ${page.chance(q)}${rest}`;
    text("curve-layer", `mean of ${page.layerWords(layer)}: ${Number.isFinite(r) ? found : "not correlated"}`);
    const chance = Number.isFinite(bar) ? ", 95 % over all lags" : ": not known";
    text("curve-null", `chance for the ${at ? "window" : "mean"}${chance}`);
  };

  page.draw = () => {
    const { index, channel, layer, pair, peak, colours, hover } = page.state;
    const at = page.focus();
    const window = at && [at.layer, at.sector];
    when("cell", [index, channel, window], drawCell);
    when("disk", [index, channel], drawDisk);
    when("activity", [channel, layer, colours], drawActivity);
    when("intensity", [channel], drawIntensity);
    when("time", [index, hover?.index], drawTime);
    when("focus", [window, at?.index], drawFocus);
    if (figures.profile) {
      when("profile", [index, channel], drawProfile);
      when("profile-focus", [index, channel, layer, at?.layer], drawProfileFocus);
    }
    if (figures.peaks) {
      when("peaks", [pair, peak], drawPeaks);
      when("curve", [pair, window, layer], drawCurve);
    }
    page.drawControls();
  };
})();
