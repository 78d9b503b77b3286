// What a paper published, side by side with what is reproduced of it.
import { definitions, element, section } from "./dom.js";
import { later } from "./later.js";
import { documentCommand, documentsOf } from "./summary.js";
import { table } from "./table.js";
import { linearCurves } from "./charts.js";
import { traceFigure } from "./timing.js";

function agreement({ agrees }) {
  if (agrees === null) return element("span", {class: "quiet"}, "nothing to compare");
  return element("span", {class: `verdict ${agrees ? "pass" : "fail"}`}, agrees ? "agrees" : "differs");
}

function curvesFigure(figure) {
  const label = `${figure.name}: ${figure.y_label} over ${figure.x_label}; ${figure.curves.map((one) => one.name).join(", ")}`;
  return element("figure", {class: "wide"}, linearCurves(label, figure.x_label, figure.y_label, figure.curves),
      element("figcaption", {}, figure.name, element("span", {class: "quiet"}, " drag to zoom, a double click shows all")));
}

function sectionPart(part) {
  return element("article", {}, element("h4", {}, part.heading), part.note ? element("p", {}, part.note) : null,
      table(`${part.heading}: paper and reproduction`, [
        {title: "what", cell: (row) => row.what},
        {title: "paper", kind: "number", cell: (row) => row.published ?? element("span", {class: "quiet"}, "no number")},
        {title: "reproduced", cell: (row) => row.reproduced},
        {title: "", cell: agreement},
        {title: "remark", kind: "text", cell: (row) => row.remark},
      ], part.rows),
      (part.figures ?? []).map(curvesFigure),
      part.traces.map(({ name, trace }) => traceFigure(name, trace)));
}

function paperPart({ name, content }) {
  return element("article", {}, element("h3", {}, content.title),
      definitions([["Document", name], ["Seed", content.seed], ["Verdict", content.reproduced ? "no row disagrees" : "a row disagrees"]]),
      documentCommand(content, name), content.sections.map(sectionPart));
}

export function publicationSection(data) {
  const documents = documentsOf(data, "fieldproof/publication/1");
  return documents.length ? section("publication", "Paper and reproduction", documents.map((document) => later(() => paperPart(document)))) : null;
}
