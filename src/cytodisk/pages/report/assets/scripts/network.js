"use strict";
// Who predicts whom: signals on a circle, arrows between them.
(() => {
  const page = window.cytodisk;
  const { svg } = page;
  const [BLUE, PALE] = ["#0072b2", "#c8c8c8"];
  const [WIDE, NEAR, APART] = [7, 24, 5]; // of arrows: widest, from a signal's middle, two of one pair

  page.notCounted = "not counted: geometry, or noise of measurement, may make it";

  // A picture of the links; each is clicked to see its pair. Wide arrows: large gain; grey: q is 0.05 or more, or not counted.
  page.network = ({ signals, names, links }, { width, height, chosen, choose }) => {
    const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", class: "chart", "aria-label": "network of the signals: who predicts whom" });
    const middle = [width / 2, height / 2];
    const radius = Math.min(width / 2 - 62, height / 2 - 34);
    const places = signals.map((_, k) => {
      const angle = (2 * Math.PI * k) / signals.length - Math.PI / 2;
      return [middle[0] + radius * Math.cos(angle), middle[1] + radius * Math.sin(angle)];
    });
    const largest = Math.max(...links.map(({ best_gain: gain }) => gain || 0), 1e-12);
    const ordered = links.map((link, k) => ({ ...link, k })).sort((a, b) => (b.best_q ?? 1) - (a.best_q ?? 1));
    for (const { source, target, best_q: q, best_gain: gain, doubtful, k } of ordered) {
      const [from, to] = [places[signals.indexOf(source)], places[signals.indexOf(target)]];
      const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
      const length = Math.hypot(dx, dy);
      const [ux, uy] = [dx / length, dy / length];
      const found = page.known(q) && q < 0.05 && !doubtful;
      const line = found ? 1.5 + (WIDE - 1.5) * Math.sqrt(Math.max(gain, 0) / largest) : 1.2;
      const head = 6 + line;
      const at = (along, aside) => `${(from[0] + ux * along - uy * (APART + aside)).toFixed(1)} ${(from[1] + uy * along + ux * (APART + aside)).toFixed(1)}`;
      const end = length - NEAR;
      const colour = found ? BLUE : PALE;
      const arrow = svg("g", { class: "link", tabindex: 0, role: "button", "aria-label": `${names[source]} and ${names[target]}` });
      arrow.append(
        svg("path", { d: `M${at(NEAR, 0)}L${at(end, 0)}`, stroke: "transparent", "stroke-width": 14 }),
        svg("path", { d: `M${at(NEAR, 0)}L${at(end - head, 0)}`, stroke: colour, "stroke-width": line, "stroke-dasharray": found ? null : "4 3" }),
        svg("path", { d: `M${at(end - head, head / 2)}L${at(end, 0)}L${at(end - head, -head / 2)}Z`, fill: colour }),
        svg("title", {}, `${names[source]} → ${names[target]}: gain beyond chance ${page.digits(gain)}, q ${page.chance(q)}${doubtful ? `; ${page.notCounted}` : ""}`),
      );
      if (chosen(links[k])) arrow.setAttribute("class", "link chosen");
      arrow.addEventListener("click", () => choose(links[k]));
      arrow.addEventListener("keydown", ({ key }) => key === "Enter" && choose(links[k]));
      root.append(arrow);
    }
    signals.forEach((signal, k) => {
      root.append(svg("circle", { cx: places[k][0], cy: places[k][1], r: 7, fill: "#333" }));
      const [x, y] = places[k];
      const below = y > middle[1] + 1 || (signals.length === 2 && k === 1);
      root.append(svg("text", { x, y: y + (below ? 24 : -14), "text-anchor": "middle", class: "signal-name" }, names[signal]));
    });
    return root;
  };
})();
