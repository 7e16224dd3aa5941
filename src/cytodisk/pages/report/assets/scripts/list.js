"use strict";
// A table that is sorted by any column, filtered and turned over by page; rows can also stand as cards.
(() => {
  const page = window.cytodisk;
  const ROWS = { table: 50, cards: 24 }; // on one page of the list
  const { compare } = new Intl.Collator(undefined, { numeric: true, sensitivity: "base" });

  const { make } = page;

  const shownValue = (column, value) => {
    if (value === null || value === undefined) return "";
    if (!column.number) return String(value);
    return column.whole ? String(value).replace("-", "−") : page.digits(value);
  };
  page.shownValue = shownValue;

  // Empty values stand last in both directions.
  const ordered = (rows, numbers, column, place, descending) => {
    const sign = descending ? -1 : 1;
    const before = (a, b) => (column.number ? a - b : compare(String(a), String(b)));
    return [...numbers].sort((a, b) => {
      const [one, other] = [rows[a][place], rows[b][place]];
      const [empty, otherEmpty] = [one === null || one === "", other === null || other === ""];
      if (empty || otherEmpty) return empty - otherEmpty || a - b;
      return sign * before(one, other) || a - b;
    });
  };

  // links: addresses by row, null for none, in the place of open; address(link): with what is chosen.
  // root: element for the list. table: { columns, rows }. open(row): what a click does; name(row): its words.
  // card(row): content of a card, for lists with cards. choices: [{ label, options: [{ label, test }] }].
  page.list = ({ root, table, label, open = null, name = null, links = null, address = (link) => link, card = null, choices = [], sort = null }) => {
    const { columns, rows } = table;
    const state = { sort, descending: false, text: "", all: false, cards: Boolean(card), start: 0, choices: [] };
    const texts = rows.map((row) => row.filter((value) => typeof value === "string").join("\n").toLowerCase());
    const place = (column) => columns.findIndex(({ name: own }) => own === column);
    let found = [];

    const find = () => {
      const words = state.text.toLowerCase().split(/\s+/).filter(Boolean);
      const tests = state.choices.filter(Boolean);
      const numbers = [...rows.keys()].filter(
        (k) => words.every((word) => texts[k].includes(word)) && tests.every((test) => test(rows[k])),
      );
      const column = place(state.sort);
      return column < 0 ? numbers : ordered(rows, numbers, columns[column], column, state.descending);
    };

    const change = (changes) => {
      Object.assign(state, { start: 0 }, changes);
      if (!("start" in changes)) found = find();
      draw();
    };

    const sortBy = (column, descending = null) => {
      const same = state.sort === column;
      change({ sort: column, descending: descending ?? (same ? !state.descending : false) });
    };

    const head = (column) => {
      const sorted = state.sort === column.name;
      const unit = column.unit ? [make("span", { class: "unit" }, ` ${column.unit}`)] : [];
      const mark = sorted ? (state.descending ? " ▼" : " ▲") : "";
      const press = () => {
        sortBy(column.name);
        root.querySelector(`th[data-name="${CSS.escape(column.name)}"] button`)?.focus();
      };
      const button = make("button", { type: "button", title: column.title, onclick: press }, column.label, ...unit);
      button.append(make("span", { class: "mark", "aria-hidden": "true" }, mark));
      const order = sorted ? (state.descending ? "descending" : "ascending") : "none";
      const look = column.number ? "number" : null;
      return make("th", { scope: "col", "aria-sort": order, "data-name": column.name, class: look }, button);
    };

    const cellOf = (column, value, k, first) => {
      const words = shownValue(column, value);
      const look = column.number ? "number" : words.length > 24 ? "long" : null;
      if (first && links?.[k]) {
        const goes = (event) => (event.currentTarget.href = address(links[k])); // which depends on what is chosen
        return make("td", { class: look }, make("a", { href: links[k], onclick: goes, onauxclick: goes, "aria-label": `open ${name(rows[k])}` }, words));
      }
      if (!first || !open) return make("td", { class: look, title: look === "long" ? words : null }, words);
      const button = make("button", { type: "button", class: "opens", "aria-label": `open ${name(rows[k])}` }, words);
      return make("td", { class: look }, button);
    };

    const drawTable = (numbers) => {
      const shown = columns.map((column, at) => ({ column, at })).filter(({ column }) => state.all || column.main);
      const body = make("tbody");
      for (const k of numbers) {
        const cells = shown.map(({ column, at }, number) => cellOf(column, rows[k][at], k, number === 0));
        const go = open ?? (links?.[k] ? (_, event) => event.target.tagName !== "A" && (location.href = address(links[k])) : null);
        body.append(make("tr", go ? { class: "opening", onclick: (event) => go(k, event) } : {}, ...cells));
      }
      const titles = make("tr", {}, ...shown.map(({ column }) => head(column)));
      return make("table", { class: "list" }, make("caption", { class: "unseen" }, label), make("thead", {}, titles), body);
    };

    const drawCards = (numbers) => {
      const cards = numbers.map((k) => {
        const button = { type: "button", class: "card", onclick: () => open(k), "aria-label": `open ${name(rows[k])}` };
        return make("li", {}, make("button", button, ...card(k, state.sort)));
      });
      return make("ul", { class: "cards" }, ...cards);
    };

    const body = make("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": `list of ${label}` });
    const count = make("output", { class: "count" });
    const turn = (by) => {
      change({ start: state.start + by * ROWS[state.cards ? "cards" : "table"] });
      root.scrollIntoView({ block: "nearest" });
    };
    const earlier = make("button", { type: "button", onclick: () => turn(-1) }, "‹ Earlier");
    const later = make("button", { type: "button", onclick: () => turn(1) }, "Later ›");
    const controls = make("div", { class: "controls" });

    const draw = () => {
      const size = ROWS[state.cards ? "cards" : "table"];
      const numbers = found.slice(state.start, state.start + size);
      const last = state.start + numbers.length;
      body.replaceChildren(
        numbers.length ? (state.cards ? drawCards : drawTable)(numbers) : make("p", {}, "Nothing fits: change the filter."),
      );
      const of = found.length === rows.length ? `${rows.length}` : `${found.length} of ${rows.length}`;
      count.textContent = found.length > size ? `${state.start + 1}–${last} of ${found.length}` : of;
      earlier.disabled = state.start === 0;
      later.disabled = last >= found.length;
      pager.hidden = found.length <= size;
      by.value = state.sort ?? "";
      way.textContent = state.descending ? "▼" : "▲";
      way.setAttribute("aria-label", state.descending ? "descending: change to ascending" : "ascending: change to descending");
      for (const button of looks) button.setAttribute("aria-pressed", String(state.cards === (button.value === "cards")));
    };

    const pager = make("nav", { class: "pager", "aria-label": `pages of ${label}` }, earlier, later);
    const search = make("input", { type: "search", placeholder: "filter by text", "aria-label": `filter ${label}` });
    search.addEventListener("input", () => change({ text: search.value }));
    const selects = choices.map(({ label: words, options }, number) => {
      const select = make("select", { "aria-label": words }, ...options.map((one, k) => make("option", { value: k }, one.label)));
      select.addEventListener("change", () => {
        state.choices[number] = options[select.value].test;
        change({});
      });
      return select;
    });
    const names = columns.map((column) => make("option", { value: column.name }, column.label));
    const by = make("select", {}, make("option", { value: "" }, "order of the table"), ...names);
    by.addEventListener("change", () => sortBy(by.value || null, state.descending));
    const way = make("button", { type: "button", class: "way", onclick: () => change({ descending: !state.descending }) });
    const look = (value, words) => {
      const press = () => change({ cards: value === "cards" });
      return make("button", { type: "button", value, onclick: press }, words);
    };
    const looks = card ? [look("cards", "Pictures"), look("table", "Table")] : [];
    const every = make("input", { type: "checkbox", onchange: () => change({ all: every.checked, cards: false }) });
    const more = columns.some(({ main }) => !main);
    controls.append(search, ...selects, make("label", {}, "Sort by ", by), way);
    if (looks.length) controls.append(make("span", { class: "looks", role: "group", "aria-label": "how the list looks" }, ...looks));
    if (more) controls.append(make("label", {}, every, ` all ${columns.length} columns`));
    controls.append(count);
    root.append(controls, body, pager);
    change({});
    return {
      state,
      find: () => found,
      choose: (number, option) => {
        selects[number].value = option;
        selects[number].dispatchEvent(new Event("change"));
      },
    };
  };
})();
