// The functions of a page of the book that need a script: copy code, interactive figures, search, and open the lists on
// a wide screen.
// Without the script, the page can still be read.

import { addCopyButtons } from "./copy.js";
import { addFigures } from "./figures.js";
import { addSearch } from "./search.js";

const WIDE = "(min-width: 62rem)";

// On a wide screen, the lists of steps and sections are open. On a narrow screen, the reader opens them. Beside other
// panes, only the list of steps is open.
function unfold() {
  const beside = document.body.classList.contains("desk");
  const wide = window.matchMedia(WIDE);
  const set = () => {
    for (const each of document.querySelectorAll(beside ? ".steps details" : "details.fold")) each.open = wide.matches;
  };
  wide.addEventListener("change", set);
  set();
}

unfold();
addCopyButtons(document);
addFigures(document);
addSearch(document.querySelector(".search"), document.body.dataset.root);
