// The graph in the layout of Graphviz.

import { element } from "./svg.js";

const PAD = 8;
const ZOOM = 1.25;
const SMALLEST = 0.8;

function drawn(node) {
  const { kind, label, x, y, width, height } = node;
  const shape = kind === "topic"
    ? element("rect", { x: x - width / 2, y: y - height / 2, width, height, rx: 2 })
    : element("ellipse", { cx: x, cy: y, rx: width / 2, ry: height / 2 });
  const lines = label.split("\n");
  const texts = lines.map((line, index) =>
    element("text", { x, y: y + 4 + (index - (lines.length - 1) / 2) * 14, "text-anchor": "middle" }, line));
  return element("g", { class: kind, "data-name": lines[0] }, element("title", {}, `${kind} ${label}`), shape, ...texts);
}

function arrow({ from, to, tip, points }) {
  const [first, ...rest] = points;
  const line = element("path", { d: `M${first.join(" ")}C${rest.map((point) => point.join(" ")).join(" ")}` });
  const last = points[points.length - 1];
  const degrees = Math.atan2(tip[1] - last[1], tip[0] - last[0]) * 180 / Math.PI;
  const head = element("path", { d: "M0 0l-9-4v8z", class: "head",
    transform: `translate(${tip.join(" ")}) rotate(${degrees})` });
  return element("g", { class: "arrow", "data-from": from, "data-to": to }, line, head);
}

export class Graph {
  constructor(place) {
    this.place = place;
    this.room = 0;
    new ResizeObserver(([{ contentRect }]) => {
      this.room = contentRect.width;
      this.draw();
    }).observe(place);
  }

  // `wide` and `narrow` are two layouts of the same graph.
  show({ wide, narrow, problem }) {
    this.layouts = { wide, narrow };
    this.drawn = null;
    if (problem || wide.nodes.length === 0) {
      this.layouts = null;
      const none = document.createElement("p");
      none.className = "note";
      none.textContent = problem ?? "No node was found.";
      this.place.replaceChildren(none);
    }
    this.draw();
  }

  // Draw the layout that fits, unless it is drawn already.
  draw() {
    if (!this.layouts) return;
    const { wide, narrow } = this.layouts;
    const layout = this.room && this.room < wide.width + 2 * PAD ? narrow : wide;
    if (layout === this.drawn) return;
    this.drawn = layout;
    const { width, height, nodes, arrows } = layout;
    const about = arrows.map(({ from, to }) => `${from} to ${to}`).join(", ");
    const box = [-PAD, -PAD, width + 2 * PAD, height + 2 * PAD];
    const svg = element("svg", { viewBox: box.join(" "), width: box[2] * ZOOM, height: box[3] * ZOOM, role: "img",
      "aria-label": `Nodes and topics. Messages: ${about || "none"}.` },
      ...arrows.map(arrow), ...nodes.map(drawn));
    // A larger graph scrolls instead of becoming unreadable.
    svg.style.minWidth = `${box[2] * SMALLEST}px`;
    this.place.replaceChildren(svg);
    this.flow(this.busy ?? new Set());
  }

  // Mark the arrows of the topics on which messages arrive now. `busy` contains the names of these topics.
  flow(busy) {
    this.busy = busy;
    for (const each of this.place.querySelectorAll(".arrow")) {
      const flows = busy.has(each.dataset.from) || busy.has(each.dataset.to);
      each.classList.toggle("flows", flows);
    }
  }
}
