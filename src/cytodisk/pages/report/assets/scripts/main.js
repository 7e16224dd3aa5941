"use strict";
// Cells of a movie's study: opened one after the other, each from a text of its own on the page.
(() => {
  const page = window.cytodisk;
  const { byId, write } = page;
  const shownCells = () => page.study.cells.filter(({ shown }) => shown).map(({ cell }) => cell);
  page.isSeveral = () => shownCells().length > 1;

  const fillControls = () => {
    const { data } = page;
    page.fill("channel", data.channels.map(({ name }, k) => [k, name]));
    page.fill("layer", data.layer_places.map((place, k) => [k, `${k}${place}${data.layer_depths[k]}`]));
    page.fill("pair", data.pairs.map(({ label }, k) => [k, label]));
    const pixels = data.has_pixels ? [["pixels", "pixels"]] : [];
    const signal = data.channels.some(({ mean }) => mean);
    const windows = signal ? [["means", "window means"], ["velocity", "edge velocity"]] : [["velocity", "edge velocity"], ["means", "window areas"]];
    page.fill("shows", [...pixels, ...windows, ...(data.pairs.length ? [["correlation", "peak correlation"], ["lag", "lag of the peak"]] : [])]);
    byId("time").max = data.frames.length - 1;
    write("cell-title", `Cell ${data.cell}`);
    write("reduced", data.reduced);
    byId("finding").replaceChildren(...data.finding.map((words) => page.make("p", {}, words)));
    const place = shownCells().indexOf(data.cell);
    write("cell-place", page.isSeveral() ? `${place + 1} of ${shownCells().length}` : "");
    for (const row of document.querySelectorAll("tr[data-row]")) {
      row.setAttribute("aria-current", String(Number(row.dataset.row) === data.cell));
    }
  };

  // Shows a cell of the study; one that is not on the page is passed over. Of several calls the last one counts.
  let wanted = null;
  page.openCell = async (cell) => {
    if (!shownCells().includes(cell) || wanted === cell) return;
    wanted = cell;
    page.play(false);
    const raw = page.read(`cell-${cell}`);
    const { pictures, ...rest } = raw;
    const data = await page.unpack(rest);
    if (wanted !== cell) return;
    page.forgetFrames();
    const before = page.data?.channels[page.state.channel]?.name;
    Object.assign(page, { pictures, data });
    const channel = data.channels.findIndex(({ name }) => name === before);
    const pair = Math.min(page.state.pair, Math.max(data.pairs.length - 1, 0));
    fillControls();
    page.set({ cell, index: data.first, channel: Math.max(channel, 0), pair, hover: null, pinned: null, shows: byId("shows").value });
    await page.frameAt(page.state.index);
  };

  page.stepCell = async (by) => {
    const cells = shownCells();
    const cell = cells[(cells.indexOf(wanted) + by + cells.length) % cells.length];
    await page.openCell(cell);
    history.replaceState(null, "", `#cell-${wanted}`);
  };

  // "#cell-3&channel=Rac1" opens a cell on a channel.
  const openAddress = async () => {
    const { cell, channel } = page.address();
    if (cell !== null) await page.openCell(cell);
    const number = page.data.channels.findIndex(({ name, full }) => channel !== null && [name, full].includes(channel));
    if (number >= 0) page.set({ channel: number });
  };

  void page.start(async () => {
    page.study = page.read("study");
    page.connectViews();
    page.connect();
    await page.openCell(page.study.first);
    const signal = page.data.pairs[0]?.channel ?? 0; // what was correlated is shown first
    page.set({ channel: signal });
    await openAddress();
    byId("previous-cell")?.addEventListener("click", () => void page.stepCell(-1));
    byId("next-cell")?.addEventListener("click", () => void page.stepCell(1));
    addEventListener("hashchange", () => void openAddress());
  });
})();
