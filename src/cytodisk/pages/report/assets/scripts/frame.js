"use strict";
// What surrounds a cell's picture: it fills its frame; scale bar, numbers of sectors, contrast.
(() => {
  const page = window.cytodisk;
  const { byId, svg } = page;
  const MARK = "#d55e00"; // of sector 0, as on the disk

  // The largest size that fits; returns CSS pixels a pixel of the picture.
  page.fitCell = (canvas, over, [height, width]) => {
    const { clientWidth, clientHeight } = canvas.closest(".cell-frame");
    const factor = Math.max(0.2, Math.min(clientWidth / width, clientHeight / height));
    const stack = canvas.parentElement;
    stack.style.width = `${width * factor}px`;
    stack.style.aspectRatio = `${width} / ${height}`;
    stack.style.setProperty("--ratio", width / height); // for print
    over.setAttribute("viewBox", `0 0 ${width} ${height}`);
    return factor;
  };

  // Scale bar and sectors, in pixels of the picture. pixel: size of one in unit.
  page.drawOver = (over, picture, { factor, layers, sectors, pixel, unit, numbered }) => {
    const [height, width] = picture.shape;
    const text = (x, y, words, more) => svg("text", { x, y, "font-size": 13 / factor, "text-anchor": "middle", "dominant-baseline": "central", ...more }, words);
    const places = numbered ? page.sectorPlaces(picture, layers, sectors) : [];
    const marks = places.flatMap(({ sector, x, y, dx, dy }) => {
      const [far, size] = [(sector ? 11 : 19) / factor, 5 / factor];
      const keep = (value, most) => Math.min(Math.max(value, 7 / factor), most - 7 / factor);
      const number = text(keep(x + far * dx, width), keep(y + far * dy, height), String(sector), { class: sector ? "sector" : "sector zero" });
      if (sector) return [number];
      const [tip, base] = [2 / factor, 11 / factor];
      const corner = (along, across) => `${x + along * dx - across * dy} ${y + along * dy + across * dx}`;
      return [svg("path", { d: `M${corner(tip, 0)}L${corner(base, size)}L${corner(base, -size)}Z`, fill: MARK, class: "zero" }), number];
    });
    const longest = 0.3 * width * pixel;
    const power = 10 ** Math.floor(Math.log10(longest));
    const length = Math.max(...[0.5, 1, 2, 5].map((step) => step * power).filter((one) => one <= longest * 1.000001));
    const [x, y, long] = [10 / factor, height - 10 / factor, length / pixel];
    const bar = { d: `M${x} ${y}h${long}`, class: "scale", "stroke-width": 4 / factor };
    over.classList.toggle("paper", !picture.grey);
    over.replaceChildren(
      ...marks, svg("path", { ...bar, class: "scale-under", "stroke-width": 7 / factor }), svg("path", bar),
      text(x + long / 2, y - 11 / factor, `${Number(length.toPrecision(1))} ${unit}`, { class: "sector scale-words" }),
    );
  };

  // The sliders' part of a range.
  page.stretched = ([low, high]) => {
    if (!byId("black")) return [low, high]; // of a movie without a signal
    const [black, white] = ["black", "white"].map((id) => byId(id).valueAsNumber / 100);
    return [low + black * (high - low), low + Math.max(white, black + 0.01) * (high - low)];
  };

  // draw(): after a change. auto(): shares [black, white] of the shown picture, or null.
  page.connectContrast = (draw, auto) => {
    if (!byId("black")) return;
    const set = ([black, white]) => {
      [byId("black").value, byId("white").value] = [Math.round(100 * black), Math.round(100 * white)];
      draw();
    };
    for (const id of ["black", "white"]) byId(id).addEventListener("input", draw);
    byId("auto").addEventListener("click", () => set(auto() ?? [0, 1]));
    byId("reset").addEventListener("click", () => set([0, 1]));
  };
})();
