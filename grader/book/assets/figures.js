// Figures that the reader changes with sliders. The function `draw` of a figure takes the values of the sliders, and
// returns shapes and a text that describes them.

import { drive, errors, SIDE_M, START, toWorld } from "./motion.js";
import { element } from "./svg.js";

const PIXELS_PER_M = 45;
const GOAL = { x: 8.5, y: 2.5 };
const AHEAD = 2;
const LEFT = 1;

const px = (x) => x * PIXELS_PER_M;
const py = (y) => (SIDE_M - y) * PIXELS_PER_M;
const said = (value, digits = 2) => (Object.is(Number(value.toFixed(digits)), -0) ? 0 : value).toFixed(digits);
const line = (from, to, kind) => ["line", { x1: px(from.x), y1: py(from.y), x2: px(to.x), y2: py(to.y), class: kind }];
const dot = (at, kind) => ["circle", { cx: px(at.x), cy: py(at.y), r: 7, class: kind }];

function turtle({ x, y, theta }) {
  const degrees = -theta * 180 / Math.PI;
  return ["path", { d: "M22 0L-14-14L-7 0L-14 14Z", class: "turtle", transform: `translate(${px(x)} ${py(y)}) rotate(${degrees})` }];
}

const pose = [
  { name: "x", label: "x", unit: "m", min: 1, max: 10, step: 0.1, value: 3 },
  { name: "y", label: "y", unit: "m", min: 1, max: 10, step: 0.1, value: 6 },
  { name: "theta", label: "theta", unit: "rad", min: -3.1, max: 3.1, step: 0.1, value: 0.5 },
];

export const FIGURES = {
  circle: {
    title: "Try it: the speeds and the circle",
    sliders: [
      { name: "v", label: "linear.x (v)", unit: "m/s", min: -3, max: 3, step: 0.1, value: 2 },
      { name: "w", label: "angular.z (w)", unit: "rad/s", min: -3, max: 3, step: 0.1, value: 1 },
    ],
    draw({ v, w }) {
      const poses = drive(START, v, w, w === 0 ? 6 : Math.min(2 * Math.PI / Math.abs(w), 30));
      const points = poses.map((each) => `${px(each.x).toFixed(1)},${py(each.y).toFixed(1)}`).join(" ");
      const shapes = [["polyline", { points, class: "trail" }], turtle(START)];
      const wall = poses.some((each) => each.wall) ? " The turtle touches a wall." : "";
      if (v === 0) return { shapes, text: w === 0 ? "The turtle stands still." : "The turtle turns on the spot." };
      if (w === 0) return { shapes, text: `The turtle drives straight ${v > 0 ? "ahead" : "back"}.${wall}` };
      const side = v * w > 0 ? "left" : "right";
      return {
        shapes,
        text: `Radius = |v / w| = ${said(Math.abs(v))} / ${said(Math.abs(w))} = ${said(Math.abs(v / w))} m. `
          + `One turn takes 2π / |w| = ${said(2 * Math.PI / Math.abs(w))} s. The circle is on the turtle's ${side}.`
          + `${v < 0 ? " The turtle drives backwards." : ""}${wall}`,
      };
    },
  },
  radius: {
    title: "Try it: the radius and the turning speed",
    sliders: [
      { name: "radius", label: "radius", unit: "m", min: 0.2, max: 3, step: 0.1, value: 2 },
      { name: "speed", label: "speed", unit: "m/s", min: 0.1, max: 2, step: 0.1, value: 1 },
    ],
    draw({ radius, speed }) {
      const w = speed / radius;
      const poses = drive(START, speed, w, 2 * Math.PI / w);
      const points = poses.map((each) => `${px(each.x).toFixed(1)},${py(each.y).toFixed(1)}`).join(" ");
      return {
        shapes: [["polyline", { points, class: "trail" }], turtle(START)],
        text: `angular.z = speed / radius = ${said(speed)} / ${said(radius)} = ${said(w)} rad/s. `
          + `One turn takes ${said(2 * Math.PI / w)} s.`,
      };
    },
  },
  frames: {
    title: "Try it: the pose, and what the turtle sees",
    sliders: pose,
    draw(at) {
      const ahead = toWorld(at, AHEAD, 0);
      const point = toWorld(at, AHEAD, LEFT);
      const side = toWorld(at, 0, AHEAD);
      return {
        shapes: [line(at, ahead, "axis-x"), line(at, side, "axis-y"), line(ahead, point, "helper"), turtle(at), dot(point, "point")],
        text: `The turtle's pose: x ${said(at.x, 1)} m, y ${said(at.y, 1)} m, theta ${said(at.theta, 1)} rad. `
          + `The dot is ${AHEAD} m ahead of the turtle and ${LEFT} m to its left. In the world, it is at `
          + `x ${said(point.x)} m, y ${said(point.y)} m.`,
      };
    },
  },
  goal: {
    title: "Try it: the two errors",
    sliders: pose,
    draw(at) {
      const { dx, dy, distance, direction, turn } = errors(at, GOAL);
      const ahead = toWorld(at, AHEAD, 0);
      return {
        shapes: [line(at, GOAL, "helper"), line(at, ahead, "axis-x"), turtle(at), dot(GOAL, "point")],
        text: `Distance = hypot(${said(dx)}, ${said(dy)}) = ${said(distance)} m. Direction of the goal = atan2(${said(dy)}, `
          + `${said(dx)}) = ${said(direction)} rad. The turtle has to turn ${said(Math.abs(turn))} rad to the `
          + `${turn >= 0 ? "left" : "right"}.`,
      };
    },
  },
};

function slider({ name, label, unit, min, max, step, value }, change) {
  const input = document.createElement("input");
  Object.assign(input, { type: "range", name, min, max, step, value });
  const shown = document.createElement("output");
  const show = () => {
    shown.textContent = `${Number(input.value).toFixed(1)} ${unit}`;
    input.setAttribute("aria-valuetext", shown.textContent);
  };
  input.addEventListener("input", () => {
    show();
    change();
  });
  show();
  const row = document.createElement("label");
  const text = document.createElement("span");
  text.textContent = label;
  row.append(text, input, shown);
  return row;
}

function add(place, { title, sliders, draw }) {
  const svg = element("svg", { viewBox: "0 0 499 499", "aria-hidden": "true" });
  const text = document.createElement("p");
  text.setAttribute("role", "status");
  const update = () => {
    const values = Object.fromEntries([...place.querySelectorAll("input")].map((each) => [each.name, Number(each.value)]));
    const made = draw(values);
    svg.replaceChildren(...made.shapes.map(([name, attributes]) => element(name, attributes)));
    text.textContent = made.text;
  };
  const heading = document.createElement("figcaption");
  heading.textContent = title;
  const controls = document.createElement("div");
  controls.className = "sliders";
  controls.append(...sliders.map((each) => slider(each, update)), text);
  place.append(heading, svg, controls);
  place.hidden = false;
  update();
}

export function addFigures(root) {
  for (const place of root.querySelectorAll("[data-figure]")) {
    const figure = FIGURES[place.dataset.figure];
    if (figure) add(place, figure);
  }
}
