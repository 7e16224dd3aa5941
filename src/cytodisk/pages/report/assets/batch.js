"use strict";
// The lists of inputs and of cells; a click opens the page of a study, at the cell.
(() => {
  const page = window.cytodisk;
  const byId = (id) => document.getElementById(id);
  try {
    page.data = JSON.parse(byId("data").textContent);
    page.lists = {};
    for (const name of ["inputs", "cells"]) {
      const table = page.data[name];
      if (!table.rows.length) continue;
      const words = (row) => (name === "inputs" ? `page of ${row[0]}` : `cell ${row[1]} of ${row[0]}`);
      page.lists[name] = page.list({ root: byId(name), table, label: name, name: words, links: table.links });
    }
    page.ready = true;
  } catch (error) {
    byId("failed").hidden = false;
    throw error;
  }
})();
