// The page of grader open forwards the server's updates to its parts, and the clicks to the server.

import { showChecks } from "./checks.js";
import { showText, withCode } from "./code_text.js";
import { update } from "./keyed.js";
import { Link } from "./link.js";
import { act } from "./requests.js";
import { ask, session } from "./session.js";
import { showSteps } from "./steps.js";
import { Task } from "./task.js";
import { TurtlePane } from "./turtle_pane.js";
import { Verdict } from "./verdict.js";

const find = (id) => document.getElementById(id);
const step = document.body.dataset.step;
const connection = find("connection");
const desk = step !== undefined;
const verdict = desk && new Verdict({ line: find("verdict-line"), doing: find("doing"), details: find("details") });
const turtle = desk && new TurtlePane(find("turtle-pane"));
const task = desk && new Task(find("task-state"), step);

function say(text, kind) {
  if (connection.textContent !== text) connection.textContent = text;
  connection.className = `connection ${kind}`;
}

function tell(text, tone = "") {
  const answer = find("answer");
  answer.hidden = !text;
  answer.className = `box ${tone}`;
  showText(answer, text);
}

function showHints(state) {
  update(find("hints"), state.hints.map((text, index) => ({
    key: `hint-${index}`,
    text,
    make: () => {
      const item = document.createElement("li");
      item.append(...withCode(text));
      return item;
    },
  })));
  find("hint").disabled = !state.more_hints;
}

// Update the page. The verdict and the hints are those of the current step, even beside the lesson of another step. The
// checks are only shown with the lesson of the current step.
function show(state) {
  if (!state.steps) return;
  showSteps(state.steps);
  if (!desk) return;
  const here = state.exercise === step;
  task.show(state);
  find("verdict-title").textContent = state.exercise ? `Verdict on step ${state.exercise.slice(0, 2)}: ${state.title}` : "Verdict";
  if (!state.exercise) tell("Start a step. Its verdict appears here.");
  else if (find("answer").textContent.startsWith("Start a step")) tell("");
  for (const name of ["hint", "rerun"]) find(name).hidden = !state.exercise;
  find("next").hidden = !state.passed;
  find("checks").hidden = !here;
  showChecks(find("checks"), here ? state.checks : []);
  verdict.show(state);
  showHints(state);
  turtle.show(state);
}

async function next() {
  const answer = await act("start", { step: "next" });
  if (answer.problem) tell(answer.problem);
  else location.href = `/${answer.step}/index.html`;
}

// Let the buttons choose the visible pane. A wide screen also shows the lesson, and a very wide one
// shows all panes.
function addTabs() {
  const buttons = [...document.querySelectorAll("[data-shows]")];
  const choose = (name) => {
    document.body.dataset.pane = name;
    sessionStorage.setItem("pane", name);
    for (const each of buttons) each.setAttribute("aria-pressed", String(each.dataset.shows === name));
  };
  for (const each of buttons) each.addEventListener("click", () => choose(each.dataset.shows));
  const wide = window.matchMedia("(min-width: 62rem)").matches;
  choose(sessionStorage.getItem("pane") ?? (wide ? "verdict" : "lesson"));
}

if (desk) {
  addTabs();
  find("next").addEventListener("click", next);
  find("rerun").addEventListener("click", () => act("rerun").then(({ problem }) => tell(problem ?? "", "failed")));
  find("hint").addEventListener("click", async () => {
    const answer = await act("hint");
    tell(answer.problem ?? "", "failed");
  });
}

function down(refused) {
  if (refused) {
    say("Open the address that grader open has printed", "ends");
  } else {
    say("Not connected: type grader open", "ends");
  }
}

const link = new Link({
  news: show,
  up: () => say("Live", "runs"),
  down,
  token: session,
  probe: "/assets/book.js",
});
ask(() => link.socket?.close());
