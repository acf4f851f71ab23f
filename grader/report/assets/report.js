// The page of a submission: one player for each run, and the sections that are opened for printing.
JSON.parse(document.getElementById("data").textContent).forEach(function (run, index) {
  replay(run, document.querySelectorAll(".run")[index]);
});

// For printing, all sections are opened, but logs stay as the reader left them.
(function () {
  var opened = [];
  window.addEventListener("beforeprint", function () {
    opened = Array.prototype.slice.call(document.querySelectorAll("details:not(.log):not([open])"));
    opened.forEach(function (each) { each.open = true; });
  });
  window.addEventListener("afterprint", function () {
    opened.forEach(function (each) { each.open = false; });
  });
})();
