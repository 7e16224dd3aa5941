"use strict";
// Puts the page of a population together.
(() => {
  const page = window.cytodisk;
  const { byId } = page;

  // Address of a cell on the page of its study, on the channel of a scalar, or the chosen one.
  page.cellAddress = (link, scalar = "") => {
    const { channels } = page.data;
    const channel = channels.find(({ name }) => scalar.endsWith(`_${name}`)) ?? channels[page.atlasState.channel];
    return channel && link.includes("#") ? `${link}&channel=${encodeURIComponent(channel.name)}` : link;
  };

  page.labelOf = (scalar) => scalar.replaceAll("_", " ");
  const drawAll = () => {
    byId("compared").textContent = page.comparison()?.words ?? "no comparison";
    page.drawAtlas();
    if (page.data.curves && page.data.lags) page.drawCurves();
    if (byId("profiles")) page.drawProfiles();
    if (byId("superplot")) page.drawScalar();
    if (byId("forest")) page.drawForest();
  };

  page.showScalar = (name) => {
    const number = page.data.scalars.findIndex((scalar) => scalar.name === name);
    if (number < 0) return;
    page.chartState.scalar = number;
    byId("scalar").value = String(number);
    page.drawScalar();
  };

  const key = () =>
    byId("conditions").replaceChildren(
      ...page.data.conditions.map((name) => {
        const patch = page.make("i");
        patch.style.background = page.data.colours[name];
        return page.make("li", {}, patch, name);
      }),
    );

  const lists = () => {
    page.lists = {};
    for (const [name, table] of Object.entries(page.data.tables)) {
      const root = byId(`table-${name}`);
      if (!root || !table.rows.length) continue;
      const at = table.columns.findIndex((column) => column.name === "scalar");
      const open = name === "scalars" ? (k) => {
        page.showScalar(table.rows[k][at]);
        byId("superplot").scrollIntoView({ block: "center" });
      } : null;
      page.lists[name] = page.list({ root, table, label: name.replaceAll("_", " "), open, name: (row) => row[0], links: table.links, address: page.cellAddress });
    }
  };

  const connect = () => {
    const change = (id, act) => byId(id)?.addEventListener("change", ({ target }) => {
      act(target.value);
      drawAll();
    });
    change("comparison", (value) => (page.atlasState.comparison = Number(value)));
    change("atlas-channel", (value) => (page.atlasState.channel = Number(value)));
    change("atlas-shows", (value) => (page.atlasState.shows = value));
    change("layer", () => {});
    change("scalar", (value) => (page.chartState.scalar = Number(value)));
    if (page.data.disk) page.connectAtlas();
  };

  void page.start(async () => {
    const raw = page.read("data");
    const labels = raw.disk?.cell?.labels;
    page.data = await page.unpack(raw);
    for (const scalar of page.data.scalars) scalar.label = page.labelOf(scalar.name);
    if (labels) page.cell = { ...page.data.disk.cell, labels: (await page.decode({ labels, channels: null }, raw.disk.cell.shape)).labels };
    key();
    connect();
    drawAll();
    lists();
  });
})();
