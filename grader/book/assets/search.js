// The search. Each word must occur in the heading or the text of a section. A word in a heading has a higher weight than
// a word in the text.

const MOST = 8;
const AROUND = 60;

const words = (text) => text.toLowerCase().split(/\s+/).filter(Boolean);

// Return at most MOST sections that contain all words, best match first.
export function find(index, query) {
  const wanted = words(query);
  if (wanted.length === 0) return [];
  const found = [];
  index.forEach((entry, place) => {
    const title = entry.title.toLowerCase();
    const text = entry.text.toLowerCase();
    if (!wanted.every((word) => title.includes(word) || text.includes(word))) return;
    const score = wanted.reduce((sum, word) => sum + (title.includes(word) ? 10 : 0) + Math.min(text.split(word).length - 1, 5), 0);
    found.push({ entry, score, place });
  });
  found.sort((a, b) => b.score - a.score || a.place - b.place);
  return found.slice(0, MOST).map((each) => each.entry);
}

// Return the text around one of the words, or the beginning of the text if it contains none. The result consists of
// whole words.
export function excerpt(text, query) {
  const at = Math.max(...words(query).map((word) => text.toLowerCase().indexOf(word)), 0);
  const from = at > AROUND ? text.indexOf(" ", at - AROUND) + 1 : 0;
  const space = text.indexOf(" ", at + 2 * AROUND);
  const to = space < 0 ? text.length : space;
  return `${from > 0 ? "… " : ""}${text.slice(from, to).trim()}${to < text.length ? " …" : ""}`;
}

function result(entry, query, root) {
  const link = document.createElement("a");
  link.href = root + entry.page;
  const place = document.createElement("span");
  place.className = "place";
  place.textContent = entry.lesson;
  const title = document.createElement("b");
  title.textContent = entry.title;
  const text = document.createElement("span");
  text.className = "excerpt";
  text.textContent = excerpt(entry.text, query);
  link.append(title, " ", place, text);
  const item = document.createElement("li");
  item.append(link);
  return item;
}

export function addSearch(box, root) {
  const input = box.querySelector("input");
  const found = box.querySelector("#search-found");
  let index = null;

  async function show() {
    const query = input.value;
    if (!query.trim()) {
      found.replaceChildren();
      return;
    }
    try {
      index ??= fetch(`${root}search.json`).then((answer) => answer.json());
      const entries = find(await index, query);
      if (query !== input.value) return;
      const list = document.createElement(entries.length ? "ul" : "p");
      if (entries.length) list.append(...entries.map((entry) => result(entry, query, root)));
      else list.textContent = words(query).length > 1 ? "No section contains all of these words." : "No section contains this word.";
      found.replaceChildren(list);
    } catch {
      index = null;
      found.textContent = "The search index could not be loaded. The search needs a web server.";
    }
  }

  input.addEventListener("input", show);
  // The arrow keys move through the results, and Enter opens the result that has the focus, or else the first one.
  function move(by) {
    const places = [input, ...found.querySelectorAll("a")];
    places[places.indexOf(document.activeElement) + by]?.focus();
  }

  const keys = {
    Escape() {
      input.value = "";
      found.replaceChildren();
      input.focus();
    },
    ArrowDown: () => move(1),
    ArrowUp: () => move(-1),
    Enter: () => (document.activeElement === input ? found.querySelector("a") : document.activeElement)?.click(),
  };
  box.addEventListener("keydown", (event) => {
    if (!Object.hasOwn(keys, event.key)) return;
    event.preventDefault();
    keys[event.key]();
  });
  // A link to a section of the same page does not load a page, so close the list.
  found.addEventListener("click", (event) => {
    if (event.target.closest("a")) found.replaceChildren();
  });
  box.hidden = false;
}
