"use strict";
// What is chosen, what lies under the pointer, and the numbers that belong to it.
(() => {
  const page = window.cytodisk;
  const { known, words } = page;

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

  // A layer's number, and in cells with a nucleus what it is.
  page.layerWords = (layer) => {
    const { cytoplasm_layers: inside, layer_places: places } = page.data;
    return `layer ${layer}${inside === null ? "" : places[layer]}`;
  };

  page.windowOf = (layer, sector) => layer * page.data.sectors + sector;

  // A row of an array, as a view into it; rows of arrays by frame hold all windows.
  page.row = ({ values, shape }, number) => {
    const length = shape.slice(1).reduce((product, size) => product * size, 1);
    return values.subarray(number * length, (number + 1) * length);
  };

  page.channel = () => page.data.channels[page.state.channel];
  page.channelValues = () => page.channel().mean ?? page.data.area;
  page.pair = () => page.data.pairs[page.state.pair];

  page.indexOfFrame = (frame) => {
    const { frames, every } = page.data;
    return clamp(Math.round((frame - frames[0]) / every), frames.length);
  };

  // Times and lags come in frames; the axes are in seconds where they are known.
  page.seconds = (frames, digits) => {
    const { interval_s: interval } = page.data;
    return interval === null || !known(frames) ? "" : `${digits(frames * interval)} s`;
  };
  page.timeOf = (index) => page.seconds(page.data.frames[index], page.digits);
  page.frameWords = (lag) => (known(lag) ? `${words(lag, String)} ${Math.abs(lag) === 1 ? "frame" : "frames"}` : "–");
  page.lagSeconds = (lag) => page.seconds(lag, (value) => words(value, () => Number(value.toPrecision(3))));
  page.lagScale = () => page.data.interval_s ?? 1;
})();
