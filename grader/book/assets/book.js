// What a page of the book can do with a script: copy code, search, and open the lists on a wide screen.
// Without the script, the page can still be read.

import { addCopyButtons } from "./copy.js";
import { addFigures } from "./figures.js";
import { addSearch } from "./search.js";

const WIDE = "(min-width: 62rem)";

// A wide screen has room for the lists of steps and sections; on a narrow one, the reader opens them. Beside other
// panes, there is room for the steps only.
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
