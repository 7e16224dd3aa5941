"use strict";
// Conditions and their difference on the disk and on a cell; the window under the pointer with its numbers.
(() => {
  const page = window.cytodisk;
  const SIZE = 560; // of a canvas, in its own pixels
  const { byId } = page;
  const state = { comparison: 0, channel: 0, shows: "difference", window: null, pinned: null };
  page.atlasState = state;

  // A row of an array by (…, window), as numbers.
  const part = ({ values, shape }, ...place) => {
    const length = shape.at(-1);
    const number = place.reduce((all, one, k) => all * shape[k] + one, 0);
    return Array.from(values.subarray(number * length, (number + 1) * length));
  };
  page.part = part;

  const comparison = () => page.data.comparisons[state.comparison];
  const ofAtlas = (name, condition) => part(page.data.atlas[name], page.data.conditions.indexOf(condition), state.channel);
  const ofWindows = (name) => part(comparison().windows[name], state.channel);
  page.ofAtlas = ofAtlas;
  page.ofWindows = ofWindows;
  page.comparison = comparison;

  const shownConditions = () => {
    const { conditions, control } = page.data;
    return comparison() ? [control, comparison().condition] : conditions.slice(0, 2);
  };
  page.shownConditions = shownConditions;

  const ends = (values, both) => {
    const known = values.filter(Number.isFinite).sort((a, b) => a - b);
    if (!known.length) return both ? [-1, 1] : [0, 1];
    const at = (share) => known[Math.round(share * (known.length - 1))];
    const top = Math.max(Math.abs(at(0.01)), Math.abs(at(0.99))) || 1;
    if (both) return [-top, top];
    const [low, high] = [at(0.01), at(0.99)];
    return high > low ? [low, high] : [low - 0.5, low + 0.5];
  };

  // What each of the panels shows: two conditions in the same colours, and what differs.
  const panels = () => {
    const names = shownConditions();
    const means = names.map((name) => ofAtlas("mean", name));
    const { palettes, unit, level, signed } = page.data;
    const limits = ends(means.flat(), signed);
    const found = names.map((name, k) => ({ title: name, values: means[k], limits, palette: palettes.signal, unit, marks: [], pale: null }));
    if (!comparison()) return found;
    const values = ofWindows(state.shows);
    const p = ofWindows("p_holm");
    const tested = p.some(Number.isFinite);
    const marks = [...p.keys()].filter((k) => p[k] <= level);
    const pale = tested ? [...p.keys()].filter((k) => !(p[k] <= level) && Number.isFinite(values[k])) : null;
    const title = { difference: "difference", effect_size: "effect size g" }[state.shows];
    const own = { title: `${title}: ${names[1]} − ${names[0]}`, values, limits: ends(values, true), palette: palettes.difference };
    return [...found, { ...own, unit: state.shows === "difference" ? unit : "g", marks, pale }];
  };

  const grid = () => page.data.disk;
  const chosen = () => state.pinned ?? state.window;

  // The same on the representative cell, pixel by pixel.
  const paintCell = (canvas, panel) => {
    const inner = (grid().cytoplasm_layers ?? Infinity) * grid().sectors; // first window of the nucleus
    page.paint(canvas, page.cell, { ...panel, colours: page.packed(panel.palette), grid: false, pale: panel.pale ?? [], chosen: chosen(), inner });
  };

  const layerWords = (window) => {
    const { sectors, layer_places: places } = grid();
    const layer = Math.floor(window / sectors);
    return `layer ${layer}${places[layer]}, sector ${window % sectors}`;
  };

  const clusterWords = (number) => {
    const { columns, rows } = page.data.tables.clusters ?? { columns: [], rows: [] };
    const place = (name) => columns.findIndex((column) => column.name === name);
    const keys = { condition: comparison().condition, channel: page.data.channels[state.channel].name, cluster: number };
    const row = rows.find((one) => Object.entries(keys).every(([name, value]) => one[place(name)] === value));
    return row ? `${number}, p corrected ${page.chance(row[place("p_holm")])}` : String(number);
  };

  // The window's numbers as rows of two texts.
  const numbersAt = (k) => {
    const { unit, conditions } = page.data;
    const rows = [["window", layerWords(k)]];
    for (const name of conditions) {
      const [mean, sem, cells, experiments] = ["mean", "sem", "n_cells", "n_experiments"].map((one) => ofAtlas(one, name)[k]);
      const spread = Number.isFinite(sem) ? ` ± ${page.digits(sem)}` : "";
      const among = experiments ? `, ${experiments} experiment${experiments === 1 ? "" : "s"}` : "";
      rows.push([name, `${page.digits(mean)}${spread} ${unit} (${cells} cell${cells === 1 ? "" : "s"}${among})`]);
    }
    if (!comparison()) return rows;
    const at = (name) => ofWindows(name)[k];
    const between = (low, high) => (Number.isFinite(at(low)) ? ` (${page.digits(at(low))} to ${page.digits(at(high))})` : "");
    rows.push(["difference", `${page.digits(at("difference"))}${between("difference_low", "difference_high")} ${unit}`]);
    rows.push(["effect size g", `${page.digits(at("effect_size"))}${between("low", "high")}`]);
    if (Number.isFinite(at("p"))) {
      rows.push(["p of this window alone", page.chance(at("p"))]);
      rows.push(["p corrected (max-T)", page.chance(at("p_fwer"))]);
      const count = page.data.comparisons.length;
      if (count > 1) rows.push([`p corrected for ${count} comparisons too (Holm)`, page.chance(at("p_holm"))]);
      rows[rows.length - 1][1] += at("p_holm") <= page.data.level ? ", significant" : "";
      rows.push(["q (false discovery rate)", page.chance(at("q"))]);
    } else rows.push(["not tested", comparison().status[state.channel][k]]);
    if (at("cluster") > 0) rows.push(["cluster", clusterWords(at("cluster"))]);
    return rows;
  };

  const readOut = () => {
    const k = chosen();
    const rows = k === null ? [] : numbersAt(k);
    byId("read").replaceChildren(...rows.flatMap(([term, words]) => [page.make("dt", {}, term), page.make("dd", {}, words)]));
    byId("read-hint").textContent = rows.length
      ? state.pinned === null ? "" : "pinned: Esc lets go"
      : "Point at a window, on a disk or in the cell, to see its numbers; click to pin it.";
  };

  page.drawAtlas = () => {
    if (!grid()) return;
    const found = panels();
    const lines = { ...grid(), radii: grid().radii };
    found.forEach((panel, k) => {
      byId(`panel-${k}`).hidden = false;
      byId(`title-${k}`).textContent = panel.title;
      page.drawDisk(byId(`disk-${k}`), lines, panel.values, { ...panel, chosen: chosen(), nucleus: grid().cytoplasm_layers });
      if (page.cell) paintCell(byId(`cell-${k}`), panel);
      page.drawBar(byId(`bar-${k}`), panel.limits, panel.palette, panel.unit);
    });
    for (let k = found.length; k < 3; k++) byId(`panel-${k}`).hidden = true;
    byId("value").textContent = page.data.channels[state.channel].value;
    readOut();
    page.drawn = JSON.stringify(state);
  };

  const step = (layers, sectors) => {
    const count = grid().sectors;
    const at = chosen() ?? 0;
    const layer = Math.min(Math.max(Math.floor(at / count) + layers, 0), page.data.layers - 1);
    state.pinned = layer * count + (((at % count) + sectors + count) % count);
    page.drawAtlas();
  };
  const KEYS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], "[": [0, -1], "]": [0, 1], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

  page.connectAtlas = () => {
    const move = (window) => {
      if (state.window === window) return;
      state.window = window;
      if (state.pinned === null) requestAnimationFrame(page.drawAtlas);
    };
    const listen = (canvas, find) => {
      canvas.addEventListener("pointermove", (event) => move(find(event)));
      canvas.addEventListener("pointerleave", () => move(null));
      canvas.addEventListener("click", (event) => {
        const window = find(event);
        state.pinned = state.pinned === window ? null : window;
        page.drawAtlas();
      });
    };
    for (let k = 0; k < 3; k++) {
      const disk = byId(`disk-${k}`);
      Object.assign(disk, { width: SIZE, height: SIZE });
      listen(disk, (event) => page.windowOnDisk(disk, grid(), event));
      const cell = byId(`cell-${k}`);
      cell.hidden = !page.cell;
      if (page.cell) listen(cell, (event) => page.windowOnCell(cell, page.cell.labels, event));
    }
    byId("maps").addEventListener("keydown", (event) => {
      if (!(event.key in KEYS) || page.isChord(event)) return;
      event.preventDefault();
      step(...KEYS[event.key]);
    });
    document.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      state.pinned = null;
      page.drawAtlas();
    });
  };
})();
