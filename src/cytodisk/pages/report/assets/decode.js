"use strict";
// Everything of the page hangs on this object; tests look at it.
window.cytodisk = { ready: false, shown: null, drawMilliseconds: null };

(() => {
  const page = window.cytodisk;

  page.bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

  page.inflate = (text) => {
    const stream = new Blob([page.bytes(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Response(stream).arrayBuffer();
  };

  const isPacked = (value) => typeof value.data === "string" && Array.isArray(value.shape);

  // Turns every packed array in a tree into { shape, values }.
  page.unpack = async (value) => {
    if (value === null || typeof value !== "object") return value;
    if (isPacked(value)) {
      return { shape: value.shape, values: new Float32Array(await page.inflate(value.data)) };
    }
    if (Array.isArray(value)) return Promise.all(value.map(page.unpack));
    const items = Object.entries(value).map(async ([name, item]) => [name, await page.unpack(item)]);
    return Object.fromEntries(await Promise.all(items));
  };

  // Grey values of a JPEG.
  const picture = async (text, [height, width]) => {
    const bitmap = await createImageBitmap(new Blob([page.bytes(text)], { type: "image/jpeg" }));
    const canvas = document.createElement("canvas");
    canvas.width = width;
    canvas.height = height;
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    const grey = new Uint8Array(width * height);
    for (let k = 0; k < grey.length; k++) grey[k] = data[4 * k];
    return grey;
  };

  const decodeFrame = async ({ labels, channels }, shape) => ({
    labels: labels && new Uint16Array(await page.inflate(labels)),
    channels: channels && (await Promise.all(channels.map((text) => picture(text, shape)))),
  });

  const MOST_KEPT = 60;
  const kept = new Map();

  // A promise of a decoded frame; the ones asked for last are kept. The next one is made ready as well.
  const fetchFrame = (index) => {
    const found = kept.get(index) ?? decodeFrame(page.pictures[index], page.data.picture.shape);
    kept.delete(index);
    kept.set(index, found);
    if (kept.size > MOST_KEPT) kept.delete(kept.keys().next().value);
    return found;
  };

  page.frameAt = (index) => {
    const found = fetchFrame(index);
    const next = (index + 1) % page.pictures.length;
    void found.then(() => fetchFrame(next));
    return found;
  };
})();
