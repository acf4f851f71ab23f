// The token that this page sends to the server. The address contains the token after #, or a code that the server
// replaces by the token. The token is stored for this tab, and is shared with other tabs of the same address, so that
// a lesson can be opened in a new tab.

const NAME = "token";
const channel = new BroadcastChannel("course-token");
const waiting = new Set();

function fromAddress() {
  const found = /^#([\w-]{22})$/.exec(location.hash);
  // The address of a section also ends with # and a name.
  if (!found || document.getElementById(found[1])) return null;
  // Remove the token, because the links to sections of the lesson use the same part of the address.
  history.replaceState(null, "", location.pathname);
  return found[1];
}

export function read() {
  return sessionStorage.getItem(NAME) ?? "";
}

export function keep(token) {
  sessionStorage.setItem(NAME, token);
  channel.postMessage({ token });
  for (const each of waiting) each();
}

// Ask the other tabs for the token. Call `then` whenever this tab gets a token from another tab or from the server.
export function ask(then) {
  waiting.add(then);
  channel.postMessage({ ask: true });
}

channel.addEventListener("message", ({ data }) => {
  if (data.ask && known) channel.postMessage({ token: read() });
  if (data.token && data.token !== read()) {
    sessionStorage.setItem(NAME, data.token);
    for (const each of waiting) each();
  }
});

// A code from the address works only once, so it is not sent to other tabs. The server responds with the token.
let known = read() !== "";
const given = fromAddress();
if (given) sessionStorage.setItem(NAME, given);

export const session = {
  read,
  keep(token) {
    known = true;
    keep(token);
  },
};
