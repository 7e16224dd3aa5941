"use strict";
// Buttons, slider, keys and the pointer, and the numbers in words.
(() => {
  const page = window.cytodisk;
  const { byId, write } = page;
  const MILLISECONDS = 150; // a frame
  const SPEECH_DELAY = 300;

  const goTo = (index) => {
    page.changedAt = performance.now();
    page.set({ index });
  };

  let timer = null;
  const play = (playing) => {
    clearInterval(timer);
    if (playing) timer = setInterval(() => goTo((page.state.index + 1) % page.data.frames.length), MILLISECONDS);
    page.set({ playing });
  };
  page.play = play;

  // Maps, pin and what lies under a resting pointer go to a layer together.
  const goToLayer = (wanted) => {
    const { pinned, hover } = page.state;
    const layer = Math.min(Math.max(wanted, 0), page.data.layers - 1);
    page.set({ layer, pinned: pinned && { ...pinned, layer }, hover: hover && { ...hover, layer } });
  };

  const stepLayer = (by) => goToLayer((page.focus()?.layer ?? page.state.layer) + by);

  const stepSector = (by) => {
    const { state, data } = page;
    const { layer, sector } = page.focus() ?? { layer: state.layer, sector: by > 0 ? -1 : 0 };
    page.set({ layer, pinned: { layer, sector: (sector + by + data.sectors) % data.sectors } });
  };

  const KEYS = {
    ArrowLeft: () => goTo(page.state.index - 1),
    ArrowRight: () => goTo(page.state.index + 1),
    ArrowUp: () => stepLayer(-1),
    ArrowDown: () => stepLayer(1),
    "[": () => stepSector(-1),
    "]": () => stepSector(1),
    " ": () => play(!page.state.playing),
    PageUp: () => void page.stepCell(-1),
    PageDown: () => void page.stepCell(1),
    Escape: () => page.set({ pinned: null, hover: null }),
  };

  // A control that was used with the pointer gives its keys back to the page; one that was reached
  // with the Tab key keeps them.
  let byPointer = false;
  const giveBack = ({ target }) => {
    if (byPointer) target.closest?.("button, summary, select, input")?.blur();
  };

  const onKey = (event) => {
    if (event.key === "Tab") byPointer = false;
    if (page.isChord(event) || !(event.key in KEYS)) return;
    if (event.key.startsWith("Page") && !page.isSeveral()) return; // scrolls
    const { tagName, type, id } = event.target;
    if (tagName === "SELECT" && event.key !== "Escape") return; // moves within its list
    if (type === "range" && id !== "time" && event.key.startsWith("Arrow")) return; // moves the slider
    if (event.key === " " && ["BUTTON", "SUMMARY", "A", "INPUT"].includes(tagName) && id !== "time") return; // presses it
    event.preventDefault();
    KEYS[event.key]();
    announce();
  };

  const listen = ({ canvas, under }, shows) => {
    const hover = (at) => page.set({ hover: at });
    canvas.addEventListener("click", (event) => {
      const at = under(event);
      if (at?.index !== undefined) goTo(at.index);
      if (!shows) return;
      page.pin(at && at.sector !== undefined ? at : null);
      announce();
    });
    if (!shows) return;
    canvas.addEventListener("pointermove", (event) => hover(under(event)));
    canvas.addEventListener("pointerleave", () => hover(null));
  };

  const onChange = (id, change) => byId(id)?.addEventListener("change", ({ target }) => change(target.value, target));

  const showPlace = async ({ cell, frame, sector }) => {
    play(false);
    if (cell !== undefined) await page.openCell(Number(cell));
    if (frame !== undefined) goTo(page.indexOfFrame(Number(frame)));
    if (sector !== undefined) page.set({ layer: 0, pinned: { layer: 0, sector: Number(sector) } });
    byId("explorer").scrollIntoView({ block: "start" });
  };

  page.connect = () => {
    for (const [name, figure] of Object.entries(page.figures)) listen(figure, !page.study.strips.includes(name));
    document.addEventListener("keydown", onKey);
    document.addEventListener("pointerdown", () => (byPointer = true), true);
    document.addEventListener("change", giveBack);
    document.addEventListener("click", (event) => {
      if (!event.target.closest("select, label")) giveBack(event); // a list has only just opened
    });
    byId("time").addEventListener("input", (event) => goTo(event.target.valueAsNumber));
    byId("play").addEventListener("click", () => play(!page.state.playing));
    for (const name of ["channel", "pair"]) onChange(name, (value) => page.set({ [name]: Number(value) }));
    for (const name of ["peak", "colours", "shows"]) onChange(name, (value) => page.set({ [name]: value }));
    for (const name of ["grid", "rim"]) onChange(name, (_, target) => page.set({ [name]: target.checked }));
    onChange("layer", (value) => goToLayer(Number(value)));
    page.connectContrast(() => page.set({}), page.autoCell);
    for (const button of document.querySelectorAll("button[data-frame], button[data-cell]")) {
      button.addEventListener("click", () => void showPlace(button.dataset));
    }
  };

  // The numbers of the window and moment that are highlighted, in words.
  const numbersOf = ({ layer, sector, index }) => {
    const { data } = page;
    const number = page.windowOf(layer, sector);
    const { mean, sd, unit } = page.channel();
    const [area, depth, speed, error] = [
      page.row(data.area, index)[number],
      page.row(data.depth, index)[number],
      page.row(data.velocity, index)[sector],
      page.row(data.velocity_error, index)[sector],
    ];
    const spread = (value, around, of) => `${page.digits(value)} ± ${page.withUnit(around, of)}`;
    const words = {
      window: `${page.layerWords(layer)}, sector ${sector}`,
      mean: mean ? spread(page.row(mean, index)[number], page.row(sd, index)[number], unit) : "–",
      area: page.withUnit(area, data.units.area),
      depth: Number.isFinite(depth) ? `, ${page.withUnit(depth, data.units.depth)} deep` : "",
      velocity: Number.isFinite(speed) ? spread(speed, error, data.units.velocity) : "–",
    };
    if (!data.pairs.length) return words;
    const { windows } = page.pair();
    const [r, lag, p, q] = ["correlation", "lag", "p", "q"].map((name) => windows[name].values[number]);
    const time = page.lagWords(lag);
    const lagWords = page.frameWords(lag) + (time && ` (${time})`);
    return { ...words, correlation: page.fixed(r), lag: lagWords, p: page.chance(p), q: page.chance(q) };
  };

  let speaking = null;
  const announce = () => {
    clearTimeout(speaking);
    const { state } = page;
    const at = page.focus();
    const words = [`frame ${state.frame}`, `layer ${at?.layer ?? state.layer}`];
    if (at) {
      const { name, unit } = page.channel();
      const value = page.row(page.channelValues(), at.index)[page.windowOf(at.layer, at.sector)];
      words.push(`sector ${at.sector}`, `${name} ${page.withUnit(value, unit)}`);
      words.push(`velocity ${page.withUnit(page.row(page.data.velocity, at.index)[at.sector], page.data.units.velocity)}`);
    }
    write("spoken", state.playing ? "playing" : words.join(", "));
  };

  const READ = ["window", "mean", "area", "velocity", "correlation", "lag", "p", "q"];
  const stampOf = (number, time) => (time ? `${number} · ${time}` : `${number}`);

  page.drawControls = () => {
    const { state, data } = page;
    const at = page.focus();
    const words = at ? numbersOf(at) : {};
    for (const name of READ) write(`read-${name}`, words[name] ?? "–");
    write("read-depth", words.depth ?? "");
    const index = at?.index ?? state.index;
    write("read-frame", stampOf(data.frames[index], page.timeOf(index)));
    write("read-channel", page.channel().mean ? `${page.channel().name}, mean ± sd` : "signal");
    byId("readout").classList.toggle("idle", !at);
    byId("read-pin").hidden = !state.pinned;
    const now = stampOf(`frame ${state.frame}`, page.timeOf(state.index));
    write("now", now);
    byId("time").value = state.index;
    byId("time").setAttribute("aria-valuetext", now.replace(" · ", ", "));
    for (const name of ["layer", "channel", "pair", "shows"]) if (byId(name)) byId(name).value = state[name];
    byId("play").setAttribute("aria-pressed", String(state.playing));
    write("play", state.playing ? "❚❚ Pause" : "▶ Play");
    clearTimeout(speaking);
    speaking = setTimeout(announce, SPEECH_DELAY); // once things rest: not every window on the way
  };
})();
