// The last log messages of all nodes, from /rosout, in the format of ros2, but without the time.

import { Tail } from "./tail.js";

const MOST = 200;

export class LogLines {
  constructor(place) {
    this.tail = new Tail(place);
    this.lines = [];
  }

  whole(lines) {
    this.lines = [];
    this.add(lines);
  }

  add(lines) {
    this.lines = [...this.lines, ...lines].slice(-MOST);
    const text = this.lines.map((line) => `[${line.level.toUpperCase()}] [${line.node}]: ${line.text}`).join("\n");
    this.tail.write(text || "No log message has arrived yet.");
  }
}
