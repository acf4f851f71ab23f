// The log messages of all nodes, from /rosout, in the format of ros2.

const MOST = 200;

export class LogLines {
  constructor(place) {
    this.place = place;
    this.lines = [];
  }

  whole(lines) {
    this.lines = [];
    this.add(lines);
  }

  // Keep the last line visible unless the reader has scrolled up.
  add(lines) {
    this.lines = [...this.lines, ...lines].slice(-MOST);
    const below = this.place.scrollTop + this.place.clientHeight >= this.place.scrollHeight - 4;
    const text = this.lines.map((line) => `[${line.level.toUpperCase()}] [${line.node}]: ${line.text}`).join("\n");
    this.place.textContent = text || "No node has logged anything yet.";
    if (below) this.place.scrollTop = this.place.scrollHeight;
  }
}
