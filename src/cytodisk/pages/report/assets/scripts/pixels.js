"use strict";
// A cell pixel by pixel: its signal or colours of its windows, lines over them. RGBA is 0xAABBGGRR.
(() => {
  const page = window.cytodisk;
  const OUTSIDE = 65535;
  const [WHITE, BLACK, GREY, MISSING, HATCH] = [0xffffffff, 0xff000000, 0xff555555, 0xffd9d9d9, 0xff9a9a9a];
  const SKY = 0xffe9b456; // of the nuclear outline, #56b4e9
  const RIM = 4; // pixels of the picture

  // Colours "#rrggbb" as numbers.
  page.packed = (palette) => Uint32Array.from(palette, (colour) => {
    const [r, g, b] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
    return (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
  });

  // A share of white in a colour.
  const paler = (colour, share) =>
    [16, 8, 0].reduce((all, shift) => all | (Math.round(((colour >> shift) & 255) * (1 - share) + 255 * share) << shift), 0xff000000) >>> 0;

  page.packedColour = (value, [low, high], colours) => {
    if (!Number.isFinite(value)) return MISSING;
    return colours[Math.round(Math.min(Math.max((value - low) / (high - low), 0), 1) * (colours.length - 1))];
  };

  // picture: { shape, labels, grey, ends }, ends: values of black and white of the grey picture, or no grey.
  // values: by window, painted where there is no grey picture. grid: whether lines between windows are drawn.
  // marks: windows with a black border; pale: hatched ones; chosen: one that stands out; rim: colour by sector
  // around the cell; inner: first window of the nucleus; lines: false for the picture alone.
  page.paint = (canvas, { shape: [height, width], labels, grey = null, ends }, how) => {
    const { values = [], limits, colours, grid = true, chosen = null, marks = [], pale = [], rim = null, inner = Infinity } = how;
    const pixels = new Uint32Array(height * width).fill(WHITE);
    if (grey) {
      const [low, high] = ends;
      const table = Uint32Array.from({ length: 256 }, (_, k) => page.packedColour(low + ((high - low) * k) / 255, limits, colours));
      for (let k = 0; k < grey.length; k++) pixels[k] = table[grey[k]];
    } else if (labels) {
      const table = new Uint32Array(OUTSIDE + 1).fill(MISSING);
      values.forEach((value, k) => (table[k] = page.packedColour(value, limits, colours)));
      for (const k of pale) table[k] = paler(table[k], 0.5);
      table[OUTSIDE] = WHITE;
      for (let k = 0; k < labels.length; k++) pixels[k] = table[labels[k]];
      if (pale.length) hatch(pixels, labels, width, new Set(pale));
    }
    if (labels) {
      if (rim) paintRim(pixels, labels, width, rim);
      drawLines(pixels, labels, width, { grid, edge: grey ? WHITE : GREY, inner, marks: marks.length ? new Set(marks) : null });
      if (chosen !== null) drawChosen(pixels, labels, width, chosen);
    }
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(pixels.buffer), width, height), 0, 0);
  };

  const hatch = (pixels, labels, width, pale) => {
    for (let k = 0; k < labels.length; k++) {
      if ((Math.floor(k / width) + (k % width)) % 8 === 0 && pale.has(labels[k])) pixels[k] = HATCH;
    }
  };

  // A band along the cell's edge, outside.
  const paintRim = (pixels, labels, width, rim) => {
    const near = [];
    for (let dy = -RIM; dy <= RIM; dy++) for (let dx = -RIM; dx <= RIM; dx++) if (Math.hypot(dx, dy) <= RIM) near.push([dx, dy]);
    for (let k = 0; k < labels.length; k++) {
      if (labels[k] >= rim.length) continue; // of the outermost layer alone
      const x = k % width;
      const inside = x && x < width - 1 && [k - 1, k + 1, k - width, k + width].every((at) => labels[at] !== OUTSIDE);
      if (inside) continue;
      for (const [dx, dy] of near) {
        const at = k + dy * width + dx;
        if (x + dx >= 0 && x + dx < width && labels[at] === OUTSIDE) pixels[at] = rim[labels[k]];
      }
    }
  };

  // Lines are fainter where windows are small, so that they do not hide the signal.
  const drawLines = (pixels, labels, width, { grid, edge, inner, marks }) => {
    const sizes = new Uint32Array(OUTSIDE + 1);
    for (let k = 0; k < labels.length; k++) sizes[labels[k]]++;
    for (let k = 0; k < labels.length; k++) {
      const here = labels[k];
      const right = (k + 1) % width ? labels[k + 1] : here; // not the next row's first
      const below = labels[k + width] ?? here;
      if (here === OUTSIDE) continue;
      const [left, above] = [k % width ? labels[k - 1] : here, labels[k - width] ?? here];
      if (right === OUTSIDE || below === OUTSIDE || left === OUTSIDE || above === OUTSIDE) pixels[k] = edge;
      else if (here === right && here === below) continue;
      else if (here >= inner !== right >= inner || here >= inner !== below >= inner) pixels[k] = SKY;
      else if (marks && (marks.has(here) !== marks.has(right) || marks.has(here) !== marks.has(below))) pixels[k] = BLACK;
      else if (grid) pixels[k] = paler(pixels[k], Math.min(0.32, sizes[here] / 600));
    }
  };

  // White just inside and black just outside, so that it stands out from every colour.
  const drawChosen = (pixels, labels, width, chosen) => {
    for (let k = 0; k < labels.length; k++) {
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
  };

  // Middles [x, y] of windows in a picture; of those that have pixels.
  const middles = (labels, width, windows) => {
    const sums = new Map(windows.map((window) => [window, [0, 0, 0]]));
    for (let k = 0; k < labels.length; k++) {
      const sum = sums.get(labels[k]);
      if (sum) [sum[0], sum[1], sum[2]] = [sum[0] + (k % width), sum[1] + Math.floor(k / width), sum[2] + 1];
    }
    return new Map([...sums].filter(([, [, , count]]) => count).map(([window, [x, y, count]]) => [window, [x / count, y / count]]));
  };

  // Where numbers of sectors stand beside a cell's edge: [{ sector, x, y, dx, dy }], (dx, dy) outwards.
  page.sectorPlaces = ({ shape: [height, width], labels }, layers, sectors) => {
    if (!labels) return [];
    const inner = Math.min(2, layers - 1);
    const wanted = page.numberedSectors(sectors);
    const found = middles(labels, width, wanted.flatMap((sector) => [sector, inner * sectors + sector]));
    return wanted.flatMap((sector) => {
      const [at, from] = [found.get(sector), found.get(inner * sectors + sector)];
      if (!at) return [];
      const [ax, ay] = from && inner ? [at[0] - from[0], at[1] - from[1]] : [at[0] - width / 2, at[1] - height / 2];
      const length = Math.hypot(ax, ay) || 1;
      const [dx, dy] = [ax / length, ay / length];
      let [x, y] = at;
      const isInside = () => x >= 0 && y >= 0 && x < width && y < height && labels[Math.round(y) * width + Math.round(x)] !== OUTSIDE;
      while (isInside()) [x, y] = [x + dx, y + dy];
      return [{ sector, x, y, dx, dy }];
    });
  };

  // Window under the pointer; null outside the cell.
  page.windowOnCell = (canvas, labels, { clientX, clientY }) => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const [column, row] = [((clientX - left) / width) * canvas.width, ((clientY - top) / height) * canvas.height].map(Math.floor);
    if (column < 0 || column >= canvas.width) return null;
    const label = labels?.[row * canvas.width + column] ?? OUTSIDE;
    return label === OUTSIDE ? null : label;
  };

  // Black and white that suit the cell: where 1 and 99.5 % of its pixels are darker, as shares of all.
  page.autoContrast = ({ labels, grey }) => {
    const counts = new Float64Array(256);
    let whole = 0;
    for (let k = 0; k < grey.length; k++) {
      if (labels && labels[k] === OUTSIDE) continue;
      counts[grey[k]]++;
      whole++;
    }
    const at = (share) => {
      let sum = 0;
      return counts.findIndex((count) => (sum += count) >= share * whole) / 255;
    };
    return [at(0.01), at(0.995)];
  };
})();
