// A search of `fuzz`: what it found, with the input and the command that runs it again, what was tried, and how
// the coverage grew.
import { verdictBadge } from "./case_table.js";
import { axis, chartFigure, chartPlace, colour, kQuiet } from "./charts.js";
import { command, definitions, element, notice, section } from "./dom.js";
import { number, part, plural } from "./format.js";
import { implementationText, documentCommand, documentsOf, sentence } from "./summary.js";
import { table } from "./table.js";

// Points are at 1, 2, 5, 10, 20 ... sequences, so the axis is logarithmic. Searches together do not say what each kept.
function growthChart(label, growth) {
  const shown = (plot, value) => (value === null ? "" : number(value));
  const hasKept = growth.every(({kept}) => kept !== undefined);
  const make = () => ({
    data: [growth.map(({run}) => run), growth.map(({edges}) => edges), ...(hasKept ? [growth.map(({kept}) => kept)] : [])],
    options: {
      ...kQuiet,
      scales: {x: {time: false, distr: 3}, y: {range: (plot, low, high) => [0, Math.max(high * 1.05, 1)]}},
      axes: [axis("sequences", {size: 32, filter: (plot, splits) => splits.map((one) => (Number.isInteger(Math.log10(one)) ? one : null))}), axis(hasKept ? "edges, sequences" : "edges", {size: 60})],
      series: [{label: "sequences", value: shown},
        {label: "edges", stroke: colour("accent"), width: 1.5, points: {show: true, size: 6}, value: shown},
        ...(hasKept ? [{label: "kept", stroke: colour("second"), width: 1.5, dash: [6, 3], points: {show: true, size: 6}, value: shown}] : [])],
    },
  });
  return chartPlace(label, 240, make, 720);
}

// One point, or edges that are the same from the first on, are no growth to look at.
export function growthFigure(title, growth, of = "") {
  if (growth.length < 2 || growth.every(({edges}) => edges === growth[0].edges)) return null;
  const [first, last] = [growth[0], growth.at(-1)];
  const said = `${number(first.edges)} edges after ${plural(first.run, "sequence")}${of}, ${number(last.edges)} after ${number(last.run)}`;
  return chartFigure(title, said, growthChart(`Edges passed, by the number of sequences${of}: ${said}`, growth),
      [{colour: "accent", text: "edges passed by all sequences together"},
        ...(first.kept === undefined ? [] : [{colour: "second", dash: 1, text: "sequences kept because they passed an edge as no other before"}])]);
}

function growthPart({growth, has_coverage: hasCoverage}) {
  if (!hasCoverage) {
    return notice("The implementation reports no coverage, so the search was not guided by it: sequences were drawn as check draws them.");
  }
  return growthFigure("How coverage grew", growth);
}

function foundPart({found}) {
  if (!found) return null;
  const small = found.is_confirmed
    ? `Made small from ${plural(found.drawn_commands, "command")} to ${number(found.commands)} in ${plural(found.shrinking_runs, "run")}.`
    : "It did not fail in the same way again; the input is as it was drawn.";
  const side = (title, name, text) => element("div", {class: name}, element("strong", {}, title), element("p", {}, text));
  return element("article", {class: "finding-text"},
      element("h4", {}, verdictBadge(found.is_confirmed ? "fail" : "inconclusive"), ` ${found.reason ?? "a failure"} in ${found.found_in}`),
      found.requirement ? element("p", {}, found.requirement) : null,
      found.expected ? element("div", {class: "facing"}, side("Expected", "expected", found.expected.join(" or ")), side("Actual", "actual", found.actual)) : null,
      element("h5", {}, "Input"), element("ol", {class: "input"}, found.input.map((line) => element("li", {}, element("code", {}, line)))),
      element("p", {class: "quiet"}, small), command(found.reproduce));
}

function storedLeftOut({stored}) {
  if (stored.left_out.length === 0) return null;
  return table("Stored sequences that were left out", [
    {title: "file", kind: "code", cell: ({file}) => file},
    {title: "because", kind: "text", cell: ({because}) => because},
  ], stored.left_out);
}

function searchPart(data, { name, content }) {
  const said = data.joined.documents[data.documents.findIndex((one) => one.name === name && one.content === content)];
  const { stored } = content;
  return element("article", {}, element("h3", {}, verdictBadge(said.verdict), ` ${content.role}`), element("p", {}, `${sentence(said.sentence)}.`),
      definitions([["Document", name], ["Implementation", implementationText(content)], ["Seed", content.seed],
        ["Sequences executed", number(content.run + stored.run + (content.found ? 1 : 0))], ["of them stored ones", stored.read > 0 ? part(stored.run, stored.read) : ""],
        ["Agreed with the reference", number(content.passed)], ["Drove nothing", content.silent > 0 ? part(content.silent, content.passed) : ""],
        ["Could not be told", content.inconclusive > 0 ? number(content.inconclusive) : ""],
        ["Edges", content.has_coverage ? number(content.edges) : "no coverage is reported"],
        ["Sequences that are enough to pass them", content.has_coverage ? number(content.corpus) : ""],
        ["Ended because", content.ended_because]]),
      documentCommand(content, name), foundPart(content), growthPart(content), storedLeftOut(content));
}

export function fuzzSection(data) {
  const documents = documentsOf(data, "fieldproof/fuzz/1");
  return documents.length ? section("fuzz", "Fuzzing", documents.map((document) => searchPart(data, document))) : null;
}
