// The connection to the server: it tries again until it succeeds, and reports when the page is hidden or shown.

const AGAIN_MS = 700;

export class Link {
  constructor({ news, up, down }) {
    this.news = news;
    this.up = up;
    this.down = down;
    this.socket = null;
    document.addEventListener("visibilitychange", () => this.wake());
    window.addEventListener("pageshow", () => this.wake());
    window.addEventListener("focus", () => this.wake());
    window.addEventListener("hashchange", () => this.socket?.close());
    this.awake = null;
    this.open();
  }

  open() {
    const token = encodeURIComponent(location.hash.slice(1));
    const socket = new WebSocket(`ws://${location.host}/live?token=${token}`);
    this.socket = socket;
    let opened = false;
    socket.addEventListener("open", () => {
      opened = true;
      this.awake = true;
      this.up();
      this.wake();
    });
    socket.addEventListener("message", (event) => {
      const news = JSON.parse(event.data);
      // The page was opened with a code, which works only once: put the token into the address for the next time.
      if (news.kind === "token") history.replaceState(null, "", `#${news.token}`);
      else this.news(news);
    });
    socket.addEventListener("close", async () => {
      this.down(!opened && await refused());
      setTimeout(() => this.open(), AGAIN_MS);
    });
  }

  // A hidden page gets no news, and everything at once when it is shown again.
  wake() {
    const awake = document.visibilityState === "visible";
    if (awake === this.awake) return;
    this.awake = awake;
    this.send({ awake });
  }

  send(said) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(said));
  }
}

// Whether the server is running, so that the address is wrong.
async function refused() {
  try {
    return (await fetch("/turtle.svg", { cache: "no-store" })).ok;
  } catch {
    return false;
  }
}
