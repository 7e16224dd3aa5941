"use strict";
// Buttons, slider, keys and the pointer, and the numbers in words.
(() => {
  const page = window.cytodisk;
  const MILLISECONDS = 150; // a frame
  const SPEECH_DELAY = 300;
  const byId = (id) => document.getElementById(id);

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
    Escape: () => page.set({ pinned: null, hover: null }),
  };

  // Chords are the browser's (Alt and an arrow go back), but for the keys that type [ and ]:
  // AltGr on many keyboards, which counts as Ctrl and Alt on some systems, and Option on a Mac.
  const isChord = (event) => {
    if (event.getModifierState("AltGraph")) return false;
    if (event.altKey && "[]".includes(event.key)) return event.ctrlKey || event.metaKey;
    return event.ctrlKey || event.metaKey || event.altKey;
  };

  // A control that was used with the pointer gives its keys back to the page; one that was reached
  // with the Tab key keeps them.
  let byPointer = false;
  const giveBack = ({ target }) => {
    if (byPointer) target.closest?.("button, summary, select, input")?.blur();
  };

  const onKey = (event) => {
    if (event.key === "Tab") byPointer = false;
    if (isChord(event) || !(event.key in KEYS)) return;
    const { tagName } = event.target;
    if (tagName === "SELECT" && event.key !== "Escape") return; // moves within its list
    if (event.key === " " && ["BUTTON", "SUMMARY", "A"].includes(tagName)) return; // presses it
    event.preventDefault();
    KEYS[event.key]();
    announce();
  };

  // What lies under the pointer in each kind of view: a window, a moment, or both.
  const indexAt = (x) => page.indexOfFrame(x / page.data.time_step);
  const inMap = ({ x, y }) => ({ layer: page.state.layer, sector: Math.round(y), index: indexAt(x) });
  const inStrip = ({ x }) => ({ index: indexAt(x) });
  const inDisk = ({ x, y }) => {
    const { radii, sectors } = page.data;
    const layer = radii.filter((radius) => Math.hypot(x, y) <= radius).length - 1;
    const turn = Math.atan2(y, x) / (2 * Math.PI);
    const sector = Math.min(Math.floor((turn - Math.floor(turn)) * sectors), sectors - 1);
    return layer < 0 ? null : { layer: Math.min(layer, page.data.layers - 1), sector };
  };
  const inCell = ({ x, y }) => {
    const { shape, box } = page.data.picture;
    const row = Math.floor(((y + 0.5 - box.top) / box.height) * shape[0]);
    const column = Math.floor(((x + 0.5 - box.left) / box.width) * shape[1]);
    const label = page.labels?.[row * shape[1] + column] ?? 65535;
    if (label === 65535) return null;
    return { layer: Math.floor(label / page.data.sectors), sector: label % page.data.sectors };
  };
  const UNDER = { cell: inCell, disk: inDisk, peaks: inDisk, activity: inMap, velocity: inMap };
  const STRIPS = ["area", "residual", "distortion", "intensity"];

  const within = ({ start, end }, value) => Math.min(start, end) < value && value < Math.max(start, end);

  const listen = (figure, find, shows) => {
    const { x_range: x, y_range: y } = figure;
    const under = (event) => (within(x, event.x) && within(y, event.y) ? find(event) : null);
    const tap = (event) => {
      const at = under(event);
      if (at?.index !== undefined) goTo(at.index);
      if (!shows) return;
      page.pin(at);
      announce();
    };
    const hover = (at) => page.set({ hover: at });
    const follow = { mousemove: [(event) => hover(under(event))], mouseleave: [() => hover(null)] };
    figure.js_event_callbacks = { tap: [tap], ...(shows && follow) };
  };

  const onChange = (id, change) => byId(id)?.addEventListener("change", ({ target }) => change(target.value));

  const showPlace = ({ frame, sector }) => {
    play(false);
    goTo(page.indexOfFrame(Number(frame)));
    if (sector !== undefined) page.set({ layer: 0, pinned: { layer: 0, sector: Number(sector) } });
    byId("explorer").scrollIntoView({ block: "start" });
  };

  page.connect = () => {
    for (const [name, find] of Object.entries(UNDER)) if (page.figures[name]) listen(page.figures[name], find, true);
    for (const name of STRIPS) listen(page.figures[name], inStrip, false);
    document.addEventListener("keydown", onKey);
    document.addEventListener("pointerdown", () => (byPointer = true), true);
    document.addEventListener("change", giveBack);
    document.addEventListener("click", (event) => {
      if (!event.target.closest("select, label")) giveBack(event); // a list has only just opened
    });
    byId("time").addEventListener("input", (event) => goTo(event.target.valueAsNumber));
    byId("play").addEventListener("click", () => play(!page.state.playing));
    for (const name of ["channel", "pair"]) onChange(name, (value) => page.set({ [name]: Number(value) }));
    for (const name of ["peak", "colours"]) onChange(name, (value) => page.set({ [name]: value }));
    onChange("layer", (value) => goToLayer(Number(value)));
    for (const button of document.querySelectorAll("button[data-frame]")) {
      button.addEventListener("click", () => showPlace(button.dataset));
    }
    for (const button of document.querySelectorAll("button.why")) {
      button.addEventListener("click", () => {
        button.setAttribute("aria-expanded", String(button.closest(".flag").classList.toggle("open")));
      });
    }
    document.documentElement.classList.add("live");
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
    const seconds = page.lagSeconds(lag);
    const lagWords = page.frameWords(lag) + (seconds && ` (${seconds})`);
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
    page.write("spoken", state.playing ? "playing" : words.join(", "));
  };

  const READ = ["window", "mean", "area", "velocity", "correlation", "lag", "p", "q"];
  const stampOf = (number, time) => (time ? `${number} · ${time}` : `${number}`);

  page.drawControls = () => {
    const { state, data } = page;
    const at = page.focus();
    const words = at ? numbersOf(at) : {};
    for (const name of READ) page.write(`read-${name}`, words[name] ?? "–");
    page.write("read-depth", words.depth ?? "");
    const index = at?.index ?? state.index;
    page.write("read-frame", stampOf(data.frames[index], page.timeOf(index)));
    page.write("read-channel", page.channel().mean ? `${page.channel().name}, mean ± sd` : "signal");
    byId("readout").classList.toggle("idle", !at);
    byId("read-pin").hidden = !state.pinned;
    const now = stampOf(`frame ${state.frame}`, page.timeOf(state.index));
    page.write("now", now);
    byId("time").value = state.index;
    byId("time").setAttribute("aria-valuetext", now.replace(" · ", ", "));
    byId("layer").value = state.layer;
    byId("play").setAttribute("aria-pressed", String(state.playing));
    page.write("play", state.playing ? "❚❚ Pause" : "▶ Play");
    clearTimeout(speaking);
    speaking = setTimeout(announce, SPEECH_DELAY); // once things rest: not every window on the way
  };
})();
