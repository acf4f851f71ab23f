// The verdict: its line, failed checks, errors and advice, and the trajectory with its player.

import { showText } from "./code_text.js";
import { update } from "./keyed.js";
import { fragment } from "./requests.js";

function adopted(element) {
  return document.importNode(element, true);
}

export class Verdict {
  constructor({ line, doing, details }) {
    this.line = line;
    this.doing = doing;
    this.details = details;
    this.number = null;
    this.loading = null;
  }

  show(state) {
    const text = state.problem || state.line;
    const tone = state.problem ? "failed" : state.tone;
    showText(this.line, text);
    this.line.className = `verdict ${tone}`;
    const doing = state.doing ? `${state.doing.replace(/\.$/, "")} …` : "";
    if (this.doing.textContent !== doing) this.doing.textContent = doing;
    this.dropPassed(state.checks);
    if (state.number !== this.number) this.load(state);
  }

  // Remove the details of checks that pass now. The other details arrive later.
  dropPassed(checks) {
    const passed = new Set(checks.filter((check) => check.kind === "passed").map((check) => check.id));
    for (const each of [...this.details.children]) if (passed.has(each.dataset.key)) each.remove();
  }

  async load(state) {
    this.number = state.number;
    const made = state.line && !state.problem ? await fragment("/verdict") : null;
    // Another verdict may have arrived in the meantime.
    if (this.number !== state.number) return;
    const parts = [...made?.querySelectorAll("[data-key]") ?? []];
    // While the details of a first verdict are being drawn, the response is empty. A new number follows.
    const runs = JSON.parse(made?.getElementById("data")?.textContent ?? "[]");
    const data = (part) => part.dataset.key.startsWith("run-") ? runs[Number(part.dataset.key.slice(4)) - 1] : null;
    update(this.details, parts.map((part) => ({
      key: part.dataset.key,
      text: part.outerHTML + JSON.stringify(data(part)),
      make: () => {
        const element = adopted(part);
        if (data(part)) globalThis.replay(data(part), element.querySelector(".run"));
        return element;
      },
    })));
  }
}
