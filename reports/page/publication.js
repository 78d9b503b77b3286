// What a paper published, side by side with what is reproduced of it.
import { definitions, element, section } from "./dom.js";
import { later } from "./later.js";
import { documentCommand, documentsOf } from "./summary.js";
import { table } from "./table.js";
import { chartFigure, linearCurves } from "./charts.js";
import { traceFigure } from "./timing.js";

const SIGNS = {agrees: "pass", DIFFERS: "fail", inconclusive: "inconclusive"};
const RELATIONS = {within: "of", at_most: "of at most", more_than: "of more than"};

function agreement({ verdict, compared }) {
  if (compared === null) return element("span", {class: "quiet"}, verdict);
  const { ours, relation, tolerance, unit } = compared;
  const band = relation === "within" ? ` \u00b1 ${tolerance}` : "";
  return element("span", {title: `${ours} ${RELATIONS[relation]} ${compared.published ?? compared.reference}${band} ${unit}`},
      element("span", {class: `verdict ${SIGNS[verdict] ?? ""}`}, verdict));
}

function curvesFigure(figure) {
  const label = `${figure.name}: ${figure.y_label} over ${figure.x_label}; ${figure.curves.map((one) => one.name).join(", ")}`;
  const colours = ["accent", "second", "third", "quiet"];
  return chartFigure(figure.name, "drag to zoom, a double click shows all", linearCurves(label, figure.x_label, figure.y_label, figure.curves),
      figure.curves.map((one, at) => ({colour: colours[at % colours.length], dash: at < colours.length ? 0 : 1, text: one.name})), "wide");
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
      definitions([["Document", name], ["Seed", content.seed], ["Rows", Object.entries(content.rows).map(([verdict, rows]) => `${rows} ${verdict}`).join(", ")]]),
      documentCommand(content, name), content.sections.map(sectionPart));
}

export function publicationSection(data) {
  const documents = documentsOf(data, "fieldproof/publication/2");
  return documents.length ? section("publication", "Paper and reproduction", documents.map((document) => later(() => paperPart(document)))) : null;
}
