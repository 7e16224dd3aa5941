"use strict";
// Buttons, slider, keys and the pointer.
(() => {
  const page = window.cytodisk;
  const MILLISECONDS = 150; // a frame
  const SPEECH_DELAY = 300;
  const byId = (id) => document.getElementById(id);
  const write = (id, words) => {
    const element = byId(id);
    if (element && element.textContent !== words) element.textContent = words;
  };

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
    page.set({
      layer,
      pinned: pinned && { ...pinned, layer },
      hover: hover && { ...hover, layer },
    });
  };

  const stepLayer = (by) => goToLayer((page.focus()?.layer ?? page.state.layer) + by);

  const stepSector = (by) => {
    const { state, data } = page;
    const at = page.focus() ?? { layer: state.layer, sector: by > 0 ? -1 : 0 };
    const sector = (at.sector + by + data.sectors) % data.sectors;
    page.set({ layer: at.layer, pinned: { layer: at.layer, sector } });
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

  // A control that was used with the pointer gives its keys back to the page; one that was reached
  // with the Tab key keeps them.
  let byPointer = false;
  const giveBack = ({ target }) => {
    const control = target.closest?.("button, summary, select, input");
    if (byPointer && control) control.blur();
  };

  const announce = () => {
    clearTimeout(speaking);
    if (page.state.playing) {
      write("spoken", "playing");
      return;
    }
    const at = page.focus();
    const { state, data } = page;
    const words = [`frame ${state.frame}`, `layer ${at?.layer ?? state.layer}`];
    if (at) {
      const number = page.windowOf(at.layer, at.sector);
      const value = page.byWindow(page.channelValues(), at.index)[number];
      words.push(`sector ${at.sector}`, `${page.channel().name} ${page.withUnit(value, page.channel().unit)}`);
      words.push(`velocity ${page.withUnit(data.velocity.values[at.index * data.sectors + at.sector], data.units.velocity)}`);
    }
    write("spoken", words.join(", "));
  };

  // Once things rest: not every frame and window on the way.
  let speaking = null;
  const announceSoon = () => {
    clearTimeout(speaking);
    speaking = setTimeout(announce, SPEECH_DELAY);
  };

  const within = ({ x_range: x, y_range: y }, event) =>
    Math.min(x.start, x.end) <= event.x &&
    event.x <= Math.max(x.start, x.end) &&
    Math.min(y.start, y.end) <= event.y &&
    event.y <= Math.max(y.start, y.end);

  // What lies under the pointer in each kind of view: a window, a moment, or both.
  const indexAt = (x) => page.indexOfFrame(x / page.data.time.step);
  const inMap = ({ x, y }) => ({
    layer: page.state.layer,
    sector: Math.min(Math.max(Math.round(y), 0), page.data.sectors - 1),
    index: indexAt(x),
  });
  const inDisk = ({ x, y }) => page.windowAtDisk(x, y);
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

  const listen = (name, figure) => {
    const under = (event) => (within(figure, event) ? UNDER[name](event) : null);
    figure.js_event_callbacks = {
      mousemove: [(event) => page.set({ hover: under(event) })],
      mouseleave: [() => page.set({ hover: null })],
      tap: [
        (event) => {
          const at = under(event);
          if (at?.index !== undefined) goTo(at.index);
          page.pin(at);
          announce();
        },
      ],
    };
  };

  const listenStrip = (figure) => {
    figure.js_event_callbacks = {
      tap: [(event) => within(figure, event) && goTo(indexAt(event.x))],
    };
  };

  page.connect = () => {
    for (const [name, figure] of Object.entries(page.figures)) {
      if (name in UNDER) listen(name, figure);
      if (STRIPS.includes(name)) listenStrip(figure);
    }
    document.addEventListener("keydown", onKey);
    document.addEventListener("pointerdown", () => {
      byPointer = true;
    }, true);
    document.addEventListener("change", giveBack);
    document.addEventListener("click", (event) => {
      if (!event.target.closest("select, label")) giveBack(event); // a list has only just opened
    });
    byId("time").addEventListener("input", (event) => goTo(event.target.valueAsNumber));
    byId("play").addEventListener("click", () => play(!page.state.playing));
    for (const name of ["channel", "pair"]) {
      byId(name)?.addEventListener("change", (event) => page.set({ [name]: Number(event.target.value) }));
    }
    for (const name of ["peak", "colours"]) {
      byId(name)?.addEventListener("change", (event) => page.set({ [name]: event.target.value }));
    }
    byId("layer").addEventListener("change", (event) => goToLayer(Number(event.target.value)));
    connectFlags();
  };

  const connectFlags = () => {
    for (const button of document.querySelectorAll("button[data-frame]")) {
      button.addEventListener("click", () => {
        const { frame, sector } = button.dataset;
        play(false);
        goTo(page.indexOfFrame(Number(frame)));
        if (sector !== undefined) page.set({ layer: 0, pinned: { layer: 0, sector: Number(sector) } });
        byId("explorer").scrollIntoView({ block: "start" });
      });
    }
    for (const button of document.querySelectorAll("button.why")) {
      button.addEventListener("click", () => {
        const open = button.closest(".flag").classList.toggle("open");
        button.setAttribute("aria-expanded", String(open));
      });
    }
    document.documentElement.classList.add("live");
  };

  const readWindow = (at) => {
    const { data } = page;
    const number = page.windowOf(at.layer, at.sector);
    const place = at.index * data.sectors + at.sector;
    const { mean, sd, unit } = page.channel();
    const value = mean && page.byWindow(mean, at.index)[number];
    const spread = mean && page.byWindow(sd, at.index)[number];
    write("read-mean", mean ? `${page.digits(value)} ± ${page.withUnit(spread, unit)}` : "–");
    write("read-area", page.withUnit(page.byWindow(data.area, at.index)[number], data.units.area));
    const [speed, error] = [data.velocity.values[place], data.velocity_error.values[place]];
    write(
      "read-velocity",
      Number.isFinite(speed) ? `${page.digits(speed)} ± ${page.withUnit(error, data.units.velocity)}` : "–",
    );
  };

  const readPair = (at) => {
    const { windows } = page.pair();
    const number = page.windowOf(at.layer, at.sector);
    const of = (name) => windows[name]?.values[number];
    const lag = of("lag");
    const seconds = page.data.interval_s === null ? "" : ` (${page.lagWords(lag)})`;
    write("read-correlation", page.fixed(of("correlation")));
    write("read-lag", Number.isFinite(lag) ? `${page.frameWords(lag)}${seconds}` : "–");
    write("read-p", page.chance(of("p")));
    write("read-q", page.chance(of("q")));
  };

  page.drawControls = () => {
    const { state, data } = page;
    const at = page.focus();
    const index = at?.index ?? state.index;
    const time = page.timeOf(index);
    write("read-frame", `${data.frames[index]}${time && ` · ${time}`}`);
    write("read-window", at ? `layer ${at.layer}, sector ${at.sector}` : "–");
    write("read-channel", page.channel().mean ? `${page.channel().name}, mean ± sd` : "signal");
    if (at) readWindow(at);
    else for (const name of ["mean", "area", "velocity"]) write(`read-${name}`, "–");
    if (at && data.pairs.length) readPair(at);
    else for (const name of ["correlation", "lag", "p", "q"]) write(`read-${name}`, "–");
    byId("readout").classList.toggle("idle", !at);
    byId("read-pin").hidden = !state.pinned;
    const slider = byId("time");
    slider.value = state.index;
    slider.setAttribute("aria-valuetext", `frame ${state.frame}${page.timeOf(state.index) && `, ${page.timeOf(state.index)}`}`);
    byId("layer").value = state.layer;
    write("now", `frame ${state.frame}${page.timeOf(state.index) && ` · ${page.timeOf(state.index)}`}`);
    const button = byId("play");
    button.setAttribute("aria-pressed", String(state.playing));
    button.textContent = state.playing ? "❚❚ Pause" : "▶ Play";
    announceSoon();
  };
})();
