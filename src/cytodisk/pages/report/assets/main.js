"use strict";
(async () => {
  const page = window.cytodisk;
  const read = (id) => JSON.parse(document.getElementById(id).textContent);
  try {
    page.pictures = read("pictures");
    page.data = await page.unpack(read("data"));
    await page.embed(read("figures"));
    page.connect();
    page.set({ index: page.data.first });
    await page.frameAt(page.data.first);
    page.ready = true;
    page.readyMilliseconds = performance.now();
  } catch (error) {
    document.getElementById("failed").hidden = false;
    throw error;
  }
})();
