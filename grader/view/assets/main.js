// The page: it passes the server's news to its parts, and the user's keys and buttons to the server.

import { Graph } from "./graph.js";
import { Keys } from "./keys.js";
import { Link } from "./link.js";
import { Stage } from "./stage.js";
import { Topics } from "./topics.js";
import { Twist } from "./twist.js";

const find = (id) => document.getElementById(id);
const stage = new Stage(find("sea"), find("trail"), find("turtles"));
const twist = new Twist(find("arrows"));
const graph = new Graph(find("graph"));
const topics = new Topics(find("topics"));
const [status, notice, pause, chosen, where] = ["status", "notice", "pause", "turtle", "where"].map(find);
let paused = false;

function say(text, kind) {
  if (status.textContent !== text) status.textContent = text;
  status.className = `status ${kind}`;
}

function tell(text) {
  notice.hidden = !text;
  if (notice.textContent !== text) notice.textContent = text;
}

function choose(names) {
  const shown = [...chosen.options].map((option) => option.value);
  if (JSON.stringify(shown) === JSON.stringify(names)) return;
  const before = chosen.value || "turtle1";
  chosen.replaceChildren(...names.map((name) => new Option(name, name, false, name === before)));
}

function number(value) {
  return value === null ? "not a number" : value.toFixed(2);
}

function frame(news) {
  if (news.trail) stage.trail(news.trail);
  if (news.lines) stage.draw(news.lines);
  stage.background(news.background);
  stage.turtles(news.turtles);
  choose(Object.keys(news.turtles));
  const turtle = news.turtles[chosen.value];
  if (turtle) {
    const [x, y, theta] = turtle.map((value) => typeof value === "number" ? value : null);
    where.textContent = `${chosen.value}: x ${number(x)} m, y ${number(y)} m, heading ${number(theta)} rad`;
    const topic = Object.keys(news.commands).find((name) => name.endsWith(`/${chosen.value}/cmd_vel`));
    twist.show(topic && news.commands[topic], topic ?? `/${chosen.value}/cmd_vel`);
  } else {
    where.textContent = "There is no turtle.";
  }
  if (news.paused !== paused) {
    paused = news.paused;
    pause.textContent = paused ? "Resume" : "Pause";
  }
  tell(paused ? "Paused: no turtle moves or publishes its pose." : "");
  say(paused ? "Paused" : "Live", paused ? "waits" : "runs");
}

function hear(news) {
  if (news.kind === "all") {
    document.body.classList.toggle("graph-only", !news.simulator);
    find("domain").textContent = news.domain;
    if (!news.simulator) {
      document.title = "The ROS graph, live";
      find("title").textContent = "The ROS graph";
      say("Live", "runs");
    }
  }
  if (news.turtles) frame(news);
  if (news.graph) graph.show(news.graph);
  if (news.topics) {
    topics.show(news.topics);
    graph.flow(new Set(news.topics.filter((topic) => topic.hertz !== null).map((topic) => topic.name)));
  }
}

function lost(refused) {
  if (refused) {
    say("Wrong address", "ends");
    tell("This is not the address of the running simulator. Open the address that it printed.");
  } else {
    say("Not running", "ends");
    tell("The simulator has ended. When you start it again with --view, this page continues.");
  }
}

const link = new Link({ news: hear, up: () => say("Live", "runs"), down: lost });

new Keys({
  held: (held) => link.send({ held, turtle: chosen.value }),
  press: (press) => link.send({ press, turtle: chosen.value }),
});
pause.addEventListener("click", () => link.send({ do: paused ? "resume" : "pause" }));
for (const name of ["clear", "reset"]) find(name).addEventListener("click", () => link.send({ do: name }));
