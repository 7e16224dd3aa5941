"use strict";
// The cell pixel by pixel: numbers for the colours, and lines over them. RGBA is 0xAABBGGRR.
(() => {
  const page = window.cytodisk;
  const OUTSIDE = 65535;
  const WHITE = 0xffffffff;
  const BLACK = 0xff000000;
  const FAINT = 0x4dffffff;
  const SKY = 0xffe9b456; // of the nuclear outline, #56b4e9

  // A plain loop, as it runs over every pixel in every frame.
  const lookUp = (numbers, table) => {
    const values = new Float32Array(numbers.length);
    for (let k = 0; k < numbers.length; k++) values[k] = table[numbers[k]];
    return values;
  };

  // Ends of the colours: those of pixels, which spread more than means of windows, or else of windows.
  page.cellLimits = ({ channels }) => {
    const { channel } = page.state;
    return channels?.[channel] ? page.data.picture.limits[channel] : page.channel().limits;
  };

  // The signal in each pixel, or the value of its window where there are no pixels.
  page.cellValues = (decoded, byWindow) => {
    const grey = decoded.channels?.[page.state.channel];
    const [low, high] = page.cellLimits(decoded);
    if (grey) return lookUp(grey, Float32Array.from({ length: 256 }, (_, k) => low + ((high - low) * k) / 255));
    const table = new Float32Array(OUTSIDE + 1).fill(NaN);
    table.set(byWindow);
    const [height, width] = page.data.picture.shape;
    return lookUp(decoded.labels ?? new Uint16Array(height * width).fill(OUTSIDE), table);
  };

  // Lines between windows and around the cell, white paper outside a cell without pixels, and the
  // chosen window: white just inside and black just outside, so that it stands out from every colour.
  page.cellLines = ({ labels, channels }, chosen, shape = page.data.picture.shape) => {
    const [height, width] = shape;
    const grey = channels?.[page.state.channel];
    const pixels = new Uint32Array(height * width);
    if (!grey) pixels.fill(WHITE);
    if (!labels) return pixels;
    const inner = (page.data.cytoplasm_layers ?? Infinity) * page.data.sectors; // windows of the nucleus
    for (let k = 0; k < labels.length; k++) {
      const here = labels[k];
      const right = (k + 1) % width ? labels[k + 1] : here; // not the next row's first
      const below = labels[k + width] ?? here;
      if (here !== OUTSIDE) pixels[k] = 0;
      if (here === right && here === below) continue;
      const edge = here === OUTSIDE || right === OUTSIDE || below === OUTSIDE;
      const nuclear = here >= inner !== right >= inner || here >= inner !== below >= inner;
      pixels[k] = edge ? (grey ? WHITE : BLACK) : nuclear ? SKY : FAINT;
    }
    for (let k = 0; chosen !== null && k < labels.length; k++) {
      if (labels[k] !== chosen) continue;
      for (let dy = -2; dy <= 2; dy++) {
        for (let dx = -2; dx <= 2; dx++) {
          const near = k + dy * width + dx;
          if (labels[near] === chosen) continue;
          pixels[near] = BLACK;
          if (Math.abs(dx) < 2 && Math.abs(dy) < 2) pixels[k] = WHITE;
        }
      }
    }
    return pixels;
  };
})();
