"use strict";
// The figures: made by Bokeh, filled from what is chosen.
(() => {
  const page = window.cytodisk;
  const figures = {};
  const drawn = {};

  // Takes out stops of the Tab key, as no key does anything there.
  const passOver = (root) => {
    for (const element of root.querySelectorAll("*")) {
      element.removeAttribute("tabindex");
      if (element.shadowRoot) passOver(element.shadowRoot);
    }
  };

  page.embed = async (items) => {
    for (const [name, item] of Object.entries(items)) {
      await Bokeh.embed.embed_item(item, `figure-${name}`);
      figures[name] = Bokeh.documents.at(-1).roots()[0];
      passOver(document.getElementById(`figure-${name}`));
    }
  };
  page.figures = figures;

  const parts = (figure, name) => figures[figure].select(name);
  const part = (figure, name) => parts(figure, name)[0];

  // Draws a view anew if anything that it depends on has changed.
  const when = (name, key, paint) => {
    const text = JSON.stringify(key);
    if (drawn[name] === text) return;
    drawn[name] = text;
    paint();
  };

  const setPixels = (figure, pixels, shape) => {
    const source = part(figure, "pixels");
    const data = source.data instanceof Map ? Object.fromEntries(source.data) : source.data;
    const Pixels = data.image[0].constructor;
    source.data = { ...data, image: [new Pixels(pixels, shape)] };
  };

  // Two dollar signs would be read as a formula.
  const plain = (words) => words.replaceAll("$$", "$\u200b$");

  const setColours = (figure, [low, high], unit) => {
    const mapper = part(figure, "colours");
    mapper.setv({ low, high });
    part(figure, "unit").text = plain(unit);
  };

  const setPath = (figure, points) => {
    part(figure, "highlight").data = { x: points.map(([x]) => x), y: points.map(([, y]) => y) };
  };

  const text = (id, words) => {
    const element = document.getElementById(id);
    if (element && element.textContent !== words) element.textContent = words;
  };

  const channelWords = () => {
    const { name, mean } = page.channel();
    return mean ? `mean ${name}` : name;
  };

  const drawCell = async () => {
    const { index } = page.state;
    const decoded = await page.frameAt(index);
    if (index !== page.state.index) return; // a later frame is on its way
    const at = page.focus();
    const highlighted = at ? page.windowOf(at.layer, at.sector) : null;
    const values = page.byWindow(page.channelValues(), index);
    const { pixels, shape } = page.paintCell(decoded, values, highlighted);
    setPixels("cell", pixels, shape);
    setColours("cell", page.cellLimits(decoded), page.channel().unit);
    page.labels = decoded.labels;
    page.shown = { index, highlighted, channel: page.state.channel };
    const reason = page.data.reasons[index];
    text("cell-note", reason ? `no map: ${reason}` : "");
    if (page.changedAt) page.drawMilliseconds = performance.now() - page.changedAt;
    page.changedAt = null;
  };

  const wedge = ({ layer, sector }) => {
    const { radii, sectors } = page.data;
    const steps = Math.max(4, Math.ceil(120 / sectors));
    const angle = (k) => (2 * Math.PI * (sector + k / steps)) / sectors;
    const arc = (radius) =>
      Array.from({ length: steps + 1 }, (_, k) => [radius * Math.cos(angle(k)), radius * Math.sin(angle(k))]);
    const outer = arc(radii[layer]);
    return [...outer, ...arc(radii[layer + 1]).reverse(), outer[0]];
  };

  const drawDisk = () => {
    const { limits, unit } = page.channel();
    const values = page.byWindow(page.channelValues(), page.state.index);
    const { pixels, shape } = page.paintDisk(values, limits, page.palettes.signal);
    setPixels("disk", pixels, shape);
    setColours("disk", limits, unit);
    text("disk-title", channelWords());
  };

  const drawActivity = () => {
    const { layer, colours } = page.state;
    const { layers, sectors, frames } = page.data;
    const array = page.channelValues().values;
    const map = new Float32Array(sectors * frames.length);
    for (let t = 0; t < frames.length; t++) {
      for (let s = 0; s < sectors; s++) {
        map[s * frames.length + t] = array[(t * layers + layer) * sectors + s];
      }
    }
    const { limits, layer_limits: byLayer, unit } = page.channel();
    setPixels("activity", map, [sectors, frames.length]);
    setColours("activity", colours === "all" ? limits : byLayer[layer], unit);
    text("activity-title", `${channelWords()}, layer ${layer}${layer === 0 ? " (edge)" : ""}`);
  };

  const drawVelocity = () => {
    const { velocity, velocity_limit: limit, sectors, frames, units } = page.data;
    const map = new Float32Array(sectors * frames.length);
    for (let t = 0; t < frames.length; t++) {
      for (let s = 0; s < sectors; s++) map[s * frames.length + t] = velocity.values[t * sectors + s];
    }
    setPixels("velocity", map, [sectors, frames.length]);
    setColours("velocity", [-limit, limit], units.velocity);
  };

  const timeAt = (index) => page.data.frames[index] * page.data.time.step;

  const mapBox = ({ sector, index }) => {
    const half = 0.5 * page.data.every * page.data.time.step;
    const [left, right] = [timeAt(index) - half, timeAt(index) + half];
    const [low, high] = [sector - 0.5, sector + 0.5];
    return [[left, low], [right, low], [right, high], [left, high], [left, low]];
  };

  const drawTime = () => {
    const { index, hover } = page.state;
    const under = hover?.index;
    for (const name of ["activity", "velocity", "area", "residual", "distortion", "intensity"]) {
      for (const line of parts(name, "now")) line.location = timeAt(index);
      part(name, "under").location = under === undefined || under === index ? NaN : timeAt(under);
    }
  };

  const drawFocus = () => {
    const at = page.focus();
    for (const name of ["disk", "peaks"]) {
      if (figures[name]) setPath(name, at ? wedge(at) : []);
    }
    for (const name of ["activity", "velocity"]) {
      setPath(name, at ? mapBox(at) : []);
      parts(name, "row").forEach((line, k) => {
        line.location = at ? at.sector - 0.5 + k : NaN;
      });
    }
  };

  const largest = (values) => values.reduce((top, value) => (Math.abs(value) > top ? Math.abs(value) : top), 0);

  const drawPeaks = () => {
    const { windows, signal, with: other, differs, label } = page.pair();
    const lagged = page.state.peak === "lag";
    const scale = lagged ? page.lagScale() : 1;
    const values = (lagged ? windows.lag : windows.correlation).values.map((value) => value * scale);
    const top = lagged ? largest(page.pair().lags) * scale || 1 : Math.ceil(10 * largest(values)) / 10 || 1;
    const palette = lagged ? page.palettes.lag : page.palettes.diverging;
    const doubtful = (k) => windows.q.values[k] >= 0.05;
    const { pixels, shape } = page.paintDisk(values, [-top, top], palette, doubtful);
    setPixels("peaks", pixels, shape);
    part("peaks", "colours").palette = lagged ? page.data.palettes.lag : page.data.palettes.diverging;
    setColours("peaks", [-top, top], lagged ? page.lagUnit() : "correlation");
    const tested = windows.q.values.some(Number.isFinite);
    const missing = windows.correlation.values.some((value) => !Number.isFinite(value));
    const key = tested ? "hatched: not significant (q ≥ 0.05)" : "significance was not computed";
    text("peaks-key", missing ? `${key}; grey: not correlated` : key);
    text("peaks-name", lagged ? "Lag of the peak" : "Peak correlation");
    document.getElementById("pair").title = label; // which may be longer than the list is wide
    for (const name of ["peaks", "curve"]) {
      text(`${name}-title`, `${signal} with ${other}`);
      text(`${name}-differs`, differs);
    }
    text("curve-hint", `positive lag: ${other} follows ${signal}`);
  };

  const row = (array, number) => {
    const length = array.shape.at(-1);
    return Array.from(array.values.subarray(number * length, (number + 1) * length));
  };

  const drawCurve = () => {
    const { lags, layers, layer_curves: layerCurves, curves, windows } = page.pair();
    const at = page.focus();
    const layer = at?.layer ?? page.state.layer;
    const lag = lags.map((value) => value * page.lagScale());
    const number = at && page.windowOf(at.layer, at.sector);
    const bar = at ? windows.threshold.values[number] : layers.threshold.values[layer];
    part("curve", "layer").data = { lag, r: row(layerCurves, layer) };
    part("curve", "null").data = { lag, low: lag.map(() => -bar), high: lag.map(() => bar) };
    const known = at && curves;
    part("curve", "window").data = known ? { lag, r: row(curves.correlation, number) } : { lag: [], r: [] };
    part("curve", "band").data = known
      ? { lag, low: row(curves.low, number), high: row(curves.high, number) }
      : { lag: [], low: [], high: [] };
    part("curve", "peak").data = at
      ? { lag: [windows.lag.values[number] * page.lagScale()], r: [windows.correlation.values[number]] }
      : { lag: [], r: [] };
    const reach = largest([...row(layerCurves, layer), bar || 0, ...(known ? [...row(curves.low, number), ...row(curves.high, number)] : [])].filter(Number.isFinite));
    const top = Math.min(1, Math.ceil(5 * (reach || 1)) / 5);
    figures.curve.y_range.setv({ start: -top, end: top });
    const ends = [lag[0] ?? 0, lag.at(-1) ?? 0];
    figures.curve.x_range.setv(ends[0] < ends[1] ? { start: ends[0], end: ends[1] } : { start: -1, end: 1 });
    const correlated = at && Number.isFinite(windows.correlation.values[number]);
    const name = at && `layer ${at.layer}, sector ${at.sector}`;
    const band = known ? ", band: 95 % at each lag by itself" : "";
    text("curve-window", !at ? "point at a window" : correlated ? `${name}${band}` : `${name}: not correlated`);
    const peak = Object.fromEntries(Object.entries(layers).map(([name, array]) => [name, array.values[layer]]));
    const found = `r ${page.fixed(peak.correlation)} at ${page.lagWords(peak.lag)}, q ${page.chance(peak.q)}`;
    text("curve-layer", `mean of layer ${layer}: ${Number.isFinite(peak.correlation) ? found : "not correlated"}`);
    const whose = at ? "window" : "mean";
    text("curve-null", Number.isFinite(bar) ? `chance for the ${whose}, 95 % over all lags` : `chance for the ${whose}: not known`);
  };

  const drawStrip = (name, array) => {
    const { frames, every, reasons, time } = page.data;
    const values = array ? Array.from(array.values) : frames.map(() => NaN);
    const known = values.filter(Number.isFinite);
    const [low, high] = known.length ? [Math.min(...known), Math.max(...known)] : [0, 1];
    const margin = 0.12 * (high - low || Math.abs(high) || 1);
    part(name, "line").data = { x: frames.map((frame) => frame * time.step), y: values };
    const lost = frames.filter((_, k) => reasons[k]);
    const half = 0.5 * every;
    part(name, "missing").data = {
      left: lost.map((frame) => (frame - half) * time.step),
      right: lost.map((frame) => (frame + half) * time.step),
    };
    figures[name].y_range.setv({ start: low - margin, end: high + margin });
  };

  const drawIntensity = () => {
    const { name, unit, whole_mean: mean } = page.channel();
    const words = mean ? `mean ${name} of the cell (${unit})` : "mean intensity: not of window areas";
    figures.intensity.title.text = plain(words);
    drawStrip("intensity", mean);
  };

  page.drawAlways = () => {
    const { area, tracking_residual: residual, area_distortion: distortion } = page.data.quality;
    drawStrip("area", area);
    drawStrip("residual", residual);
    drawStrip("distortion", distortion);
    drawVelocity();
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
    if (figures.peaks) {
      when("peaks", [pair, peak], drawPeaks);
      when("curve", [pair, window, layer], drawCurve);
    }
    page.drawControls();
  };
})();
