// The connection to the server: it tries again until it succeeds, and reports when the page is hidden or shown.

const AGAIN_MS = 700;

// The address of a page ends with # and the token.
const inAddress = {
  read: () => location.hash.slice(1),
  keep: (token) => history.replaceState(null, "", `#${token}`),
};

// `path` is the connection's place on the server; `probe` is a file that the server has if it is the right one.
export class Link {
  constructor({ news, up, down, path = "/live", token = inAddress, probe = "/turtle.svg" }) {
    this.news = news;
    this.up = up;
    this.down = down;
    this.path = path;
    this.token = token;
    this.probe = probe;
    this.closed = false;
    this.socket = null;
    document.addEventListener("visibilitychange", () => this.wake());
    window.addEventListener("pageshow", () => this.wake());
    window.addEventListener("focus", () => this.wake());
    window.addEventListener("hashchange", () => this.socket?.close());
    this.awake = null;
    this.open();
  }

  open() {
    const token = encodeURIComponent(this.token.read());
    const socket = new WebSocket(`ws://${location.host}${this.path}?token=${token}`);
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
      if (news.kind === "token") this.token.keep(news.token);
      else this.news(news);
    });
    socket.addEventListener("close", async () => {
      if (this.closed) return;
      this.down(!opened && await refused(this.probe));
      setTimeout(() => this.closed || this.open(), AGAIN_MS);
    });
  }

  // Close the connection for good.
  close() {
    this.closed = true;
    this.socket.close();
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
async function refused(probe) {
  try {
    return (await fetch(probe, { cache: "no-store" })).ok;
  } catch {
    return false;
  }
}
