// The token that this page shows to the server. It comes in the address after #, is kept for this tab, and is
// shared with other tabs of the same address, so that a lesson can be opened in a new tab.

const NAME = "token";
const channel = new BroadcastChannel("course-token");
const waiting = new Set();

function fromAddress() {
  const found = /^#([\w-]{22})$/.exec(location.hash);
  // The address of a section ends with # and its name.
  if (!found || document.getElementById(found[1])) return null;
  // The address stays free for the anchors of the lesson.
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

// Call `then` when another tab has told the token.
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

// A code from the address works only once, so it is not told to others: the server answers with the token.
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
