// Messages, in which text between backticks is code.

// Return the message as nodes.
export function withCode(text) {
  return text.split(/`([^`]+)`/).map((part, index) => {
    if (index % 2 === 0) return part;
    const code = document.createElement("code");
    code.textContent = part;
    return code;
  });
}

// Show the message in the element, unless it is shown already.
export function showText(element, text) {
  if (element.told === text) return;
  element.told = text;
  element.replaceChildren(...withCode(text));
}
