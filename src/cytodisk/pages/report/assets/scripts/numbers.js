"use strict";
// Numbers in words, with a true minus; a dash for none. Rows of arrays.
(() => {
  const page = window.cytodisk;

  page.known = (value) => typeof value === "number" && Number.isFinite(value);
  page.words = (value, text) => (page.known(value) ? String(text(value)).replaceAll("-", "−") : "–");
  page.digits = (value) =>
    page.words(value, () => {
      const size = Math.abs(value);
      if (size === 0) return 0;
      if (size >= 1e5 || size < 1e-3) return value.toExponential(1);
      return size >= 1000 ? value.toFixed(0) : value.toPrecision(3);
    });
  page.withUnit = (value, unit) => (page.known(value) && unit ? `${page.digits(value)} ${unit}` : page.digits(value));
  page.fixed = (value) => page.words(value, () => value.toFixed(2).replace(/^-(0\.00)$/, "$1"));
  page.largest = (values) => values.reduce((top, value) => Math.max(top, Math.abs(value) || 0), 0);

  // A row of an array, as a view into it.
  page.row = ({ values, shape }, number) => {
    const length = shape.slice(1).reduce((product, size) => product * size, 1);
    return values.subarray(number * length, (number + 1) * length);
  };

  page.chance = (value) => page.words(value, () => Number(value.toPrecision(2)));
})();
