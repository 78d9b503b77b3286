// Tables: built from columns and rows, and sorted by their heads.
//
// A column is {title, cell(row), value(row), kind, amount(row), show(text, row)}: `cell` gives what is shown, or
// `amount` a number, which has the decimals of its column and which `show` may put into words; `value` what is
// sorted by (nothing: not sortable), `kind` the class of the cells ("number", "code").
import { element, scrollBox } from "./dom.js";
import { alike } from "./format.js";

export function cellOf(column, row, isHead) {
  const shown = column.cell(row);
  const attributes = {class: column.kind, "data-label": column.title};
  return isHead ? element("th", {...attributes, scope: "row"}, shown) : element("td", attributes, shown);
}

function withCell(column, rows) {
  const text = alike(rows.map(column.amount));
  const show = column.show ?? ((one) => one);
  return {kind: "number", ...column, cell: (row) => show(text(column.amount(row)), row)};
}

// A plain table in its own scrolling box; the first column heads each row.
export function table(caption, givenColumns, rows, classes = "") {
  const columns = givenColumns.map((column) => (column.amount ? withCell(column, rows) : column));
  const head = element("tr", {}, columns.map((column) => element("th", {scope: "col", class: column.kind}, column.title)));
  const body = rows.map((row) =>
      element("tr", {class: row.class}, columns.map((column, at) => cellOf(column, row, at === 0))));
  return scrollBox(caption, element("table", {class: classes}, element("caption", {}, caption),
      element("thead", {}, head), element("tbody", {}, body)));
}

function compare(a, b) {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return String(a).localeCompare(String(b), "en", {numeric: true});
}

// Heads that sort. `order(compareRows)` is called with a function that compares two rows.
export function sortableHead(columns, order) {
  const heads = columns.map((column) => {
    const head = element("th", {scope: "col", class: column.kind});
    if (!column.value) {
      head.append(column.title);
      return head;
    }
    head.setAttribute("aria-sort", "none");
    head.append(element("button", {type: "button", onclick: () => sortBy(column, head)}, column.title));
    return head;
  });
  function sortBy(column, head) {
    const isDescending = head.getAttribute("aria-sort") === "ascending";
    for (const other of heads) if (other.hasAttribute("aria-sort")) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", isDescending ? "descending" : "ascending");
    order((a, b) => (isDescending ? -1 : 1) * compare(column.value(a), column.value(b)));
  }
  return element("thead", {}, element("tr", {}, heads));
}
