// The state of the lesson's step: new, started, passed or current, and the button that makes it the current step.

import { showText } from "./code_text.js";
import { addCopyButtons } from "./copy.js";
import { act } from "./requests.js";

function paragraph(text, name = "") {
  const made = document.createElement("p");
  made.className = name;
  showText(made, text);
  return made;
}

function button(text, click) {
  const made = document.createElement("button");
  made.type = "button";
  made.className = "main-button";
  made.textContent = text;
  made.addEventListener("click", async () => {
    made.disabled = true;
    await click();
    made.disabled = false;
  });
  return made;
}

// Return a box with the lines or the task that the learner has to add to a package file for this step.
function lacking({ file, lines, text }) {
  const box = document.createElement("div");
  box.className = "box";
  box.append(paragraph(text.replace(file, `\`${file}\``)));
  if (!lines.length) return box;
  const code = document.createElement("code");
  code.textContent = lines.join("\n");
  const block = document.createElement("pre");
  block.tabIndex = 0;
  block.setAttribute("role", "group");
  block.setAttribute("aria-label", `Lines for ${file}`);
  block.append(code);
  const frame = document.createElement("div");
  frame.className = "code";
  frame.append(block);
  box.append(frame);
  addCopyButtons(box);
  return box;
}

export class Task {
  constructor(place, step) {
    this.place = place;
    this.step = step;
    this.told = null;
    this.problem = "";
  }

  show(state) {
    const step = state.steps.find((each) => each.id === this.step);
    const here = state.exercise === this.step;
    const text = JSON.stringify([step, here, here && [state.folder, state.lacking], this.problem]);
    if (!step || text === this.told) return;
    this.told = text;
    const parts = [];
    if (here) {
      parts.push(paragraph("Edit the files in this folder in your own editor. Each save is graded:"), this.folder(state.folder),
        ...state.lacking.map(lacking));
    } else if (step.state === "new") {
      parts.push(paragraph("You can read the lesson first. Starting the step adds its files to your workspace."),
        button("Start this step", () => this.start()));
    } else {
      parts.push(paragraph(step.state === "passed" ? "You have passed this step." : "You have started this step."),
        button("Grade this step", () => this.start()));
    }
    if (this.problem) parts.push(paragraph(this.problem, "box failed"));
    this.place.replaceChildren(...parts);
  }

  folder(path) {
    const link = document.createElement("a");
    link.href = `vscode://file${path.split("/").map(encodeURIComponent).join("/")}`;
    link.textContent = path;
    const made = paragraph("", "folder");
    made.append(link);
    return made;
  }

  async start() {
    const { problem } = await act("start", { step: this.step });
    this.problem = problem ?? "";
    if (problem) this.place.append(paragraph(problem, "box failed"));
  }
}
