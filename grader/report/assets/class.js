"use strict";
// Sorts and filters the table, and opens all sections for printing. The page is complete without this script.
(function () {
  var table = document.getElementById("table");
  var body = table.tBodies[0];
  var rows = Array.prototype.slice.call(body.rows);
  var headers = Array.prototype.slice.call(table.tHead.rows[0].cells);
  var name = document.getElementById("name");
  var verdict = document.getElementById("verdict");
  var check = document.getElementById("check");
  var shown = document.getElementById("shown");
  var compare = new Intl.Collator(undefined, { numeric: true, sensitivity: "base" }).compare;

  function value(row, column) {
    var cell = row.cells[column];
    return cell.dataset.value === undefined ? cell.textContent.trim() : Number(cell.dataset.value);
  }

  function sort(column) {
    var header = headers[column];
    var number = header.dataset.sort === "number";
    var now = header.getAttribute("aria-sort");
    // A click on a column in ascending order reverses the order. Otherwise, the column is sorted in ascending order.
    var direction = now === "ascending" ? -1 : 1;
    var keyed = rows.map(function (row, index) { return { row: row, key: value(row, column), index: index }; });
    keyed.sort(function (a, b) {
      var order = number ? a.key - b.key : compare(a.key, b.key);
      return order * direction || a.index - b.index;
    });
    rows = keyed.map(function (each) { return each.row; });
    headers.forEach(function (each) { each.removeAttribute("aria-sort"); });
    header.setAttribute("aria-sort", direction === 1 ? "ascending" : "descending");
    body.append.apply(body, rows);
  }

  function filter() {
    var text = name.value.trim().toLowerCase(), count = 0;
    rows.forEach(function (row) {
      var fits = row.cells[0].textContent.toLowerCase().indexOf(text) >= 0
        && (!verdict.value || row.dataset.verdict === verdict.value)
        && (!check.value || row.dataset.failed.split(" ").indexOf(check.value) >= 0);
      row.hidden = !fits;
      count += fits ? 1 : 0;
    });
    shown.textContent = count + " of " + rows.length + " shown";
  }

  headers.forEach(function (header, column) {
    var button = document.createElement("button");
    button.type = "button";
    button.className = "sort";
    button.textContent = header.textContent;
    button.addEventListener("click", function () { sort(column); });
    header.replaceChildren(button);
  });
  name.addEventListener("input", filter);
  verdict.addEventListener("change", filter);
  check.addEventListener("change", filter);
  document.getElementById("filters").hidden = false;
  filter();
})();
(function () {
  var opened = [];
  window.addEventListener("beforeprint", function () {
    opened = Array.prototype.slice.call(document.querySelectorAll("details:not([open])"));
    opened.forEach(function (each) { each.open = true; });
  });
  window.addEventListener("afterprint", function () {
    opened.forEach(function (each) { each.open = false; });
  });
})();
