"use strict";
// One cell in large: pixels or windows, the disk beside it, the window under the pointer.
(() => {
  const page = window.cytodisk;
  const OUTSIDE = 65535;
  const CANVAS = 640; // of the disk, in its own pixels
  const byId = (id) => document.getElementById(id);
  const state = { cell: null, channel: 0, shows: "signal", contrast: "all", grid: true, window: null, pinned: null };
  page.cellState = state;
  let shown = null; // { picture, decoded, numbers }

  const kept = new Map();
  page.pictureOf = async (cell) => {
    const picture = page.pictures[page.data.pictured.indexOf(cell)];
    if (!picture) return null;
    if (!kept.has(cell)) kept.set(cell, page.decode(picture, picture.shape).then((decoded) => ({ picture, decoded })));
    return kept.get(cell);
  };

  // Black and white of a channel's pixels: of this cell, or for all cells the same.
  page.pixelLimits = ({ picture }, channel, contrast) =>
    contrast === "own" ? picture.limits[channel] : page.data.pixel_limits[channel];

  // Paints pixels, or values by window; then lines.
  page.paintCell = (canvas, { picture, decoded }, { channel, means, limits, lines, chosen }) => {
    const [height, width] = picture.shape;
    const { labels, channels } = decoded;
    const grey = means ? null : channels?.[channel];
    const colours = page.paletteNumbers;
    const pixels = new Uint32Array(height * width).fill(0xffffffff);
    const colour = (value) => {
      if (!Number.isFinite(value)) return 0xffd9d9d9;
      return colours[Math.round(Math.min(Math.max((value - limits[0]) / (limits[1] - limits[0]), 0), 1) * 255)];
    };
    if (grey) {
      const [low, high] = picture.limits[channel];
      const table = Uint32Array.from({ length: 256 }, (_, k) => colour(low + ((high - low) * k) / 255));
      for (let k = 0; k < grey.length; k++) pixels[k] = table[grey[k]];
    } else {
      const table = new Uint32Array(OUTSIDE + 1).fill(0xffd9d9d9);
      table[OUTSIDE] = 0xffffffff;
      means?.forEach((value, k) => (table[k] = colour(value)));
      for (let k = 0; k < labels.length; k++) pixels[k] = table[labels[k]];
    }
    if (lines !== "none") {
      const faint = lines === "all";
      const over = page.cellLines({ labels, channels: grey ? { [page.state.channel]: grey } : null }, chosen, picture.shape);
      for (let k = 0; k < over.length; k++) {
        if ((over[k] === 0x4dffffff && !faint) || over[k] === 0 || (!grey && over[k] === 0xffffffff && labels[k] === OUTSIDE)) continue;
        pixels[k] = over[k] === 0x4dffffff ? blend(pixels[k]) : over[k];
      }
    }
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const image = new ImageData(new Uint8ClampedArray(pixels.buffer), width, height);
    canvas.getContext("2d").putImageData(image, 0, 0);
  };

  // A third of white over a colour.
  const blend = (colour) => {
    const part = (shift) => Math.round(((colour >> shift) & 255) * 0.7 + 76) << shift;
    return (0xff000000 | part(16) | part(8) | part(0)) >>> 0;
  };

  const numbersOf = async ({ picture }) => {
    if (!picture.numbers) return {};
    const { mean, sd, area, depth } = await page.unpack(picture.numbers);
    return { mean, sd, area: area?.values, depth: depth?.values };
  };

  // Cells that were mapped without a nucleus where others have one have fewer layers.
  const inside = (values, { radii, sectors }) => [...values].slice(0, (radii.length - 1) * sectors);
  const gridOf = (picture) => ({ radii: picture.radii ?? page.data.radii, sectors: page.data.sectors });
  const rowOf = (array, number) => array && page.row(array, number);
  const meansOf = () => rowOf(shown.numbers.mean, state.channel);
  const chosen = () => state.pinned ?? state.window;

  const layerWords = (window) => {
    const layer = Math.floor(window / page.data.sectors);
    const place = shown.picture.plain ? (layer ? "" : " (edge)") : page.data.layer_places[layer];
    return `layer ${layer}${place}, sector ${window % page.data.sectors}`;
  };

  const readOut = () => {
    const window = chosen();
    const { numbers } = shown;
    const rows = [];
    const { units, channels } = page.data;
    if (window !== null && numbers.area) {
      const border = page.data.layer_borders[Math.floor(window / page.data.sectors)];
      rows.push(["window", layerWords(window)]);
      channels.forEach(({ name, unit }, k) => {
        const [mean, sd] = [rowOf(numbers.mean, k)[window], rowOf(numbers.sd, k)[window]];
        rows.push([`${name}, mean ± sd`, `${page.digits(mean)} ± ${page.withUnit(sd, unit)}`]);
      });
      rows.push(["area", page.withUnit(numbers.area[window], units.area)]);
      rows.push(["depth", page.withUnit(numbers.depth[window], units.depth) + (border ? ` (${border})` : "")]);
    }
    const hint = shown.numbers.area ? "Point at a window, in the cell or on the disk; click to pin it." : "";
    byId("read").replaceChildren(...rows.flatMap(([term, words]) => [page.make("dt", {}, term), page.make("dd", {}, words)]));
    byId("read-hint").textContent = rows.length ? (state.pinned === null ? "" : "pinned: Esc lets go") : hint;
  };

  const drawScale = ({ box }, shownWidth) => {
    const size = page.data.pixel_size_um ?? 1;
    const longest = 0.3 * box[3] * size;
    const power = 10 ** Math.floor(Math.log10(longest));
    const length = Math.max(...[0.5, 1, 2, 5].map((step) => step * power).filter((one) => one <= longest * 1.000001));
    const bar = byId("cell-scale");
    bar.style.width = `${(length / size / box[3]) * shownWidth}px`;
    bar.style.left = `${byId("cell-picture").offsetLeft + 10}px`;
    bar.textContent = `${Number(length.toPrecision(1))} ${page.data.pixel_size_um === null ? "px" : "µm"}`;
  };

  const fit = ({ shape: [height, width] }) => {
    const { clientWidth, clientHeight } = byId("cell-frame");
    const factor = Math.min(clientWidth / width, clientHeight / height);
    const canvas = byId("cell-picture");
    canvas.style.width = `${width * factor}px`;
    canvas.style.height = `${height * factor}px`;
    return width * factor;
  };

  page.drawCell = () => {
    if (!shown) return;
    const { picture, numbers } = shown;
    const { channels, palette } = page.data;
    const { channel, shows, contrast } = state;
    const unit = channels[channel]?.unit ?? "";
    const means = meansOf();
    const own = means && ends(means);
    const ofMeans = contrast === "own" && own ? own : channels[channel]?.limits ?? [0, 1];
    const hasPixels = Boolean(picture.channels);
    const asMeans = shows === "means" || !hasPixels;
    const limits = stretched(asMeans ? ofMeans : page.pixelLimits(shown, channel, contrast));
    page.state.channel = 0;
    page.paintCell(byId("cell-picture"), shown, {
      channel, means: asMeans ? means ?? [] : null, limits, lines: state.grid ? "all" : "outline", chosen: picture.windows ? chosen() : null,
    });
    page.drawBar(byId("cell-bar"), limits, palette, unit);
    drawScale(picture, fit(picture));
    const name = channels[channel]?.name;
    byId("cell-shows").textContent = !name ? "windows; no signal" : asMeans ? `mean ${name} by window` : name;
    const mapped = Boolean(numbers.area);
    byId("disk-side").hidden = !mapped;
    if (mapped) {
      const diskLimits = stretched(ofMeans);
      byId("disk-shows").textContent = name ? `mean ${name}` : "area of windows";
      const values = means ?? numbers.area;
      const shownLimits = means ? diskLimits : ends(numbers.area);
      const nucleus = picture.plain ? null : page.data.cytoplasm_layers;
      const grid = gridOf(picture);
      page.drawDisk(byId("cell-disk"), grid, inside(values, grid), { limits: shownLimits, palette, chosen: chosen(), nucleus });
      page.drawBar(byId("disk-bar"), shownLimits, palette, means ? unit : page.data.units.area);
    }
    readOut();
    page.shownCell = state.cell;
  };

  const ends = (values) => {
    const known = [...values].filter(Number.isFinite).sort((a, b) => a - b);
    if (!known.length) return [0, 1];
    const [low, high] = [known[Math.floor(0.01 * known.length)], known[Math.ceil(0.995 * known.length) - 1]];
    return high > low ? [low, high] : [low - 0.5, low + 0.5];
  };

  // The sliders' part of a range.
  const stretched = ([low, high]) => {
    const [black, white] = ["black", "white"].map((id) => byId(id).valueAsNumber / 100);
    return [low + black * (high - low), low + Math.max(white, black + 0.01) * (high - low)];
  };

  page.showCell = async (cell) => {
    Object.assign(state, { cell, window: null, pinned: null });
    const found = await page.pictureOf(cell);
    const numbers = found && (await numbersOf(found));
    if (state.cell !== cell) return; // another one was asked for in the meantime
    shown = found && { ...found, numbers };
    byId("cell-views").hidden = !found;
    byId("no-picture").hidden = Boolean(found);
    if (found) page.drawCell();
    else {
      byId("no-picture").textContent = page.data.pictured.includes(cell)
        ? "There is nothing to show of this cell: see the reason in its row."
        : `This page holds no picture of this cell: cytodisk report ${page.data.folder} --cell ${cell} writes one.`;
      page.shownCell = cell;
    }
  };

  const overPicture = (event) => {
    const canvas = byId("cell-picture");
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const column = Math.floor(((event.clientX - left) / width) * canvas.width);
    const row = Math.floor(((event.clientY - top) / height) * canvas.height);
    const label = shown.decoded.labels?.[row * canvas.width + column] ?? OUTSIDE;
    return label === OUTSIDE || !shown.picture.windows ? null : label;
  };
  const overDisk = (event) => page.windowOnDisk(byId("cell-disk"), gridOf(shown.picture), event);

  const move = (window) => {
    if (state.window === window) return;
    state.window = window;
    if (state.pinned === null) requestAnimationFrame(page.drawCell);
  };
  const pin = (window) => {
    state.pinned = state.pinned === window ? null : window;
    page.drawCell();
  };

  // Steps by layer and sector, as on the page of a movie.
  page.stepWindow = (layers, sectors) => {
    if (!shown?.numbers.area) return;
    const count = page.data.sectors;
    const at = chosen() ?? 0;
    const layer = Math.min(Math.max(Math.floor(at / count) + layers, 0), page.data.layers - 1);
    state.pinned = layer * count + ((at % count) + sectors + count) % count;
    page.drawCell();
  };
  page.unpin = () => {
    const pinned = state.pinned !== null;
    state.pinned = null;
    page.drawCell();
    return pinned;
  };

  page.connectCell = () => {
    page.paletteNumbers = Uint32Array.from(page.data.palette, (colour) => {
      const [r, g, b] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
      return (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
    });
    Object.assign(byId("cell-disk"), { width: CANVAS, height: CANVAS });
    for (const [id, find] of [["cell-picture", overPicture], ["cell-disk", overDisk]]) {
      byId(id).addEventListener("pointermove", (event) => move(find(event)));
      byId(id).addEventListener("pointerleave", () => move(null));
      byId(id).addEventListener("click", (event) => pin(find(event)));
    }
    const change = (name, value) => {
      state[name] = value;
      page.drawCell();
    };
    byId("channel").addEventListener("change", ({ target }) => change("channel", Number(target.value)));
    for (const name of ["shows", "contrast"]) byId(name).addEventListener("change", ({ target }) => change(name, target.value));
    byId("grid").addEventListener("change", ({ target }) => change("grid", target.checked));
    for (const id of ["black", "white"]) byId(id).addEventListener("input", page.drawCell);
    byId("reset").addEventListener("click", () => {
      byId("black").value = 0;
      byId("white").value = 100;
      page.drawCell();
    });
    addEventListener("resize", page.drawCell);
  };
})();
