"use strict";
// What is chosen, what lies under the pointer, and the numbers that belong to it.
(() => {
  const page = window.cytodisk;

  page.state = {
    index: 0, // place among the shown frames
    channel: 0,
    layer: 0,
    pair: 0,
    peak: "correlation",
    colours: "all",
    playing: false,
    hover: null, // { layer, sector, index? }
    pinned: null, // { layer, sector }
    get frame() {
      return page.data.frames[this.index];
    },
  };

  const clamp = (value, count) => Math.min(Math.max(value, 0), count - 1);

  let waiting = false;
  page.set = (changes) => {
    const { state, data } = page;
    Object.assign(state, changes);
    state.index = clamp(state.index, data.frames.length);
    state.layer = clamp(state.layer, data.layers);
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      page.draw();
    });
  };

  // Window and moment that all views highlight; null if there is none.
  page.focus = () => {
    const { pinned, hover, index } = page.state;
    const at = pinned ?? hover;
    return at && { layer: at.layer, sector: at.sector, index: hover?.index ?? index };
  };

  page.pin = (window) => {
    const { pinned } = page.state;
    const same = pinned && window && pinned.layer === window.layer && pinned.sector === window.sector;
    const pin = same || !window ? null : { layer: window.layer, sector: window.sector };
    page.set({ pinned: pin, ...(pin && { layer: pin.layer }) });
  };

  page.windowOf = (layer, sector) => layer * page.data.sectors + sector;

  // Values of all windows of a frame, as a view into the array.
  page.byWindow = (array, index) => {
    const { layers, sectors } = page.data;
    const size = layers * sectors;
    return array.values.subarray(index * size, (index + 1) * size);
  };

  page.channel = () => page.data.channels[page.state.channel];
  page.channelValues = () => page.channel().mean ?? page.data.area;
  page.pair = () => page.data.pairs[page.state.pair];

  page.indexOfFrame = (frame) => {
    const { frames, every } = page.data;
    return clamp(Math.round((frame - frames[0]) / every), frames.length);
  };

  page.timeOf = (index) => {
    const { frames, interval_s: interval } = page.data;
    return interval === null ? "" : `${page.digits(frames[index] * interval)} s`;
  };

  page.digits = (value) => {
    if (value === null || value === undefined || !Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    if (size === 0) return "0";
    const text = size >= 1e5 || size < 1e-3 ? value.toExponential(1) : size >= 1000 ? value.toFixed(0) : value.toPrecision(3);
    return text.replace("-", "−");
  };

  const signed = (text) => text.replace("-", "−");
  const known = (value) => typeof value === "number" && Number.isFinite(value);

  // Correlations with two decimals; p and q with two digits; lags, which are whole frames, without zeros.
  page.fixed = (value) => (known(value) ? signed(value.toFixed(2).replace(/^-(0\.00)$/, "$1")) : "–");
  page.chance = (value) => (known(value) ? signed(String(Number(value.toPrecision(2)))) : "–");
  page.frameWords = (lag) => `${signed(String(lag))} ${Math.abs(lag) === 1 ? "frame" : "frames"}`;

  // A lag, in frames, in the unit of the axis.
  page.lagScale = () => page.data.interval_s ?? 1;
  page.lagUnit = () => (page.data.interval_s === null ? "frames" : "s");
  page.lagWords = (lag) => {
    if (!known(lag)) return "–";
    const { interval_s: interval } = page.data;
    return interval === null ? page.frameWords(lag) : `${signed(String(Number((lag * interval).toPrecision(3))))} s`;
  };

  page.withUnit = (value, unit) => {
    const text = page.digits(value);
    return text === "–" || !unit ? text : `${text} ${unit}`;
  };
})();
