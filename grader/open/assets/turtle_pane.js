// The turtle pane: start and stop turtlesim and the learner's node, drive, and run ros2.

import { showText } from "./code_text.js";
import { Link } from "./link.js";
import { LogLines } from "./log_lines.js";
import { act } from "./requests.js";
import { session } from "./session.js";
import { Simulator } from "./simulator.js";

const find = (id) => document.getElementById(id);

export class TurtlePane {
  constructor(pane) {
    this.link = null;
    this.refused = "";
    this.running = { turtlesim: false, node: false };
    this.simulator = new Simulator({ send: (said) => this.link?.send(said), within: pane });
    this.log = new LogLines(find("rosout"));
    this.status = find("sim-status");
    find("sim-switch").addEventListener("click", () => this.change("turtlesim", { on: !this.running.turtlesim }));
    find("node-switch").addEventListener("click", () => this.change("node",
      { on: !this.running.node, executable: find("executable").value }));
    find("ask").addEventListener("submit", (event) => {
      event.preventDefault();
      this.ask(find("question").value);
    });
  }

  async change(name, wanted) {
    const { problem } = await act(name, wanted);
    this.refused = problem ?? "";
    if (problem) showText(this.status, problem);
  }

  show({ programs, executables }) {
    this.running = programs;
    showText(find("sim-switch"), programs.turtlesim ? "Stop turtlesim" : "Start turtlesim");
    showText(find("node-switch"), programs.node ? "Stop it" : "Run it");
    find("node-buttons").hidden = executables.length === 0 && !programs.node;
    this.choose(executables);
    find("node-part").hidden = programs.lines.length === 0;
    this.lines(programs.lines.join("\n"));
    if (programs.turtlesim && !this.link) this.connect();
    if (!programs.turtlesim && this.link) this.disconnect();
    if (!this.link) showText(this.status, programs.problem || this.refused || "No turtlesim was started here.");
  }

  choose(names) {
    const select = find("executable");
    const shown = [...select.options].map((option) => option.value);
    if (JSON.stringify(shown) === JSON.stringify(names)) return;
    const before = select.value;
    select.replaceChildren(...names.map((name) => new Option(name, name, false, name === before)));
  }

  // Keep the last line visible unless the reader has scrolled up.
  lines(text) {
    const place = find("node-lines");
    if (place.textContent === text) return;
    const below = place.scrollTop + place.clientHeight >= place.scrollHeight - 4;
    place.textContent = text;
    if (below) place.scrollTop = place.scrollHeight;
  }

  connect() {
    showText(this.status, "turtlesim is starting.");
    this.link = new Link({
      news: (news) => {
        find("live").hidden = false;
        showText(this.status, "turtlesim is running.");
        this.simulator.show(news);
        if (news.log && news.kind === "all") this.log.whole(news.log);
        else if (news.log) this.log.add(news.log);
      },
      up: () => this.link.send({ log: true }),
      down: () => {},
      path: "/turtle",
      token: session,
      probe: "/assets/book.js",
    });
  }

  disconnect() {
    this.link.close();
    this.link = null;
    find("live").hidden = true;
  }

  async ask(text) {
    const place = find("asked");
    place.hidden = false;
    place.textContent = "Asking …";
    const { problem, command, output, stopped } = await act("ask", { text });
    place.textContent = problem ?? `$ ${command}\n${output}${stopped ? "\n(The command was stopped, because it did not end.)" : ""}`;
    place.scrollIntoView({ block: "nearest" });
  }
}
