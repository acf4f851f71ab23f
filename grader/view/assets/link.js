// The connection to the server. A lost connection is restored automatically. The page reports to the server when it is
// hidden or shown.

const AGAIN_MS = 700;

// The address of a page ends with # and the token.
const inAddress = {
  read: () => location.hash.slice(1),
  keep: (token) => history.replaceState(null, "", `#${token}`),
};

// `path` is the path of the connection on the server. `probe` is a file that only the right server has.
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
    this.unsent = [];
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
      for (const said of this.unsent.splice(0)) this.send(said);
    });
    socket.addEventListener("message", (event) => {
      const news = JSON.parse(event.data);
      // The page was opened with a code that works only once. Put the token into the address for later connections.
      if (news.kind === "token") this.token.keep(news.token);
      else this.news(news);
    });
    socket.addEventListener("close", async () => {
      if (this.closed) return;
      this.down(!opened && await refused(this.probe));
      setTimeout(() => this.closed || this.open(), AGAIN_MS);
    });
  }

  // Close the connection permanently.
  close() {
    this.closed = true;
    this.socket.close();
  }

  // A hidden page gets no updates. When it is shown again, it gets the whole state.
  wake() {
    const awake = document.visibilityState === "visible";
    if (awake === this.awake) return;
    this.awake = awake;
    this.send({ awake });
  }

  // Without a connection, a message is lost, such as a key that has long been released when the page connects again.
  send(said) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(said));
  }

  // Send a request as soon as there is a connection.
  request(said) {
    if (this.socket.readyState === WebSocket.OPEN) this.send(said);
    else this.unsent.push(said);
  }
}

// Return whether the server is running. In that case, the address is wrong.
async function refused(probe) {
  try {
    return (await fetch(probe, { cache: "no-store" })).ok;
  } catch {
    return false;
  }
}
