// How the runs below a folder went one after another.
import { verdictBadge } from "./case_table.js";
import { chartFigure, linearCurves } from "./charts.js";
import { breakable, definitions, element, folded, notice, section } from "./dom.js";
import { duration, number, plural } from "./format.js";
import { later } from "./later.js";
import { sentence } from "./summary.js";
import { table } from "./table.js";

const kRunAxis = "run, the oldest first";

function setupMark(history, setup) {
  return history.setups.length < 2 ? null : element("span", {class: "quiet"}, ` [${setup + 1}]`);
}

function curvesOf(history, kinds) {
  return kinds.map(([member, name]) => ({name, points: history.runs.map((run, at) => ({x: at + 1, y: run[member]}))}));
}

function countsChart(history) {
  const curves = curvesOf(history, [["passed", "passed"], ["failed", "failed"], ["inconclusive", "inconclusive"]]);
  return chartFigure("Cases of each run", `${plural(history.runs.length, "run")}; with a warning, and as the baseline expects, count as passed`,
      linearCurves("Passed, failed and inconclusive cases of each run", kRunAxis, "cases", curves),
      [{colour: "accent", text: "passed"}, {colour: "second", text: "failed"}, {colour: "third", text: "inconclusive"}]);
}

function timeChart(history) {
  const points = history.runs.map((run, at) => ({x: at + 1, y: run.wall_time_us / 1e6}));
  return chartFigure("Time that each run took", `${duration(Math.min(...history.runs.map((run) => run.wall_time_us)))} to ${duration(Math.max(...history.runs.map((run) => run.wall_time_us)))}`,
      linearCurves("Wall time of each run in seconds", kRunAxis, "s", [{name: "wall time", points}]), [{colour: "accent", text: "wall time"}]);
}

function runsTable(history) {
  return table("Runs, the newest first", [
    {title: "run", kind: "number", cell: ({at}) => number(at + 1)},
    {title: "started", cell: ({run}) => run.started},
    {title: "", cell: ({run}) => verdictBadge(run.verdict)},
    {title: "name", cell: ({run}) => [breakable(run.name), setupMark(history, run.setup)]},
    {title: "passed", kind: "number", cell: ({run}) => number(run.passed)},
    {title: "failed", kind: "number", cell: ({run}) => number(run.failed)},
    {title: "inconclusive", kind: "number", cell: ({run}) => number(run.inconclusive)},
    {title: "not run", kind: "number", cell: ({run}) => number(run.not_run)},
    {title: "took", kind: "number", cell: ({run}) => duration(run.wall_time_us)},
    {title: "seed", kind: "number", cell: ({run}) => run.seed},
    {title: "suite", cell: ({run}) => breakable(run.suite_version)},
  ], history.runs.map((run, at) => ({run, at})).reverse(), "many");
}

function brokenTable(history) {
  if (history.broken.length === 0) return null;
  const run = (at) => `${number(at + 1)} (${history.runs[at].name})`;
  return table("Cases that began to fail", [
    {title: "case", cell: (one) => [breakable(one.id), setupMark(history, one.setup)]},
    {title: "fails since run", cell: (one) => run(one.first_bad)},
    {title: "passed last in run", cell: (one) => run(one.last_good)},
    {title: "reason", cell: (one) => breakable(one.reason)},
  ], history.broken);
}

const kLetters = {pass: "P", warn: "W", fail: "F", error: "E", inconclusive: "?"};

// A letter for each run, so that colour is not all that tells.
function verdictRow(history, verdicts) {
  return element("span", {class: "verdict-row"}, verdicts.map(([run, verdict]) =>
    element("span", {class: `verdict ${verdict}`, title: `run ${run + 1}, ${history.runs[run].name}: ${verdict}`}, kLetters[verdict] ?? "-")));
}

function flakyTable(history) {
  if (history.flaky.length === 0) return null;
  return table("Flaky cases: the verdict comes and goes under one suite", [
    {title: "case", cell: (one) => [breakable(one.id), setupMark(history, one.setup)]},
    {title: "verdicts, the oldest first", kind: "text", cell: (one) => verdictRow(history, one.verdicts)},
    {title: "with equal seeds", cell: (one) => (one.has_equal_seeds ? "yes" : "not seen")},
    {title: "suite", cell: (one) => breakable(one.suite_version)},
  ], history.flaky);
}

const kDriftMarks = {yes: ["fail", "drifts"], perhaps: ["warn", "may drift"]};

function driftMark({drifts}) {
  const [verdict, words] = kDriftMarks[drifts] ?? [];
  return verdict ? element("span", {class: `verdict ${verdict}`}, words) : null;
}

function quantitiesTable(history) {
  return table("Measured numbers", [
    {title: "number", kind: "text", cell: (one) => [breakable(one.name), setupMark(history, one.setup)]},
    {title: "", cell: driftMark},
    {title: "runs", kind: "number", cell: (one) => number(one.values.length)},
    {title: "first", kind: "number", cell: (one) => `${number(one.values[0][1])} ${one.unit}`},
    {title: "last", kind: "number", cell: (one) => `${number(one.values.at(-1)[1])} ${one.unit}`},
    {title: "in words", kind: "text", cell: (one) => sentence(one.words)},
  ], history.quantities, "many");
}

function quantityCharts(history) {
  const kMost = 12;
  const varying = history.quantities.filter(({values}) => values.some(([, value]) => value !== values[0][1])).slice(0, kMost);
  return varying.length === 0 ? null : element("div", {class: "charts"}, varying.map((one) =>
    chartFigure(one.name, one.words, linearCurves(`${one.name} in each run: ${one.words}`, kRunAxis, one.unit,
        [{name: one.unit || "value", points: one.values.map(([run, value]) => ({x: run + 1, y: value}))}]), [{colour: "accent", text: one.unit || "value"}])));
}

function cutNote(history) {
  const {counts} = history;
  const cut = [["flaky", "flaky cases"], ["broken", "cases that began to fail"], ["quantities", "measured numbers"]]
      .filter(([member]) => counts[member] > history[member].length).map(([member, words]) => `${number(counts[member])} ${words}`);
  return cut.length ? notice(`Not all are shown: there are ${cut.join(", ")}.`) : null;
}

function leftOutPart(history) {
  if (history.left_out.length === 0) return null;
  return notice(element("strong", {}, `Left out: ${plural(history.left_out.length, "folder")}`),
      element("ul", {}, history.left_out.map(({name, why}) => element("li", {}, element("code", {}, name), `: ${why}`))));
}

export function historySection({history}) {
  if (!history) return null;
  const setups = history.setups.length < 2 ? null : folded("The setups: runs are compared with those of the same one only",
      element("ol", {}, history.setups.map((one) => element("li", {}, element("code", {}, one)))));
  return section("history", "History", definitions([["Folder", history.folder], ["Runs", number(history.runs.length)],
    ["Older, not looked at", history.counts.older > 0 ? number(history.counts.older) : ""],
    ["From", history.runs[0].started], ["To", history.runs.at(-1).started]]),
  leftOutPart(history), brokenTable(history), flakyTable(history), cutNote(history),
  later(() => element("div", {class: "charts"}, countsChart(history), timeChart(history))), setups, runsTable(history),
  history.quantities.length ? [quantitiesTable(history), later(() => quantityCharts(history) ?? element("div"))] : null);
}
