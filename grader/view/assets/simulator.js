// The parts of a page that show and drive a simulator: canvas, last command, graph, topics, keys and buttons.

import { Graph } from "./graph.js";
import { Keys } from "./keys.js";
import { Stage } from "./stage.js";
import { Topics } from "./topics.js";
import { Twist } from "./twist.js";

const find = (id) => document.getElementById(id);

function number(value) {
  return value === null ? "NaN or infinite" : value.toFixed(2);
}

export class Simulator {
  // `send` sends a request to the server. Only keys that are pressed inside the element `within` count. `live` is called
  // for each frame, with whether the simulator is paused.
  constructor({ send, within = document, live = () => {} }) {
    this.send = send;
    this.live = live;
    this.stage = new Stage(find("sea"), find("trail"), find("turtles"));
    this.twist = new Twist(find("arrows"));
    this.graph = new Graph(find("graph"));
    this.topics = new Topics(find("topics"));
    this.chosen = find("turtle");
    this.paused = false;
    new Keys({
      held: (held) => this.send({ held, turtle: this.chosen.value }),
      press: (press) => this.send({ press, turtle: this.chosen.value }),
      within,
    });
    find("pause").addEventListener("click", () => this.send({ do: this.paused ? "resume" : "pause" }));
    for (const name of ["clear", "reset"]) find(name).addEventListener("click", () => this.send({ do: name }));
  }

  // Show an update from the server.
  show(news) {
    if (news.turtles) this.frame(news);
    if (news.graph) this.graph.show(news.graph);
    if (news.topics) {
      this.topics.show(news.topics);
      this.graph.flow(new Set(news.topics.filter((topic) => topic.hertz !== null).map((topic) => topic.name)));
    }
  }

  // Show a text in front of the canvas.
  tell(text) {
    const notice = find("notice");
    notice.hidden = !text;
    if (notice.textContent !== text) notice.textContent = text;
  }

  frame(news) {
    if (news.trail) this.stage.trail(news.trail);
    if (news.lines) this.stage.draw(news.lines);
    this.stage.background(news.background);
    this.stage.turtles(news.turtles);
    this.choose(Object.keys(news.turtles));
    const name = this.chosen.value;
    const turtle = news.turtles[name];
    if (turtle) {
      const [x, y, theta] = turtle.map((value) => typeof value === "number" ? value : null);
      find("where").textContent = `${name}: x ${number(x)} m, y ${number(y)} m, heading ${number(theta)} rad`;
      const topic = Object.keys(news.commands).find((each) => each.endsWith(`/${name}/cmd_vel`));
      this.twist.show(topic && news.commands[topic], topic ?? `/${name}/cmd_vel`);
    } else {
      find("where").textContent = "No turtle is on the canvas.";
    }
    if (news.paused !== this.paused) {
      this.paused = news.paused;
      find("pause").textContent = this.paused ? "Resume" : "Pause";
    }
    this.tell(this.paused ? "Paused: the turtles do not move or publish their poses." : "");
    this.live(this.paused);
  }

  choose(names) {
    const shown = [...this.chosen.options].map((option) => option.value);
    if (JSON.stringify(shown) === JSON.stringify(names)) return;
    const before = this.chosen.value || "turtle1";
    this.chosen.replaceChildren(...names.map((name) => new Option(name, name, false, name === before)));
  }
}
