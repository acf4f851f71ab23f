// A copy button for each block of code. For a terminal, the button copies only the commands, not the output. A terminal
// without commands has no button.

const SHOWN_MS = 2000;

export function textOf(block) {
  const typed = [...block.querySelectorAll("kbd")].map((each) => each.textContent);
  if (block.classList.contains("console")) return typed.join("\n");
  return block.querySelector("code").textContent;
}

export function addCopyButtons(root) {
  // Browsers allow the clipboard only for pages from this machine or over https.
  if (!navigator.clipboard) return;
  for (const block of root.querySelectorAll(".code")) {
    if (!textOf(block)) continue;
    const button = document.createElement("button");
    button.type = "button";
    button.className = "copy";
    button.textContent = "Copy";
    button.setAttribute("aria-label", block.classList.contains("console") ? (block.querySelectorAll("kbd").length > 1 ? "Copy the commands" : "Copy the command") : "Copy the code");
    button.addEventListener("click", async () => {
      try {
        await navigator.clipboard.writeText(textOf(block));
        button.textContent = "Copied";
      } catch {
        button.textContent = "Not allowed";
      }
      setTimeout(() => { button.textContent = "Copy"; }, SHOWN_MS);
    });
    block.prepend(button);
  }
}
