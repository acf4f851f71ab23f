// The keys that drive, on the keyboard and as buttons on the page. The page sends the held keys repeatedly until they
// are released. The server releases the keys of a page that stops sending.

const AGAIN_MS = 100;
const ARROWS = { ArrowUp: "up", ArrowDown: "down", ArrowLeft: "left", ArrowRight: "right" };
const LETTERS = new Set("gtredcvbf");

export class Keys {
  // Only keys that are pressed inside the element `within` count.
  constructor({ held, press, within = document }) {
    this.said = held;
    this.press = press;
    this.down = new Set();
    this.timer = null;
    within.addEventListener("keydown", (event) => this.key(event, true));
    document.addEventListener("keyup", (event) => this.key(event, false));
    window.addEventListener("blur", () => this.release());
    document.addEventListener("visibilitychange", () => this.release());
    for (const button of document.querySelectorAll("[data-key]")) this.hold(button, button.dataset.key);
    for (const button of document.querySelectorAll("[data-press]")) {
      button.addEventListener("click", () => this.press(button.dataset.press));
    }
  }

  key(event, down) {
    const arrow = ARROWS[event.key];
    if (arrow && !down) this.set(arrow, false);
    if (document.body.classList.contains("graph-only")) return; // there is no turtle, so the arrow keys scroll
    // Ignore keys in input fields, and shortcuts.
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.closest?.("select, input, textarea")) return;
    if (arrow) {
      event.preventDefault();
      if (down) this.set(arrow, true);
    } else if (down && !event.repeat && LETTERS.has(event.key.toLowerCase())) {
      this.press(event.key.toLowerCase());
    }
  }

  hold(button, arrow) {
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      this.set(arrow, true);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) {
      button.addEventListener(end, () => this.set(arrow, false));
    }
    const chosen = (event) => event.key === " " || event.key === "Enter";
    button.addEventListener("keydown", (event) => chosen(event) && this.set(arrow, true));
    button.addEventListener("keyup", (event) => chosen(event) && this.set(arrow, false));
  }

  set(arrow, down) {
    if (this.down.has(arrow) === down) return;
    if (down) this.down.add(arrow); else this.down.delete(arrow);
    this.tell();
  }

  release() {
    if (this.down.size === 0) return;
    this.down.clear();
    this.tell();
  }

  tell() {
    clearInterval(this.timer);
    this.said([...this.down]);
    if (this.down.size) this.timer = setInterval(() => this.said([...this.down]), AGAIN_MS);
    for (const button of document.querySelectorAll("[data-key]")) {
      button.classList.toggle("pressed", this.down.has(button.dataset.key));
    }
  }
}
