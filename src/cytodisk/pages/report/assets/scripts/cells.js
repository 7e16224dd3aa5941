"use strict";
// The list of cells, and the window that opens on one of them.
(() => {
  const page = window.cytodisk;
  const { byId } = page;

  const THUMBNAIL = 150; // px
  let list;
  const { make } = page;
  const cellOf = (row) => row[0];
  const valueOf = (row, name) => row[page.data.table.columns.findIndex((column) => column.name === name)];
  const nameOf = (row) => page.data.names[cellOf(row)];

  // Ends of pixels' colours that suit most cells.
  const commonLimits = () => {
    const found = page.pictures.filter((one) => one?.limits).map(({ limits }) => limits);
    const share = (values, part) => values.sort((a, b) => a - b)[Math.round(part * (values.length - 1))];
    return (found[0] ?? []).map((_, k) => {
      const [low, high] = [share(found.map((one) => one[k][0]), 0.05), share(found.map((one) => one[k][1]), 0.95)];
      return high > low ? [low, high] : found[0][k];
    });
  };

  const thumbnail = (cell) => {
    const canvas = make("canvas", { "aria-hidden": "true" });
    void page.pictureOf(cell).then((found) => {
      if (!found) return canvas.replaceWith(make("span", { class: "nothing" }, "no picture"));
      const { picture } = found;
      const channel = page.cellState.channel;
      const limits = picture.channels ? page.pixelLimits(found, channel, page.cellState.contrast) : [0, 1];
      const look = { limits, colours: page.packedPalette, grid: false, inner: page.innerOf(picture) };
      page.paint(canvas, page.pictureFor(found, channel, !picture.channels), look);
      const factor = THUMBNAIL / Math.max(...picture.shape);
      canvas.style.width = `${picture.shape[1] * factor}px`;
      canvas.style.height = `${picture.shape[0] * factor}px`;
    });
    return canvas;
  };

  const card = (k, sorted) => {
    const { columns, rows } = page.data.table;
    const row = rows[k];
    const groups = page.data.group_columns.map((name) => valueOf(row, name)).filter(Boolean).join(" · ");
    const column = columns.find(({ name }) => name === sorted);
    const status = valueOf(row, "status");
    const flags = valueOf(row, "qc_flags");
    const parts = [make("span", { class: "thumb" }, thumbnail(cellOf(row))), make("strong", {}, nameOf(row))];
    if (groups) parts.push(make("span", { class: "quiet" }, groups));
    if (column && column.name !== "cell") {
      const unit = column.unit ? ` ${column.unit}` : "";
      parts.push(make("span", {}, `${column.label} ${page.shownValue(column, row[columns.indexOf(column)]) || "–"}${unit}`));
    }
    if (status !== "ok") parts.push(make("span", { class: "badge" }, status));
    if (flags) parts.push(make("span", { class: "badge", title: flags }, flags));
    return parts;
  };

  const choices = () => {
    const { rows, columns } = page.data.table;
    const every = (words) => ({ label: words, test: null });
    const split = (name) => rows.flatMap((row) => String(valueOf(row, name) ?? "").split("; ")).filter(Boolean);
    const counted = (values) => Object.entries(values.reduce((all, one) => ({ ...all, [one]: (all[one] ?? 0) + 1 }), {}));
    const found = page.data.group_columns.slice(0, 1).map((column) => ({
      label: "cells of which condition",
      options: [
        every("all conditions"),
        ...counted(rows.map((row) => valueOf(row, column) ?? "none")).map(([value, count]) => ({
          label: `${value} (${count})`, test: (row) => String(valueOf(row, column) ?? "none") === value,
        })),
      ],
    }));
    const has = (name) => columns.some((column) => column.name === name);
    const states = [
      ...counted(split("status")).map(([value, count]) => ({
        name: value, label: `${value === "ok" ? "mapped" : value} (${count})`, test: (row) => valueOf(row, "status") === value,
      })),
      ...(has("qc_flags") ? counted(split("qc_flags")) : []).map(([value, count]) => ({
        name: value, label: `QC flag: ${value} (${count})`,
        test: (row) => String(valueOf(row, "qc_flags") ?? "").split("; ").includes(value),
      })),
      ...(has("qc_flags") ? [{ label: "without QC flags", test: (row) => !valueOf(row, "qc_flags") }] : []),
    ];
    return [...found, { label: "cells of which status or QC flag", options: [every("all cells"), ...states] }];
  };

  // The cell that is open, as a row of the list as it is sorted and filtered.
  const dialog = byId("cell");
  const describe = (k) => {
    const { columns, rows } = page.data.table;
    const row = rows[k];
    const groups = page.data.group_columns.map((name) => valueOf(row, name)).filter(Boolean).join(" · ");
    byId("cell-name").textContent = nameOf(row);
    byId("cell-groups").textContent = [groups, `cell ${cellOf(row)}`].filter(Boolean).join(" · ");
    const place = list.find().indexOf(k);
    byId("cell-place").textContent = place < 0 ? "" : `${place + 1} of ${list.find().length}`;
    byId("previous").disabled = byId("next").disabled = list.find().length < 2;
    const [status, flags, reason] = ["status", "qc_flags", "reason"].map((name) => valueOf(row, name));
    const badges = [status === "ok" ? "mapped" : `${status}: ${reason ?? ""}`, ...(flags ? flags.split("; ") : [])];
    byId("cell-badges").replaceChildren(
      ...badges.map((words, at) => make("li", { class: at || status !== "ok" ? "badge" : "badge good" }, words)),
    );
    const told = columns.filter(({ name }) => !["cell", "status", "qc_flags", "reason"].includes(name));
    const facts = told.map((column) => [column, page.shownValue(column, row[columns.indexOf(column)])]);
    byId("cell-facts").replaceChildren(
      ...facts.filter(([, words]) => words !== "").map(([column, words]) =>
        make("tr", { title: column.title }, make("th", { scope: "row" }, column.label), make("td", {}, column.unit ? `${words} ${column.unit}` : words)),
      ),
    );
  };

  let opened = null;
  const open = (k) => {
    opened = k;
    if (!dialog.open) dialog.showModal();
    describe(k);
    const cell = cellOf(page.data.table.rows[k]);
    const channel = page.address().channel;
    history.replaceState(null, "", `#cell-${cell}${channel === null ? "" : `&channel=${encodeURIComponent(channel)}`}`);
    return page.showCell(cell);
  };
  page.open = (cell) => open(page.data.table.rows.findIndex((row) => cellOf(row) === cell));
  const step = (by) => {
    const found = list.find();
    const place = found.indexOf(opened);
    if (found.length) void open(found[(place + by + found.length) % found.length]);
  };

  const KEYS = {
    ArrowLeft: () => step(-1),
    ArrowRight: () => step(1),
    ArrowUp: () => page.stepWindow(-1, 0),
    ArrowDown: () => page.stepWindow(1, 0),
    "[": () => page.stepWindow(0, -1),
    "]": () => page.stepWindow(0, 1),
  };
  const onKey = (event) => {
    if (!(event.key in KEYS) || page.isChord(event)) return;
    if (["SELECT", "INPUT"].includes(event.target.tagName) && event.target.type !== "checkbox") return;
    event.preventDefault();
    KEYS[event.key]();
  };

  // "#cell-3&channel=Rac1" opens a cell on a channel.
  const openAddress = () => {
    const { cell, channel } = page.address();
    const number = page.data.channels.findIndex(({ name, full }) => channel !== null && [name, full].includes(channel));
    if (number >= 0) {
      page.cellState.channel = number;
      byId("channel").value = String(number);
    }
    if (page.data.table.rows.some((row) => cellOf(row) === cell)) void page.open(cell);
  };

  const connect = () => {
    dialog.addEventListener("keydown", onKey);
    dialog.addEventListener("cancel", (event) => {
      if (page.unpin()) event.preventDefault(); // Esc lets a window go first
    });
    dialog.addEventListener("close", () => history.replaceState(null, "", location.pathname + location.search));
    byId("close").addEventListener("click", () => dialog.close());
    byId("previous").addEventListener("click", () => step(-1));
    byId("next").addEventListener("click", () => step(1));
    for (const button of document.querySelectorAll("button[data-cell]")) {
      button.addEventListener("click", () => void page.open(Number(button.dataset.cell)));
    }
    for (const button of document.querySelectorAll("button[data-shows]")) {
      button.addEventListener("click", () => {
        const all = choices();
        const option = all.at(-1).options.findIndex(({ name }) => name === button.dataset.shows);
        if (option > 0) list.choose(all.length - 1, option);
        byId("cells").scrollIntoView({ block: "start" });
      });
    }
    addEventListener("hashchange", openAddress);
  };

  void page.start(() => {
    page.pictures = page.read("pictures");
    page.data = page.read("data");
    page.data.pixel_limits = commonLimits();
    page.connectCell();
    const { table } = page.data;
    const some = page.pictures.some(Boolean);
    list = page.list({ root: byId("cells"), table, label: "cells", open, name: nameOf, card: some ? card : null, choices: choices() });
    page.cells = list;
    connect();
    openAddress();
  });
})();
