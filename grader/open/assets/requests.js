// Requests to the server, with the token in a header that pages of other sites cannot send.

import { session } from "./session.js";

const HEADER = "X-Course-Token";

// Return the response, or { problem } with a message.
export async function act(name, wanted = {}) {
  try {
    const answer = await fetch(`/do/${name}`, {
      method: "POST",
      headers: { [HEADER]: session.read(), "Content-Type": "application/json" },
      body: JSON.stringify(wanted),
    });
    return await answer.json();
  } catch {
    return { problem: "The server does not respond. Check that grader open is still running." };
  }
}

// Return a part of the page as a document, in which scripts do not run, or null if it cannot be loaded.
export function fragment(path) {
  return new Promise((resolve) => {
    const request = new XMLHttpRequest();
    request.open("GET", path);
    request.responseType = "document";
    request.setRequestHeader(HEADER, session.read());
    request.addEventListener("load", () => resolve(request.status === 200 ? request.responseXML : null));
    request.addEventListener("error", () => resolve(null));
    request.send();
  });
}
