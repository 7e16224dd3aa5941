"use strict";
// Elements of the page: made, found, filled.
(() => {
  const page = window.cytodisk;
  const { byId } = page;
  const SVG = "http://www.w3.org/2000/svg";

  // An element with attributes, and children that are elements or text.
  const filled = (element, attributes, children) => {
    for (const [name, value] of Object.entries(attributes)) {
      if (value === false || value === null || value === undefined) continue;
      if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
      else element.setAttribute(name, value === true ? "" : value);
    }
    element.append(...children);
    return element;
  };
  page.make = (tag, attributes = {}, ...children) => filled(document.createElement(tag), attributes, children);
  page.svg = (tag, attributes = {}, ...children) => filled(document.createElementNS(SVG, tag), attributes, children);

  page.write = (id, words) => {
    const element = byId(id);
    if (element && element.textContent !== words) element.textContent = words;
  };

  // Fills a list to choose from with [value, words]; keeps the choice if it is still there.
  page.fill = (id, options) => {
    const select = byId(id);
    if (!select) return;
    const { value } = select;
    select.replaceChildren(...options.map(([own, words]) => page.make("option", { value: own }, words)));
    if (options.some(([own]) => String(own) === value)) select.value = value;
  };

  // "show=1&b=2" after the sign # of the address, with the cell in the first place: #cell-3&channel=Rac1
  page.address = () => {
    const [cell, ...rest] = location.hash.slice(1).split("&");
    const number = /^cell-(\d+)$/.exec(cell)?.[1];
    return { cell: number === undefined ? null : Number(number), channel: new URLSearchParams(rest.join("&")).get("channel") };
  };

  // Chords are the browser's (Alt and an arrow go back), but for the keys that type [ and ]:
  // AltGr on many keyboards, which counts as Ctrl and Alt on some systems, and Option on a Mac.
  page.isChord = (event) => {
    if (event.getModifierState("AltGraph")) return false;
    if (event.altKey && "[]".includes(event.key)) return event.ctrlKey || event.metaKey;
    return event.ctrlKey || event.metaKey || event.altKey;
  };

  // What every page does: flags unfold; a script that fails says so.
  page.start = async (work) => {
    for (const button of document.querySelectorAll("button.why")) {
      button.addEventListener("click", () => {
        button.setAttribute("aria-expanded", String(button.closest(".flag").classList.toggle("open")));
      });
    }
    const more = document.querySelector("button.more-flags");
    more?.addEventListener("click", () => {
      const all = byId("flags").classList.toggle("all");
      more.setAttribute("aria-expanded", String(all));
      more.textContent = all ? "show three" : "show all";
    });
    document.documentElement.classList.add("live");
    try {
      await work();
      page.ready = true;
      page.readyMilliseconds = performance.now();
    } catch (error) {
      byId("failed").hidden = false;
      throw error;
    }
  };
})();
