"use strict";
// Axes, lines and points as SVG.
(() => {
  const page = window.cytodisk;
  const MARGIN = { left: 62, right: 12, top: 8, bottom: 42 };

  const { svg } = page;

  // Ends of an axis that holds some values with a margin.
  page.range = (values, margin = 0.06) => {
    const known = values.filter(page.known);
    if (!known.length) return [0, 1];
    const [low, high] = known.reduce(([least, most], value) => [Math.min(least, value), Math.max(most, value)], [Infinity, -Infinity]);
    const more = margin * (high - low || Math.abs(high) || 1);
    return [low - more, high + more];
  };

  // About so many round numbers in a range.
  page.ticks = ([low, high], count) => {
    const rough = (high - low) / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].find((one) => one * power >= rough) * power;
    const first = Math.ceil(low / step);
    return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, k) => Number(((first + k) * step).toPrecision(12)));
  };

  const tickWords = (value) => String(value).replace("-", "−");

  // Axes; names: [{ at, label }] in the place of numbers along x or y, along x also below; xLabel null: no axis of x.
  page.chart = ({ width, height, x, y, xLabel = "", yLabel = "", xNames = null, yNames = null, left = MARGIN.left, top = MARGIN.top, label, ticks = 5 }) => {
    const below = xNames?.some((one) => one.below) ? 8 : 0;
    const [right, bottom] = [width - MARGIN.right, height - (xLabel === null ? 6 : MARGIN.bottom + below)];
    const toX = (value) => left + ((value - x[0]) / (x[1] - x[0])) * (right - left);
    const toY = (value) => bottom - ((value - y[0]) / (y[1] - y[0])) * (bottom - top);
    const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": label, class: "chart" });
    const axes = svg("g", { class: "axes" });
    axes.append(svg("path", { d: `M${left} ${top}V${bottom}H${right}` }));
    const xs = xLabel === null ? [] : xNames ?? page.ticks(x, 5).map((at) => ({ at, label: tickWords(at) }));
    const ys = yNames ?? page.ticks(y, ticks).map((at) => ({ at, label: tickWords(at) }));
    for (const { at, label: words, below: more } of xs) {
      axes.append(svg("path", { d: `M${toX(at)} ${bottom}v4` }));
      axes.append(svg("text", { x: toX(at), y: bottom + (below ? 14 : 17), "text-anchor": "middle" }, words));
      if (more) axes.append(svg("text", { x: toX(at), y: bottom + 28, "text-anchor": "middle" }, more));
    }
    for (const { at, label: words } of ys) {
      axes.append(svg("path", { d: `M${left} ${toY(at)}h-4` }));
      axes.append(svg("text", { x: left - 7, y: toY(at) + 4, "text-anchor": "end" }, words));
    }
    axes.append(svg("text", { x: (left + right) / 2, y: height - 6, "text-anchor": "middle" }, xLabel ?? ""));
    const turned = `rotate(-90 13 ${(top + bottom) / 2})`;
    axes.append(svg("text", { x: 13, y: (top + bottom) / 2, "text-anchor": "middle", transform: turned }, yLabel));
    const marks = svg("g");
    root.append(axes, marks);
    return { root, marks, toX, toY, left, right, top, bottom, x, y };
  };

  page.linePath = ({ toX, toY }, xs, ys) => {
    let path = "";
    xs.forEach((x, k) => {
      const known = page.known(x) && page.known(ys[k]);
      if (known) path += `${path && page.known(ys[k - 1]) ? "L" : "M"}${toX(x).toFixed(1)} ${toY(ys[k]).toFixed(1)}`;
    });
    return path;
  };

  // A filled mark of an experiment, so that each differs also without colour.
  const MARKS = [
    (r) => `M${-r} 0a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`,
    (r) => `M${-r} ${-r}h${2 * r}v${2 * r}h${-2 * r}Z`,
    (r) => `M0 ${-1.2 * r}L${1.1 * r} ${0.8 * r}H${-1.1 * r}Z`,
    (r) => `M0 ${-1.3 * r}L${1.2 * r} 0L0 ${1.3 * r}L${-1.2 * r} 0Z`,
    (r) => `M0 ${1.2 * r}L${1.1 * r} ${-0.8 * r}H${-1.1 * r}Z`,
    (r) => `M${-0.4 * r} ${-1.2 * r}h${0.8 * r}v${0.8 * r}h${0.8 * r}v${0.8 * r}h${-0.8 * r}v${0.8 * r}h${-0.8 * r}v${-0.8 * r}h${-0.8 * r}v${-0.8 * r}h${0.8 * r}Z`,
    (r) => `M${1.2 * r} 0L${-0.8 * r} ${1.1 * r}V${-1.1 * r}Z`,
    (r) => `M${-1.2 * r} 0L${0.8 * r} ${1.1 * r}V${-1.1 * r}Z`,
  ];
  page.mark = (number, radius, x, y, attributes) =>
    svg("path", { d: MARKS[number % MARKS.length](radius), transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})`, ...attributes });
})();
