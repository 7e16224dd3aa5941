"use strict";
// The lists of inputs and of cells; a click opens the page of a study, at the cell.
(() => {
  const page = window.cytodisk;
  void page.start(() => {
    page.data = page.read("data");
    page.lists = {};
    for (const name of ["inputs", "cells"]) {
      const table = page.data[name];
      if (!table.rows.length) continue;
      const words = (row) => (name === "inputs" ? `page of ${row[0]}` : `cell ${row[1]} of ${row[0]}`);
      page.lists[name] = page.list({ root: page.byId(name), table, label: name, name: words, links: table.links });
    }
  });
})();
