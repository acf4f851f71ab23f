// The list of the checks of the step, with their results so far.

import { withCode } from "./code_text.js";
import { update } from "./keyed.js";

const SIGNS = { passed: "✓", failed: "✗", skipped: "–", error: "!", advice: "i", open: "○" };
const WORDS = { passed: "passed", failed: "failed", skipped: "not judged", error: "error", advice: "advice", open: "open" };

function span(name, text) {
  const made = document.createElement("span");
  made.className = name;
  made.textContent = text;
  return made;
}

function item(check) {
  const row = document.createElement("li");
  row.className = check.kind;
  const mark = span(`mark ${check.kind}`, SIGNS[check.kind]);
  mark.setAttribute("aria-hidden", "true");
  const about = document.createElement("div");
  about.append(span("hidden-text", `${WORDS[check.kind]}: `), check.title);
  if (check.max) about.append(" ", span("points", `(${check.points} of ${check.max} points)`));
  if (check.text && check.kind !== "skipped") {
    const observed = span("observed", "");
    observed.append(...withCode(check.text));
    about.append(observed);
  }
  row.append(mark, about);
  return row;
}

export function showChecks(place, checks) {
  update(place, checks.map((check) => ({ key: check.id, text: JSON.stringify(check), make: () => item(check) })));
}
