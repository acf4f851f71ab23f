// What a page of the book can do with a script: copy code, search, and open the lists on a wide screen.
// Without the script, the page can still be read.

import { addCopyButtons } from "./copy.js";
import { addSearch } from "./search.js";

const WIDE = "(min-width: 62rem)";

// A wide screen has room for the lists of steps and sections; on a narrow one, the reader opens them.
function unfold() {
  const wide = window.matchMedia(WIDE);
  const set = () => {
    for (const each of document.querySelectorAll("details.fold")) each.open = wide.matches;
  };
  wide.addEventListener("change", set);
  set();
}

unfold();
addCopyButtons(document);
addSearch(document.querySelector(".search"), document.body.dataset.root);
