// The canvas: the trail as pixels, and the turtles as shapes above it.

import { element } from "./svg.js";

const SIDE_M = 11.088889122009277;
const PIXELS_PER_M = 45;
const UNITS = 5000;
const SHELLS = ["#2f7d32", "#8a4b08", "#6a1b9a", "#00695c", "#ad1457", "#37474f", "#9e6a00", "#1b5e9b"];
const SKINS = ["#7cc576", "#e0a85c", "#c58be0", "#6cc7b8", "#ee8fb3", "#a9b8c0", "#e6cf6a", "#86bdf0"];

function shape(number) {
  const shell = SHELLS[number % SHELLS.length];
  const skin = { fill: SKINS[number % SKINS.length], stroke: "#ffffff", "stroke-width": 1 };
  const legs = [[-9, -12], [-9, 12], [9, -12], [9, 12]]
    .map(([cx, cy]) => element("ellipse", { cx, cy, rx: 5, ry: 4, ...skin }));
  const eyes = [-2, 2].map((cy) => element("circle", { cx: 21, cy, r: 1.2, fill: "#101a30" }));
  return element("g", {},
    element("path", { d: "M-21 0 L-14-2.5 L-14 2.5Z", ...skin }),
    ...legs,
    element("ellipse", { cx: 19, cy: 0, rx: 6, ry: 5, ...skin }),
    ...eyes,
    element("ellipse", { rx: 15, ry: 12, fill: shell, stroke: "#ffffff", "stroke-width": 1.5 }),
    element("path", { d: "M-6-7 L5-7 L10 0 L5 7 L-6 7 L-10 0Z", fill: "none", stroke: skin.fill, "stroke-width": 1.5 }));
}

export class Stage {
  constructor(sea, canvas, svg) {
    this.sea = sea;
    this.svg = svg;
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.shown = new Map();
    this.wiped = 0;
  }

  // Redraw everything: the image of the older trail, and the strokes above it.
  trail({ picture, strokes }) {
    const turn = ++this.wiped;
    this.pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.draw(strokes);
    if (!picture) return;
    const below = new Image();
    below.addEventListener("load", () => {
      if (turn !== this.wiped) return;
      // The image loads after the strokes, but is drawn below them.
      this.pen.globalCompositeOperation = "destination-over";
      this.pen.imageSmoothingEnabled = false;
      this.pen.drawImage(below, 0, 0, this.canvas.width, this.canvas.height);
      this.pen.globalCompositeOperation = "source-over";
    });
    below.src = `data:image/png;base64,${picture}`;
  }

  // Draw strokes. Each stroke is an array of red, green, blue, width, and the x, y of its points.
  draw(strokes) {
    const scale = this.canvas.width / UNITS;
    const pen = this.pen;
    pen.lineCap = pen.lineJoin = "round";
    for (const [red, green, blue, width, ...points] of strokes) {
      pen.strokeStyle = `rgb(${red} ${green} ${blue})`;
      pen.lineWidth = width * 10 * scale;
      pen.beginPath();
      pen.moveTo(points[0] * scale, points[1] * scale);
      for (let at = 2; at < points.length; at += 2) pen.lineTo(points[at] * scale, points[at + 1] * scale);
      pen.stroke();
    }
  }

  background([red, green, blue]) {
    this.sea.style.backgroundColor = `rgb(${red} ${green} ${blue})`;
  }

  turtles(all) {
    for (const [name, group] of this.shown) {
      if (!(name in all)) {
        group.remove();
        this.shown.delete(name);
      }
    }
    const several = Object.keys(all).length > 1;
    for (const [name, [x, y, theta]] of Object.entries(all)) {
      let group = this.shown.get(name);
      if (!group) {
        // turtle1 is green, turtle2 is brown, and so on. Other names also have a fixed colour.
        const number = Number(/^turtle(\d+)$/.exec(name)?.[1] ?? [...name].reduce((sum, char) => sum + char.codePointAt(0), 0)) - 1;
        const label = element("text", { y: 34, "text-anchor": "middle", class: "turtle-name" }, name);
        group = element("g", { class: "turtle", "data-name": name }, shape(Math.max(number, 0)), label);
        this.svg.append(group);
        this.shown.set(name, group);
      }
      const known = x !== null && y !== null && theta !== null;
      group.setAttribute("visibility", known ? "visible" : "hidden");
      group.lastChild.setAttribute("visibility", several && known ? "visible" : "hidden");
      if (!known) continue;
      group.setAttribute("transform", `translate(${x * PIXELS_PER_M} ${(SIDE_M - y) * PIXELS_PER_M})`);
      group.firstChild.setAttribute("transform", `rotate(${-theta * 180 / Math.PI})`);
    }
  }
}
