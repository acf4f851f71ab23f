// The log messages of all nodes, with filters by level, node and text.

const LEVELS = ["Debug", "Info", "Warn", "Error", "Fatal"];
const MOST = 2000;
const SHOWN = 500;

export function passes(line, { levels, node, text }) {
  return levels.has(line.level) && (!node || line.node === node) && line.text.toLowerCase().includes(text.toLowerCase());
}

function clock(stamp) {
  const when = new Date(stamp * 1000);
  const two = (value) => String(value).padStart(2, "0");
  return `${two(when.getHours())}:${two(when.getMinutes())}:${two(when.getSeconds())}.${String(when.getMilliseconds()).padStart(3, "0")}`;
}

function row(line) {
  const made = document.createElement("tr");
  made.dataset.level = line.level;
  for (const [name, text] of [["when", clock(line.stamp)], ["level", line.level], ["node", line.node], ["text", line.text]]) {
    const cell = document.createElement("td");
    cell.className = name;
    cell.textContent = text;
    made.append(cell);
  }
  made.title = line.where;
  return made;
}

export class Console {
  constructor({ table, place, count, levels, node, text, pause, clear }) {
    Object.assign(this, { body: table.tBodies[0], place, count, levels, node, text, pause });
    this.lines = [];
    this.cleared = 0;
    this.held = null;
    levels.append(...LEVELS.map((name) => {
      const label = document.createElement("label");
      const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: true, value: name });
      label.append(box, name);
      return label;
    }));
    for (const part of [levels, node]) part.addEventListener("change", () => this.draw());
    text.addEventListener("input", () => this.draw());
    pause.addEventListener("click", () => this.hold(this.held === null));
    clear.addEventListener("click", () => this.clear());
  }

  // While the table is paused, new messages are kept and added afterwards.
  hold(held) {
    this.held = held ? [...this.lines] : null;
    this.pause.textContent = held ? "Resume" : "Pause";
    this.pause.setAttribute("aria-pressed", String(held));
    this.draw();
  }

  // The server sends all messages again when the page connects again.
  clear() {
    this.cleared = this.lines.at(-1)?.number ?? this.cleared;
    this.lines = [];
    if (this.held !== null) this.held = [];
    this.draw();
  }

  whole(lines) {
    if ((lines.at(-1)?.number ?? 0) < this.cleared) this.cleared = 0; // the server was started again
    this.lines = lines.filter((line) => line.number > this.cleared);
    this.named();
    if (this.held === null) this.draw();
  }

  add(lines) {
    this.lines = [...this.lines, ...lines].slice(-MOST);
    this.named();
    if (this.held === null) this.draw();
  }

  named() {
    const known = new Set([...this.node.options].map((option) => option.value));
    for (const name of new Set(this.lines.map((line) => line.node))) if (!known.has(name)) this.node.append(new Option(name, name));
  }

  draw() {
    const levels = new Set([...this.levels.querySelectorAll("input:checked")].map((box) => box.value));
    const filter = { levels, node: this.node.value, text: this.text.value };
    const all = this.held ?? this.lines;
    const found = all.filter((line) => passes(line, filter));
    const follows = this.place.scrollTop + this.place.clientHeight >= this.place.scrollHeight - 4;
    this.body.replaceChildren(...found.slice(-SHOWN).map(row));
    if (follows) this.place.scrollTop = this.place.scrollHeight;
    const hidden = all.length - found.length;
    const older = found.length > SHOWN ? `; only the last ${SHOWN} are in the table` : "";
    this.count.textContent = `${found.length} ${found.length === 1 ? "message" : "messages"}${hidden ? `, ${hidden} hidden by the filters` : ""}${older}.`;
  }
}
