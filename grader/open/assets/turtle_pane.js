// The turtle pane: start and stop turtlesim and the learner's node, drive, and run ros2.

import { showText } from "./code_text.js";
import { Link } from "./link.js";
import { LogLines } from "./log_lines.js";
import { act } from "./requests.js";
import { session } from "./session.js";
import { Simulator } from "./simulator.js";
import { Tail } from "./tail.js";

const find = (id) => document.getElementById(id);

export class TurtlePane {
  constructor(pane) {
    this.link = null;
    this.refused = "";
    this.running = { turtlesim: false, node: false };
    this.simulator = new Simulator({ send: (said) => this.link?.send(said), within: pane });
    this.log = new LogLines(find("rosout"));
    this.output = new Tail(find("node-lines"));
    this.status = find("sim-status");
    find("sim-switch").addEventListener("click", () => this.change("turtlesim", { on: !this.running.turtlesim }));
    find("node-switch").addEventListener("click", () => this.change("node",
      { on: !this.running.node, executable: find("executable").value }));
    find("again").addEventListener("click", () => this.change("node",
      { on: true, again: true, executable: find("executable").value }));
    find("ask").addEventListener("submit", (event) => {
      event.preventDefault();
      this.ask(find("question").value);
    });
  }

  async change(name, wanted) {
    const { problem } = await act(name, wanted);
    this.refused = problem ?? "";
    if (this.state) this.show(this.state);
  }

  show(state) {
    const { programs, executables } = this.state = state;
    this.running = programs;
    showText(find("sim-switch"), programs.turtlesim ? "Stop turtlesim" : "Start turtlesim");
    showText(find("node-switch"), programs.node ? "Stop it" : "Run it");
    find("node-buttons").hidden = executables.length === 0 && !programs.node;
    this.choose(executables);
    for (const name of ["sim-switch", "node-switch", "again"]) find(name).disabled = programs.busy;
    find("node-part").hidden = programs.lines.length === 0 || find("node-buttons").hidden;
    find("old").hidden = !programs.old;
    this.output.write(programs.lines.join("\n"));
    if (programs.turtlesim && !this.link) this.connect();
    if (!programs.turtlesim && this.link) this.disconnect();
    this.tell();
  }

  // Show what the programs do, or why they do not run.
  tell() {
    const { programs } = this.state;
    const now = this.link ? (this.drawn ? "turtlesim is running." : "turtlesim is starting.") : "No turtlesim of this page is running.";
    const doing = programs.doing && `${programs.doing} …`;
    showText(this.status, doing || this.refused || programs.problem || now);
  }

  choose(names) {
    const select = find("executable");
    const shown = [...select.options].map((option) => option.value);
    if (JSON.stringify(shown) === JSON.stringify(names)) return;
    const before = select.value;
    select.replaceChildren(...names.map((name) => new Option(name, name, false, name === before)));
  }

  connect() {
    this.drawn = false;
    this.link = new Link({
      news: (news) => {
        this.simulator.show(news);
        if (!this.drawn && news.turtles) {
          this.drawn = true;
          this.live(true);
          this.tell();
        }
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
    this.live(false);
  }

  live(on) {
    for (const part of document.querySelectorAll("[data-live]")) part.hidden = !on;
  }

  async ask(text) {
    const place = find("asked");
    place.hidden = false;
    place.textContent = "Asking …";
    const answer = this.awaited = act("ask", { text });
    const { problem, command, output, stopped } = await answer;
    if (this.awaited !== answer) return; // another question was asked in the meantime
    place.textContent = problem ?? `$ ${command}\n${output}${stopped ? "\n(The command was stopped, because it did not end.)" : ""}`;
    place.scrollIntoView({ block: "nearest" });
  }
}
