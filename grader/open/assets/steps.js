// The progress in the list of all steps.

const SIGNS = { passed: "✓", begun: "→", new: "" };
const WORDS = { passed: "passed; your best result", begun: "started; your best result", new: "" };

export function showSteps(steps) {
  for (const { id, state, current, points, max } of steps) {
    for (const item of document.querySelectorAll(`[data-step="${CSS.escape(id)}"]`)) {
      if (item === document.body) continue;
      let sign = item.querySelector(".progress");
      if (!sign) {
        sign = document.createElement("span");
        sign.className = "progress";
        item.querySelector("a").append(sign);
      }
      const text = max ? `${SIGNS[state]} ${points}/${max}` : SIGNS[state];
      if (sign.textContent !== text) {
        sign.textContent = text;
        sign.title = WORDS[state];
      }
      item.dataset.state = state;
      item.classList.toggle("current", current);
    }
  }
}
