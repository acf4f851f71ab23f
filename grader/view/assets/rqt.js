// The page of rqt, rqt_console and rqt_plot: it passes the server's updates to the visible parts.

import { Console } from "./console.js";
import { Graph } from "./graph.js";
import { Link } from "./link.js";
import { Plot } from "./plot.js";
import { Services } from "./services.js";
import { Topics } from "./topics.js";

const find = (id) => document.getElementById(id);
const [status, notice, hold] = ["status", "notice", "hold"].map(find);

const graph = new Graph(find("graph"));
const topics = new Topics(find("topics"));
const plot = new Plot({ place: find("plot"), table: find("series"), remove: (name) => link.request({ unplot: name }),
  empty: "No field is plotted. Type a field above, such as /turtle1/pose/x, and press Add." });
const log = new Console({ table: find("log").querySelector("table"), place: find("log"), count: find("count"),
  levels: find("levels"), node: find("node"), text: find("text"), pause: find("still"), clear: find("forget") });
const services = new Services({ form: find("call"), service: find("service"), type: find("type"), request: find("request"),
  response: find("response"), status: find("answered"), call: (call) => link.request({ call }) });

function say(text, kind, problem = "") {
  if (status.textContent !== text) status.textContent = text;
  status.className = `status ${kind}`;
  notice.hidden = !problem;
  notice.textContent = problem;
}

function arrange(parts) {
  for (const section of document.querySelectorAll("[data-part]")) section.hidden = !parts.includes(section.dataset.part);
  find("main").classList.toggle("several", parts.length > 1);
}

function hear(news) {
  if (news.kind === "all") {
    arrange(news.parts);
    find("domain").textContent = news.domain;
    log.whole(news.log);
  } else if (news.log) {
    log.add(news.log);
  }
  if (news.graph) graph.show(news.graph);
  if (news.topics) {
    topics.show(news.topics);
    graph.flow(new Set(news.topics.filter((topic) => topic.hertz !== null).map((topic) => topic.name)));
  }
  if (news.plot) plot.show(news.plot);
  if (news.services) services.show(news.services);
  if (news.answer) services.answer(news.answer);
}

function lost(refused) {
  if (refused) say("Wrong address", "ends", "This is not the address of the running command. Open the address that the command has printed.");
  else say("Not connected", "ends", "This page has no connection to the command. If the command has stopped, start it "
    + "again. This page then continues.");
}

const link = new Link({ news: hear, up: () => say("Live", "runs"), down: lost });

find("add").addEventListener("submit", (event) => {
  event.preventDefault();
  link.request({ plot: find("field").value.trim() });
  find("field").value = "";
});
find("window").addEventListener("change", (event) => { plot.window_s = Number(event.target.value); plot.draw(); });
hold.addEventListener("click", () => {
  plot.held = !plot.held;
  hold.textContent = plot.held ? "Resume" : "Pause";
  hold.setAttribute("aria-pressed", String(plot.held));
  if (!plot.held) plot.draw();
});
