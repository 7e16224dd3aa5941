"use strict";
// One cell in large: pixels or windows, the disk beside it, the window under the pointer.
(() => {
  const page = window.cytodisk;
  const CANVAS = 640; // of the disk, in its own pixels
  const { byId, write } = page;
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

  // What `page.paint` takes of a cell, in a channel, or as its windows.
  page.pictureFor = ({ picture, decoded }, channel, asMeans) => ({
    shape: picture.shape, labels: decoded.labels, grey: asMeans ? null : decoded.channels[channel], ends: picture.limits?.[channel],
  });
  const innerOf = ({ plain }) => (plain ? Infinity : (page.data.cytoplasm_layers ?? Infinity) * page.data.sectors);
  page.innerOf = innerOf;

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
    const limits = page.stretched(asMeans ? ofMeans : page.pixelLimits(shown, channel, contrast));
    const [canvas, over] = [byId("cell-picture"), byId("cell-over")];
    const painted = page.pictureFor(shown, channel, asMeans);
    page.paint(canvas, painted, {
      values: means ?? [], limits, colours: page.packedPalette, grid: state.grid, chosen: picture.windows ? chosen() : null, inner: innerOf(picture),
    });
    page.drawBar(byId("cell-bar"), limits, palette, unit);
    const { layers, sectors, pixel_size_um: size } = page.data;
    const pixel = (picture.box[3] / picture.shape[1]) * (size ?? 1);
    const factor = page.fitCell(canvas, over, picture.shape);
    page.drawOver(over, painted, { factor, layers: picture.radii ? picture.radii.length - 1 : layers, sectors, pixel, unit: size === null ? "px" : "µm", numbered: picture.windows });
    const name = channels[channel]?.name;
    write("cell-shows", !name ? "windows; no signal" : asMeans ? `mean ${name} by window` : name);
    byId("auto").disabled = asMeans;
    const mapped = Boolean(numbers.area);
    byId("disk-side").hidden = !mapped;
    if (mapped) {
      const diskLimits = page.stretched(ofMeans);
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

  const overPicture = (event) => (shown.picture.windows ? page.windowOnCell(byId("cell-picture"), shown.decoded.labels, event) : null);
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

  // Shares of the range that the sliders stretch, from those of the cell's own.
  const contrastOf = (painted) => {
    const [low, high] = page.pixelLimits(shown, state.channel, state.contrast);
    const [first, last] = painted.ends;
    return page.autoContrast(painted).map((share) => (first + share * (last - first) - low) / (high - low));
  };

  page.connectCell = () => {
    page.packedPalette = page.packed(page.data.palette);
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
    page.connectContrast(page.drawCell, () => {
      const painted = shown && page.pictureFor(shown, state.channel, !shown.picture.channels);
      return painted?.grey ? contrastOf(painted) : null;
    });
    addEventListener("resize", page.drawCell);
  };
})();
