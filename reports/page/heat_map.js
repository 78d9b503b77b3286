// The performance criterion by level, repetition rate and polarity, as a table of coloured cells.
import { element } from "./dom.js";
import { number } from "./format.js";

function unique(values) {
  return [...new Set(values)];
}

function shareText(count, whole) {
  return whole > 0 ? `${number((100 * count) / whole, 3)} %` : "0";
}

// What became of the exchanges of a cell: `rejected` of them were not used, in some a wrong word was accepted.
export function shareLines({sent, wrong_cycles: wrong}, rejected) {
  return [`${shareText(rejected, sent)} rejected`, `${shareText(wrong, sent)} accepted wrong`];
}

function heatCell(cell) {
  if (!cell) return element("td", {class: "heat"}, "not tested");
  if (!cell.letter) return element("td", {class: "heat none"}, cell.said);
  return element("td", {class: `heat criterion-${cell.letter}`}, element("strong", {}, cell.letter),
      element("small", {}, cell.lines.filter(Boolean).map((line, at) => (at === 0 ? line : [element("br"), line]))));
}

// Cells are {level, repetition, polarity, letter, lines}; without a letter `said` stands in the place of lines. The
// highest level, which comes last, is on top.
export function heatMap(caption, cells) {
  const levels = unique(cells.map((cell) => cell.level)).reverse();
  const columns = unique(cells.map((cell) => `${cell.repetition}\n${cell.polarity}`)).map((key) => key.split("\n"));
  const head = element("tr", {}, element("th", {scope: "col"}, "level"),
      columns.map(([repetition, polarity]) => element("th", {scope: "col"}, `${repetition} ${polarity === "-" ? "−" : polarity}`)));
  const rows = levels.map((level) => element("tr", {}, element("th", {scope: "row"}, level),
      columns.map(([repetition, polarity]) =>
          heatCell(cells.find((cell) => cell.level === level && cell.repetition === repetition && cell.polarity === polarity)))));
  return element("div", {class: "scroll", role: "region", tabindex: "0", "aria-label": caption},
      element("table", {class: "heat-map"}, element("caption", {}, caption),
          element("thead", {}, head), element("tbody", {}, rows)));
}
