// The last command as two arrows: a straight arrow for the linear velocity, a curved arrow for the angular velocity.

import { element } from "./svg.js";

const LASTS_S = 1;
const LONGEST = 62;

function head(x, y, degrees, kind) {
  return element("path", { d: "M0 0l-19-11v22z", class: kind, transform: `translate(${x} ${y}) rotate(${degrees})` });
}

// In the view from above, the turtle faces up: x points up, and y to the left. The length depends on the speed.
function linear(x, y) {
  const speed = Math.hypot(x, y);
  if (!(speed > 0)) return element("circle", { r: 4, class: "linear none" });
  const length = 20 + (LONGEST - 20) * speed / (speed + 1);
  const [toX, toY] = [-y / speed * length, -x / speed * length];
  return element("g", {},
    element("path", { d: `M0 0L${toX * (1 - 14 / length)} ${toY * (1 - 14 / length)}`, class: "linear line" }),
    head(toX, toY, Math.atan2(toY, toX) * 180 / Math.PI, "linear"));
}

function angular(z) {
  if (!(Math.abs(z) > 0)) return element("circle", { r: 4, class: "angular none" });
  const radius = 44;
  const sweep = (40 + 260 * Math.abs(z) / (Math.abs(z) + 2)) * Math.PI / 180;
  const side = z > 0 ? -1 : 1;
  const at = (angle) => [side * radius * Math.sin(angle), -radius * Math.cos(angle)];
  const [x, y] = at(sweep);
  const [lineX, lineY] = at(sweep - 0.3);
  const large = sweep > Math.PI ? 1 : 0;
  return element("g", {},
    element("path", { d: `M0 ${-radius}A${radius} ${radius} 0 ${large} ${side > 0 ? 1 : 0} ${lineX} ${lineY}`,
      class: "angular line" }),
    head(x, y, side * sweep * 180 / Math.PI + (side > 0 ? 0 : 180), "angular"));
}

function said(value, unit) {
  return value === null ? "NaN or infinite" : `${value.toFixed(2)} ${unit}`;
}

function part(title, arrow, rows) {
  const list = document.createElement("dl");
  for (const [name, value] of rows) {
    const row = document.createElement("div");
    const term = document.createElement("dt");
    const told = document.createElement("dd");
    term.textContent = name;
    told.textContent = value;
    row.append(term, told);
    list.append(row);
  }
  const about = `${title}: ${rows.map((row) => row.join(" ")).join(", ")}`;
  const svg = element("svg", { viewBox: "-70 -70 140 140", role: "img", "aria-label": about },
    element("circle", { r: 66, class: "dial" }), arrow);
  const figure = document.createElement("figure");
  figure.append(svg, list);
  return figure;
}

export class Twist {
  constructor(place) {
    this.place = place;
    this.told = null;
  }

  // `command` is the age (s), linear x, y, z (m/s) and angular x, y, z (rad/s) of the command, or undefined.
  show(command, topic) {
    const text = JSON.stringify([topic, command?.slice(1)]);
    if (text !== this.told) {
      this.told = text;
      if (!command) {
        const none = document.createElement("p");
        none.className = "note";
        none.textContent = `No command has arrived on ${topic} yet.`;
        this.place.replaceChildren(none);
      } else {
        const [, x, y, , , , z] = command;
        this.place.replaceChildren(
          part("Linear", linear(x, y), [["linear.x", said(x, "m/s")], ...(y ? [["linear.y", said(y, "m/s")]] : [])]),
          part("Angular", angular(z), [["angular.z", said(z, "rad/s")]]));
      }
    }
    // turtlesim stops the turtle one second after the last command.
    this.place.classList.toggle("old", !command || command[0] > LASTS_S);
  }
}
