// Undetected errors of frame checks: exact beside simulated.
import { chartFigure, logarithmicCurves } from "./charts.js";
import { definitions, element, notice, section } from "./dom.js";
import { number, plural, scientific } from "./format.js";
import { later } from "./later.js";
import { documentCommand, documentsOf } from "./summary.js";
import { table } from "./table.js";

function curves(content) {
  const points = content.points.filter((point) => point.ber > 0);
  if (points.length < 2) return null;
  const series = [{label: "exact probability", values: points.map((point) => point.probability)}];
  if (points.some((point) => point.proper_bound !== null)) {
    series.push({label: "bound of a proper check", values: points.map((point) => point.proper_bound ?? 0)});
  }
  if (points.some((point) => point.sampled)) {
    series.push({label: "importance sampling", values: points.map((point) => point.sampled?.probability ?? 0), isPoints: true});
  }
  const colours = ["accent", "second", "third"];
  return chartFigure("Probability of an undetected error over the bit-error rate", "both axes logarithmic",
      logarithmicCurves(`Probability of an undetected error of ${content.frame_check} over the bit-error rate`, "bit-error rate",
          "probability", points.map((point) => point.ber), series),
      series.map((one, at) => ({colour: colours[at], dash: at === 2 ? 1 : 0, text: one.label})), "wide");
}

function points(content) {
  const column = (title, cell) => ({title, kind: "number", cell});
  const columns = [
    column("bit-error rate", (point) => scientific(point.ber)),
    column("undetected, exact", (point) => scientific(point.probability)),
    column("share of corrupted", (point) => scientific(point.share_of_corrupted)),
    column("bound of a proper check", (point) =>
      point.proper_bound === null ? "none" : `${scientific(point.proper_bound)}${point.proper_bound_exceeded ? ", exceeded" : ""}`),
    column("per hour", (point) => scientific(point.rate_per_hour)),
  ];
  if (content.points.some((point) => point.counted)) {
    columns.push(column("counted", ({counted}) =>
      counted ? `${number(counted.undetected)} of ${number(counted.corrupted)} corrupted, at most ${scientific(counted.upper_bound_95)} (95 %)` : ""));
  }
  if (content.points.some((point) => point.sampled)) {
    columns.push(column("importance sampling", ({sampled}) =>
      sampled ? `${scientific(sampled.probability)} ± ${scientific(sampled.standard_error)}` : ""));
  }
  return table("By bit-error rate", columns, content.points, "many");
}

function estimator(content) {
  const sampled = content.points.find((point) => point.sampled)?.sampled;
  return sampled ? element("p", {class: "quiet"}, `Importance sampling: ${sampled.estimator}`) : null;
}

function checkPart({ name, content }) {
  const isUnverified = ["memory", "own"].includes(content.safety_standing);
  return element("article", {}, element("h3", {}, `${content.frame_check}, ${number(content.bits)} bits`),
      definitions([["Document", name], ["Polynomial", `${content.polynomial}, ${content.width} bits`],
        ["Hamming distance", content.hamming_distance === null ? "no room for a message" : String(content.hamming_distance)],
        ["Worst", `${scientific(content.worst.probability)} at a bit-error rate of ${scientific(content.worst.ber)}`],
        [`Worst up to ${content.usual_ber}`, scientific(content.worst_up_to_usual.probability)],
        ["Per hour", `${plural(content.messages_per_hour, "message")}, ${plural(content.receivers, "receiver")}`]]),
      documentCommand(content, name),
      isUnverified ? notice(element("strong", {}, "Unverified"),
          `: the bound of a proper check and the rate per hour follow ${content.safety_source}, of the standing "${content.safety_standing}".`) : null,
      curves(content), points(content), estimator(content),
      table("Code words by weight", [
        {title: "weight", kind: "number", cell: (one) => String(one.weight)},
        {title: "code words", kind: "number", cell: (one) => one.count},
      ], content.weights, "raw"));
}

export function residualSection(data) {
  const documents = documentsOf(data, "fieldproof/residual/1");
  return documents.length ? section("residual", "Undetected errors", documents.map((document) => later(() => checkPart(document)))) : null;
}
