"use strict";

// Tables of class "sortable": the headings become buttons that sort by their column, numbers as numbers, empty cells
// last. Without this script they are plain tables.

// A failed run has one wide cell in place of its numbers, so some columns have no cell of their own.
function cellKey(row, column) {
  const cell = row.cells[column];
  return cell ? (cell.dataset.value ?? cell.textContent.trim()) : "";
}

function compareKeys(a, b, numeric) {
  return numeric ? Number(a) - Number(b) : a.localeCompare(b, "en", { numeric: true });
}

function sortTable(table, column, ascending) {
  const body = table.tBodies[0];
  const rows = Array.from(body.rows, (row) => ({ row, key: cellKey(row, column) }));
  const filled = rows.filter(({ key }) => key !== "");
  const empty = rows.filter(({ key }) => key === "");
  const numeric = filled.every(({ key }) => Number.isFinite(Number(key)));
  const sign = ascending ? 1 : -1;
  filled.sort((a, b) => sign * compareKeys(a.key, b.key, numeric));
  body.append(...filled.concat(empty).map(({ row }) => row));
}

function makeSortable(table) {
  const headings = Array.from(table.tHead.rows[0].cells);
  headings.forEach((heading, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.title = "sort by this column";
    button.append(...heading.childNodes);
    heading.append(button);
    button.addEventListener("click", () => {
      const ascending = heading.getAttribute("aria-sort") !== "ascending";
      headings.forEach((other) => other.removeAttribute("aria-sort"));
      heading.setAttribute("aria-sort", ascending ? "ascending" : "descending");
      sortTable(table, column, ascending);
    });
  });
}

// A link to a run opens its details.
function openTarget() {
  const target = location.hash && document.getElementById(location.hash.slice(1));
  if (target && target.tagName === "DETAILS") target.open = true;
}

// Paper cannot be clicked: the runs' details are printed open.
function openRuns() {
  document.querySelectorAll("details.run").forEach((details) => (details.open = true));
}

document.querySelectorAll("table.sortable").forEach(makeSortable);
window.addEventListener("hashchange", openTarget);
window.addEventListener("beforeprint", openRuns);
openTarget();
