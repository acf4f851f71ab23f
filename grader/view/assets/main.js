// The page of a simulator: it passes the server's updates to its parts, and the user's input to the server.

import { Link } from "./link.js";
import { Simulator } from "./simulator.js";

const find = (id) => document.getElementById(id);
const status = find("status");

function say(text, kind) {
  if (status.textContent !== text) status.textContent = text;
  status.className = `status ${kind}`;
}

const simulator = new Simulator({
  send: (said) => link.send(said),
  live: (paused) => say(paused ? "Paused" : "Live", paused ? "waits" : "runs"),
});

function hear(news) {
  if (news.kind === "all") {
    document.body.classList.toggle("graph-only", !news.simulator);
    find("domain").textContent = news.domain;
    if (!news.simulator) say("Live", "runs");
  }
  simulator.show(news);
}

function lost(refused) {
  if (refused) {
    say("Wrong address", "ends");
    simulator.tell("This is not the address of the running simulator. Open the address that the simulator has printed.");
  } else {
    say("Not connected", "ends");
    simulator.tell("This page has no connection to the simulator. If the simulator has stopped, start it again with "
      + "--view. This page then continues.");
  }
}

const link = new Link({ news: hear, up: () => say("Live", "runs"), down: lost });
