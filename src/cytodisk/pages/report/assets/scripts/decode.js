"use strict";
// Everything of the page hangs on this object; tests look at it.
window.cytodisk = { ready: false, shown: null, drawMilliseconds: null, byId: (id) => document.getElementById(id) };

(() => {
  const page = window.cytodisk;
  const MOST_KEPT = 60; // decoded frames

  // Plain loops, as they run over millions of numbers.
  const bytes = (text) => {
    const letters = atob(text);
    const found = new Uint8Array(letters.length);
    for (let k = 0; k < found.length; k++) found[k] = letters.charCodeAt(k);
    return found;
  };

  const inflate = (text) => {
    const stream = new Blob([bytes(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Response(stream).arrayBuffer();
  };

  // Turns every packed array in a tree into { shape, values }.
  page.unpack = async (value) => {
    if (value === null || typeof value !== "object") return value;
    if (Array.isArray(value)) return Promise.all(value.map(page.unpack));
    if (typeof value.data === "string") return { shape: value.shape, values: new Float32Array(await inflate(value.data)) };
    const items = Object.entries(value).map(async ([name, item]) => [name, await page.unpack(item)]);
    return Object.fromEntries(await Promise.all(items));
  };

  // Grey values of a JPEG.
  const picture = async (text, [height, width]) => {
    const bitmap = await createImageBitmap(new Blob([bytes(text)], { type: "image/jpeg" }));
    const canvas = Object.assign(document.createElement("canvas"), { width, height });
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    const grey = new Uint8Array(width * height);
    for (let k = 0; k < grey.length; k++) grey[k] = data[4 * k];
    return grey;
  };

  page.decode = async ({ labels, channels }, shape) => ({
    labels: labels && new Uint16Array(await inflate(labels)),
    channels: channels && (await Promise.all(channels.map((text) => picture(text, shape)))),
  });

  page.read = (id) => JSON.parse(page.byId(id).textContent);

  const kept = new Map();
  page.forgetFrames = () => kept.clear();
  const fetchFrame = (index) => {
    const found = kept.get(index) ?? page.decode(page.pictures[index], page.data.picture.shape);
    kept.delete(index); // the ones asked for last stand last
    kept.set(index, found);
    if (kept.size > MOST_KEPT) kept.delete(kept.keys().next().value);
    return found;
  };

  // A promise of a decoded frame; the next one is made ready as well.
  page.frameAt = (index) => {
    const found = fetchFrame(index);
    void found.then(() => fetchFrame((index + 1) % page.pictures.length));
    return found;
  };
})();
