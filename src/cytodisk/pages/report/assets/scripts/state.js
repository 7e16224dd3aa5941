"use strict";
// What is chosen, what lies under the pointer, and the numbers that belong to it.
(() => {
  const page = window.cytodisk;
  const { known, words } = page;

  page.state = {
    cell: 0, // its number in the study
    index: 0, // place among the shown frames
    channel: 0,
    layer: 0,
    pair: 0,
    peak: "correlation",
    colours: "all",
    shows: "pixels", // in the cell: pixels, means, correlation, lag
    grid: true,
    rim: true,
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
    if (!data) return; // no cell is open yet
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
  page.placeOf = (window) => window === null ? null : { layer: Math.floor(window / page.data.sectors), sector: window % page.data.sectors };

  page.channel = () => page.data.channels[page.state.channel];
  page.channelValues = () => page.channel().mean ?? page.data.area;
  page.channelWords = () => (page.channel().mean ? `mean ${page.channel().name}` : page.channel().name);
  page.pair = () => page.data.pairs[page.state.pair];

  page.indexOfFrame = (frame) => {
    const { frames, every } = page.data;
    return clamp(Math.round((frame - frames[0]) / every), frames.length);
  };

  // Times and lags come in frames; they are shown in the units that the page's data name.
  page.timeAt = (index) => page.data.frames[index] * page.data.time_step;
  page.timeOf = (index) => (page.data.interval_s === null ? "" : `${page.digits(page.timeAt(index))} ${page.data.time_unit}`);
  page.frameWords = (lag) => (known(lag) ? `${words(lag, String)} ${Math.abs(lag) === 1 ? "frame" : "frames"}` : "–");
  page.lagScale = () => page.data.lag_step;
  page.lagWords = (lag) => {
    const number = words(lag, (value) => Number((value * page.lagScale()).toPrecision(3)));
    return page.data.interval_s === null || !known(lag) ? "" : `${number} ${page.data.lag_unit}`;
  };
})();
