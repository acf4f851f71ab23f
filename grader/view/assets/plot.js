// The plot of numeric fields over time, and the table of their values.

import { element } from "./svg.js";

const [HEIGHT, LEFT, RIGHT, TOP, BOTTOM] = [280, 58, 24, 10, 26];
const NARROWEST = 300;
const KEPT_S = 60;
const TONES = 6;
const DASHES = ["", "7 4", "2 3"];

// Return about `count` ticks between the two values, at multiples of 1, 2 or 5 times a power of ten.
export function ticks(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= rough);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, index) => (first + index) * step);
}

// Return the range of the values with a margin. The range is never empty.
export function range(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value === null) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [-1, 1];
  const room = (high - low) * 0.06 || Math.max(Math.abs(high) * 0.1, 0.5);
  return [low - room, high + room];
}

export function shown(value) {
  if (value === null || value === undefined) return "–";
  return Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(2) : String(+value.toFixed(3));
}

// Return the attributes of a field's line, which are the same in the plot and in the table.
function sign(number, attributes) {
  const dash = DASHES[Math.floor(number / TONES) % DASHES.length];
  return { ...attributes, class: `series tone${number % TONES}`, ...(dash && { "stroke-dasharray": dash }) };
}

export class Plot {
  constructor({ place, table, remove, empty }) {
    Object.assign(this, { place, remove, empty, body: table.tBodies[0] });
    this.series = new Map();
    this.numbers = new Map();
    this.wanted = {};
    this.window_s = 30;
    this.held = false;
  }

  show({ wanted, whole, new: fresh }) {
    this.wanted = wanted;
    if (whole) this.series = new Map(Object.entries(whole));
    for (const name of [...this.series.keys()]) {
      if (!Object.keys(wanted).some((each) => `${name}/`.startsWith(`${each}/`))) this.series.delete(name);
    }
    for (const [name, samples] of Object.entries(fresh ?? {})) {
      const all = [...(this.series.get(name) ?? []), ...samples];
      const last = all[all.length - 1][0];
      this.series.set(name, all.filter(([when]) => when >= last - KEPT_S));
    }
    for (const name of this.series.keys()) {
      if (!this.numbers.has(name)) this.numbers.set(name, this.numbers.size);
    }
    if (!this.held) this.draw();
  }

  draw() {
    this.list();
    const all = [...this.series].filter(([, samples]) => samples.length);
    if (all.length === 0) {
      const none = document.createElement("p");
      none.className = "note";
      none.textContent = Object.keys(this.wanted).length ? "No values have arrived yet." : this.empty;
      this.place.replaceChildren(none);
      return;
    }
    const width = Math.max(NARROWEST, this.place.clientWidth);
    const end = Math.max(...all.map(([, samples]) => samples[samples.length - 1][0]));
    const begin = end - this.window_s;
    const visible = all.map(([name, samples]) => [name, samples.filter(([when]) => when >= begin)]);
    const [low, high] = range(visible.flatMap(([, samples]) => samples.map(([, value]) => value)));
    const x = (when) => LEFT + (when - begin) / this.window_s * (width - LEFT - RIGHT);
    const y = (value) => TOP + (high - value) / (high - low) * (HEIGHT - TOP - BOTTOM);
    const svg = element("svg", { viewBox: `0 0 ${width} ${HEIGHT}`, role: "img",
      "aria-label": `${visible.map(([name]) => name).join(", ")} over the last ${this.window_s} seconds` });
    for (const value of ticks(low, high, 6)) {
      svg.append(element("path", { class: "grid", d: `M${LEFT} ${y(value)}H${width - RIGHT}` }),
        element("text", { x: LEFT - 6, y: y(value) + 4, "text-anchor": "end" }, shown(value)));
    }
    for (const back of ticks(0, this.window_s, Math.min(6, width / 90))) {
      svg.append(element("path", { class: "grid", d: `M${x(end - back)} ${TOP}V${HEIGHT - BOTTOM}` }),
        element("text", { x: x(end - back), y: HEIGHT - 8, "text-anchor": "middle" }, back ? `−${back} s` : "now"));
    }
    for (const [name, samples] of visible) {
      let pen = "M";
      const points = samples.map(([when, value]) => {
        if (value === null) { pen = "M"; return ""; }
        const point = `${pen}${x(when).toFixed(1)} ${y(value).toFixed(1)}`;
        pen = "L";
        return point;
      });
      svg.append(element("path", { ...sign(this.numbers.get(name)), d: points.join(""), "data-name": name }));
    }
    this.place.replaceChildren(svg);
  }

  // Add one row per field. If a field cannot be plotted, the row contains the reason.
  list() {
    const rows = [...this.series].map(([name, samples]) => {
      const values = samples.map(([, value]) => value).filter((value) => value !== null);
      return { name, cells: [values[values.length - 1], Math.min(...values), Math.max(...values)]
        .map((value) => shown(Number.isFinite(value) ? value : null)), number: this.numbers.get(name) };
    });
    for (const [name, problem] of Object.entries(this.wanted)) if (problem) rows.push({ name, problem });
    const before = [...this.body.rows];
    const kept = new Map(before.map((row) => [row.dataset.name, row]));
    const after = rows.map((row) => this.row(row, kept.get(row.name)));
    // A button that is taken out of the page and put back loses the focus, and the click if it is being pressed.
    for (const row of before) if (!after.includes(row)) row.remove();
    after.forEach((row, index) => {
      if (row !== this.body.rows[index]) this.body.insertBefore(row, this.body.rows[index] ?? null);
    });
  }

  row({ name, cells, problem, number }, kept) {
    const row = kept ?? this.made(name);
    row.querySelector("svg").replaceChildren(...(problem ? [] : [element("path", sign(number, { d: "M0 6H40" }))]));
    row.querySelector("small").textContent = problem ?? "";
    row.querySelectorAll("td.rate").forEach((cell, index) => { cell.textContent = cells ? cells[index] : "–"; });
    return row;
  }

  made(name) {
    const row = document.createElement("tr");
    row.dataset.name = name;
    const title = document.createElement("th");
    title.scope = "row";
    title.append(element("svg", { viewBox: "0 0 40 12", "aria-hidden": "true" }), name, " ", document.createElement("small"));
    const cells = ["Last value", "Lowest", "Highest"].map((label) => {
      const cell = Object.assign(document.createElement("td"), { className: "rate" });
      cell.dataset.label = label;
      return cell;
    });
    const button = Object.assign(document.createElement("button"), { type: "button", textContent: "Remove" });
    button.setAttribute("aria-label", `Remove ${name}`);
    button.addEventListener("click", () => this.remove(Object.keys(this.wanted).find((each) => `${name}/`.startsWith(`${each}/`)) ?? name));
    const last = document.createElement("td");
    last.append(button);
    row.append(title, ...cells, last);
    return row;
  }
}
