"use strict";
// Windows on the disk, drawn on a canvas; v goes down as y does in images.
(() => {
  const page = window.cytodisk;
  const MISSING = "#d9d9d9";
  const FULL = 2 * Math.PI;
  const MOST_LINES = 1500; // windows whose borders are drawn
  const REACH = 1.16; // half a side of the canvas, in radii

  const shareOf = (value, [low, high]) => Math.min(Math.max((value - low) / (high - low), 0), 1);
  page.colourOf = (value, limits, palette) =>
    Number.isFinite(value) ? palette[Math.round(shareOf(value, limits) * (palette.length - 1))] : MISSING;

  const wedge = (context, { radii, sectors }, window) => {
    const [layer, sector] = [Math.floor(window / sectors), window % sectors];
    const [start, end] = [(FULL * sector) / sectors, (FULL * (sector + 1)) / sectors];
    context.beginPath();
    context.arc(0, 0, radii[layer], start, end);
    context.arc(0, 0, radii[layer + 1] ?? 0, end, start, true);
    context.closePath();
  };

  // Draws values by window; marks: windows with a bold border, chosen: one with a white and black border,
  // pale: windows that are hatched.
  page.drawDisk = (canvas, grid, values, { limits, palette, chosen = null, marks = [], pale = null, nucleus = null }) => {
    const size = canvas.width;
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, size, size);
    const unit = size / (2 * REACH);
    context.setTransform(unit, 0, 0, unit, size / 2, size / 2);
    const lined = values.length <= MOST_LINES;
    const seam = 0.9 / unit; // covers the gap between neighbours
    values.forEach((value, window) => {
      wedge(context, grid, window);
      context.fillStyle = page.colourOf(value, limits, palette);
      context.fill();
      context.strokeStyle = lined ? "rgba(255, 255, 255, 0.3)" : context.fillStyle;
      context.lineWidth = seam;
      context.stroke();
    });
    if (pale) hatch(context, grid, pale, unit);
    context.lineWidth = 1.5 / unit;
    context.strokeStyle = "#777777";
    circle(context, 1);
    if (nucleus !== null) {
      context.lineWidth = 2 / unit;
      context.strokeStyle = "#56b4e9";
      circle(context, grid.radii[nucleus]);
    }
    context.lineWidth = 1.6 / unit;
    context.strokeStyle = "#000000";
    if (marks.length) border(context, grid, new Set(marks));
    if (chosen !== null) {
      for (const [colour, width] of [["#000000", 6], ["#ffffff", 2.5]]) {
        wedge(context, grid, chosen);
        context.strokeStyle = colour;
        context.lineWidth = width / unit;
        context.stroke();
      }
    }
    markZero(context, grid.sectors);
    numberSectors(context, grid.sectors, unit);
  };

  // A wedge beside sector 0 that points at it, as in the cell.
  const markZero = (context, sectors) => {
    context.save();
    context.rotate((0.5 * FULL) / sectors);
    context.beginPath();
    context.moveTo(1.01, 0);
    context.lineTo(1.065, 0.03);
    context.lineTo(1.065, -0.03);
    context.fillStyle = "#d55e00";
    context.fill();
    context.restore();
  };

  page.numberedSectors = (sectors) => [...new Set([0, 1, 2, 3].map((k) => Math.round((k * sectors) / 4) % sectors))];

  const circle = (context, radius) => {
    context.beginPath();
    context.arc(0, 0, radius, 0, FULL);
    context.stroke();
  };

  const numberSectors = (context, sectors, unit) => {
    const scale = Math.max(unit, 1);
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.save();
    context.scale(1 / scale, 1 / scale);
    for (const sector of page.numberedSectors(sectors)) {
      const angle = (FULL * (sector + 0.5)) / sectors;
      context.fillStyle = sector ? "#555555" : "#a04000";
      context.font = `${sector ? "" : "bold "}${Math.round(0.08 * scale)}px system-ui, sans-serif`;
      const far = (sector ? 1.08 : 1.115) * scale;
      context.fillText(String(sector), far * Math.cos(angle), far * Math.sin(angle));
    }
    context.restore();
  };

  // Lines around a set of windows: sides between one that is in it and one that is not.
  const border = (context, { radii, sectors }, inside) => {
    context.beginPath();
    for (const window of inside) {
      const [layer, sector] = [Math.floor(window / sectors), window % sectors];
      const [start, end] = [(FULL * sector) / sectors, (FULL * (sector + 1)) / sectors];
      const [outer, inner] = [radii[layer], radii[layer + 1] ?? 0];
      const arc = (radius) => {
        context.moveTo(radius * Math.cos(start), radius * Math.sin(start));
        context.arc(0, 0, radius, start, end);
      };
      const side = (angle) => {
        context.moveTo(inner * Math.cos(angle), inner * Math.sin(angle));
        context.lineTo(outer * Math.cos(angle), outer * Math.sin(angle));
      };
      if (!inside.has(window - sectors)) arc(outer);
      if (!inside.has(window + sectors) && inner > 0) arc(inner);
      if (!inside.has(layer * sectors + ((sector + sectors - 1) % sectors))) side(start);
      if (!inside.has(layer * sectors + ((sector + 1) % sectors))) side(end);
    }
    context.stroke();
  };

  const hatch = (context, grid, pale, unit) => {
    context.save();
    context.beginPath();
    for (const window of pale) {
      const { radii, sectors } = grid;
      const [layer, sector] = [Math.floor(window / sectors), window % sectors];
      const [start, end] = [(FULL * sector) / sectors, (FULL * (sector + 1)) / sectors];
      context.moveTo(radii[layer] * Math.cos(start), radii[layer] * Math.sin(start));
      context.arc(0, 0, radii[layer], start, end);
      context.arc(0, 0, radii[layer + 1] ?? 0, end, start, true);
      context.closePath();
    }
    context.clip();
    context.fillStyle = "rgba(255, 255, 255, 0.55)";
    context.fillRect(-1, -1, 2, 2);
    context.beginPath();
    for (let at = -2.5; at < 0.5; at += 7 / unit) { // lines x + y = at + 1, from corner to corner
      context.moveTo(at, 1);
      context.lineTo(at + 2, -1);
    }
    context.strokeStyle = "#9a9a9a";
    context.lineWidth = 1 / unit;
    context.stroke();
    context.restore();
  };

  // The window under a pointer on such a canvas; null beside the disk.
  page.windowOnDisk = (canvas, { radii, sectors }, event) => {
    const { left, top, width } = canvas.getBoundingClientRect();
    const [u, v] = [event.clientX - left, event.clientY - top].map((at) => (2 * at / width - 1) * REACH);
    const layer = radii.filter((radius) => Math.hypot(u, v) <= radius).length - 1;
    const turn = Math.atan2(v, u) / FULL;
    const sector = Math.min(Math.floor((turn - Math.floor(turn)) * sectors), sectors - 1);
    const layers = radii.at(-1) > 0 ? radii.length : radii.length - 1;
    return layer < 0 ? null : Math.min(layer, layers - 1) * sectors + sector;
  };

  // Place of u or v on such a canvas, as a share of its side.
  page.diskShare = (at) => 0.5 * (at / REACH + 1);

  // A bar of the colours with its ends in numbers.
  page.drawBar = (element, limits, palette, unit) => {
    const stops = [0, 0.25, 0.5, 0.75, 1].map((share) => palette[Math.round(share * (palette.length - 1))]);
    const bar = page.make("i");
    bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
    const [low, high] = limits.map(page.digits);
    element.replaceChildren(low, bar, page.known(limits[1]) && unit ? `${high} ${unit}` : high);
  };
})();
