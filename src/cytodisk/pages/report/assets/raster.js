"use strict";
// Pictures computed pixel by pixel: the cell, and disks of windows. Colours are 0xAABBGGRR.
(() => {
  const page = window.cytodisk;
  const OUTSIDE = 65535;
  const WHITE = 0xffffffff;
  const BLACK = 0xff000000;
  const PAPER = 0xffffffff;
  const MASK = 0xffd9d9d9;
  const HATCH = 0xff9a9a9a;
  const DISK_SIZE = 480;

  page.colours = (list) =>
    Uint32Array.from(list, (text) => {
      const rgb = Number.parseInt(text.slice(1), 16);
      return (BLACK | ((rgb & 255) << 16) | (rgb & 0xff00) | (rgb >> 16)) >>> 0;
    });

  page.colourOf = (palette, [low, high], value) => {
    if (!Number.isFinite(value)) return MASK;
    const share = high > low ? (value - low) / (high - low) : 0.5;
    return palette[Math.min(Math.max(Math.floor(share * palette.length), 0), palette.length - 1)];
  };

  // `share` of `over` on top of `under`.
  const blend = (under, over, share) => {
    let mixed = 0xff;
    for (const shift of [16, 8, 0]) {
      const a = (under >>> shift) & 255;
      const b = (over >>> shift) & 255;
      mixed = (mixed << 8) | Math.round(a + share * (b - a));
    }
    return mixed >>> 0;
  };

  // Plain loops, as these run over every pixel in every frame.
  const lookUp = (numbers, table) => {
    const pixels = new Uint32Array(numbers.length);
    for (let k = 0; k < numbers.length; k++) pixels[k] = table[numbers[k]];
    return pixels;
  };

  const pixelColours = (grey, [low, high], limits, palette) => {
    const table = Uint32Array.from({ length: 256 }, (_, k) =>
      page.colourOf(palette, limits, low + ((high - low) * k) / 255),
    );
    return lookUp(grey, table);
  };

  const windowColours = (labels, values, limits, palette) => {
    const table = new Uint32Array(OUTSIDE + 1).fill(PAPER);
    values.forEach((value, window) => {
      table[window] = page.colourOf(palette, limits, value);
    });
    return lookUp(labels, table);
  };

  const drawBorders = (pixels, labels, width, outline) => {
    const last = labels.length - width;
    for (let k = 0; k < last; k++) {
      const here = labels[k];
      const right = labels[k + 1];
      const below = labels[k + width];
      if (here === right && here === below) continue;
      const edge = here === OUTSIDE || right === OUTSIDE || below === OUTSIDE;
      pixels[k] = edge ? blend(pixels[k], outline, 0.95) : blend(pixels[k], WHITE, 0.3);
    }
  };

  // White just inside a window and black just outside, so that it stands out from every colour.
  const drawHighlight = (pixels, labels, width, window) => {
    const outside = [];
    for (let k = 0; k < labels.length; k++) {
      if (labels[k] !== window) continue;
      let border = false;
      for (let dy = -2; dy <= 2; dy++) {
        for (let dx = -2; dx <= 2; dx++) {
          const near = k + dy * width + dx;
          if (near < 0 || near >= labels.length || labels[near] === window) continue;
          outside.push(near);
          border ||= Math.abs(dx) < 2 && Math.abs(dy) < 2;
        }
      }
      if (border) pixels[k] = WHITE;
    }
    for (const k of outside) pixels[k] = BLACK;
  };

  // Ends of the colours: those of pixels, which spread more than means of windows, or else of windows.
  page.cellLimits = (decoded) => {
    const { channel } = page.state;
    return decoded.channels?.[channel] ? page.data.picture.limits[channel] : page.channel().limits;
  };

  // The cell in a frame: pixels of the signal, or windows in their colours where there are none.
  page.paintCell = (decoded, values, highlighted) => {
    const { shape, limits } = page.data.picture;
    const { channel } = page.state;
    const range = page.cellLimits(decoded);
    const grey = decoded.channels?.[channel];
    let pixels = new Uint32Array(shape[0] * shape[1]).fill(PAPER);
    if (grey) pixels = pixelColours(grey, limits[channel], range, page.palettes.signal);
    else if (decoded.labels) pixels = windowColours(decoded.labels, values, range, page.palettes.signal);
    if (decoded.labels) {
      drawBorders(pixels, decoded.labels, shape[1], grey ? WHITE : BLACK);
      if (highlighted !== null) drawHighlight(pixels, decoded.labels, shape[1], highlighted);
    }
    return { pixels, shape };
  };

  page.windowAtDisk = (u, v) => {
    const { radii, sectors, layers } = page.data;
    const radius = Math.hypot(u, v);
    if (!(radius <= 1)) return null;
    let layer = 0;
    while (layer < layers - 1 && radius <= radii[layer + 1]) layer++;
    const turn = Math.atan2(v, u) / (2 * Math.PI);
    const sector = Math.min(Math.floor((turn - Math.floor(turn)) * sectors), sectors - 1);
    return { layer, sector };
  };

  let windows = null;
  const diskWindows = () => {
    windows ??= Int32Array.from({ length: DISK_SIZE * DISK_SIZE }, (_, k) => {
      const u = (2 * ((k % DISK_SIZE) + 0.5)) / DISK_SIZE - 1;
      const v = (2 * (Math.floor(k / DISK_SIZE) + 0.5)) / DISK_SIZE - 1;
      const at = page.windowAtDisk(u, v);
      return at ? page.windowOf(at.layer, at.sector) : -1;
    });
    return windows;
  };

  // A disk of windows; `doubtful(window)` ones are pale and hatched.
  page.paintDisk = (values, limits, palette, doubtful = () => false) => {
    const colours = Uint32Array.from(values, (value) => page.colourOf(palette, limits, value));
    const pale = Array.from(values, (value, k) => Number.isFinite(value) && doubtful(k));
    const soft = colours.map((colour) => blend(colour, WHITE, 0.55));
    const of = diskWindows();
    const pixels = new Uint32Array(of.length);
    for (let k = 0; k < of.length; k++) {
      const window = of[k];
      if (window < 0) continue;
      if (!pale[window]) pixels[k] = colours[window];
      else pixels[k] = ((k % DISK_SIZE) + Math.floor(k / DISK_SIZE)) % 9 < 2 ? HATCH : soft[window];
    }
    return { pixels, shape: [DISK_SIZE, DISK_SIZE] };
  };
})();
