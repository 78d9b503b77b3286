// Everything that is known of one case.
import { caseCommand } from "./data.js";
import { command, definitions, element, folded, notice } from "./dom.js";
import { duration, exactTime, number, plural, shownTime } from "./format.js";
import { table } from "./table.js";
import { timeLine } from "./time_line.js";

const kStandings = {
  seed: "printed in a paper that the project reproduces",
  sure: "standard, sure",
  searched: "read in a copy of the named document",
  calc: "computed; the computation is tested",
  derived: "follows from verified facts",
  memory: "from memory",
  own: "a choice of this project",
};

export function standingText(reference) {
  return kStandings[reference.standing] ?? reference.standing;
}

export function unverifiedMark(reference) {
  return reference.verified ? null : element("span", {class: "unverified", title: standingText(reference)}, "unverified");
}

export function sourceText(reference) {
  const clause = reference.clause ? `, ${reference.clause}` : "";
  return [`${reference.source}${clause} `, element("span", {class: "quiet"}, `(${standingText(reference)}) `), unverifiedMark(reference)];
}

function isSameSource(a, b) {
  return a.source === b.source && a.clause === b.clause && a.standing === b.standing;
}

function lines(texts, empty) {
  if (texts.length === 0) return element("p", {class: "quiet"}, empty);
  return element("ul", {class: "plain"}, texts.map((text) => element("li", {}, text)));
}

// To the nanosecond; the picoseconds come under the pointer.
function timeText(picoseconds) {
  return element("span", {title: exactTime(picoseconds)}, shownTime(picoseconds));
}

function facing(expected, actual) {
  return element("div", {class: "facing"}, element("div", {}, element("h5", {}, "Expected"), lines(expected, "nothing is listed")),
      element("div", {class: "actual"}, element("h5", {}, "Actual"), element("p", {}, actual || "nothing was observed")));
}

// What the case says already is not said again.
function findingPart(finding, result, at, count) {
  const title = count > 1 ? `Finding ${at + 1} of ${count}` : "Finding";
  const decode = finding.decode.length
      ? element("details", {class: "folded", open: finding.decode.length <= 12}, element("summary", {}, `Decode, ${plural(finding.decode.length, "line")}`),
          element("pre", {class: "scroll", tabindex: "0"}, finding.decode.join("\n")))
      : null;
  return element("article", {class: "finding-text"},
      element("h4", {}, `${title}: `, element("span", {class: `verdict ${finding.verdict}`}, finding.verdict), " ",
          element("code", {}, finding.reason || "no reason code")),
      finding.requirement !== result.requirement ? element("p", {}, finding.requirement) : null,
      definitions([["Source", isSameSource(finding.reference, result.reference) ? "" : sourceText(finding.reference)], ["Time", timeText(finding.time_ps)],
        ["Step", finding.step],
        ["First difference", finding.first_difference]]),
      facing(finding.expected, finding.actual),
      finding.decisive.length ? element("div", {class: "decisive"}, element("h5", {}, "Decisive"), lines(finding.decisive, "")) : null, decode);
}

// Where there is no limit, low and high are the value itself.
function limitText(one) {
  return one.low === one.value && one.high === one.value ? "no limit" : `${number(one.low)} to ${number(one.high)}`;
}

function measurementsPart(measurements) {
  return table("Measurements", [
    {title: "quantity", cell: (one) => one.name},
    {title: "value", amount: (one) => one.value, show: (text, one) => `${text} ${one.unit}`},
    {title: "limits", kind: "number", cell: limitText},
  ], measurements);
}

function timeLinePart(more) {
  if (more.timeline) return [element("h4", {}, "Time line"), timeLine(more.timeline)];
  if (more.timeline_left_out) {
    return notice(`The time line is not in this page, which holds as many as fit; it is in ${more.folder}/timeline.json. ` +
        "Run this case alone, and its page has it.");
  }
  return null;
}

// The step in which the case failed, from 0 on; -1: no finding names one of them. A finding may name steps of another
// list, as those of a sequence, so it has to be the same text.
function failedStep(steps, findings) {
  const places = findings.map(({ step }) => steps.indexOf(step)).filter((at) => at >= 0);
  return places.length > 0 ? Math.min(...places) : -1;
}

// A case ends with its failure; what comes after was not done.
function stepOutcome(at, failed) {
  if (failed < 0) return null;
  const [sign, words] = at < failed ? ["\u2713", "done"] : at === failed ? ["\u2717", "failed"] : ["\u2013", "not reached"];
  return element("span", {class: `step-outcome ${at === failed ? "failed" : "quiet"}`}, ` ${sign} ${words}`);
}

// The case step by step: what was done, what must come of it, and where it failed.
function storyPart(story, findings) {
  if (!story) return null;
  const failed = failedStep(story.steps, findings);
  const list = element("ol", {class: "steps"}, story.steps.map((step, at) =>
    element("li", {class: /^[^:]*: expected/.test(step) ? "check" : "stimulus"}, step.replace(/^\d+ of \d+: /, ""), stepOutcome(at, failed))));
  const title = `Step by step, ${plural(story.steps.length, "step")}${failed < 0 ? "" : `, failed in ${failed + 1}`}`;
  return [definitions([["Stimulus", story.stimulus], ["Expected", story.expected]]), story.steps.length ? folded(title, list) : null,
    story.catches.length ? folded(`Mutants that it catches, ${story.catches.length}`, lines(story.catches, "")) : null];
}

// Which parts of the run's plan of faults hit in this case.
function plannedHitsText(hits, plan = []) {
  if (!hits) return "";
  const kMost = 20;
  const hit = plan.flatMap(({ place }, at) => (hits[at] !== undefined && hits[at] !== "0" ? [`${place} ${hits[at]} times`] : []));
  if (hit.length === 0) return "no part of it hit";
  return `hit by ${hit.slice(0, kMost).join(", ")}${hit.length > kMost ? ` and ${number(hit.length - kMost)} more parts` : ""}`;
}

// A run's own page stands where its files are; any other only says where.
function isBesideFiles(run) {
  return decodeURIComponent(location.pathname).split("/").at(-2) === run.name;
}

const kFiles = {"trace.pcapng": "capture for Wireshark", "trace.vcd": "waves", "trace.txt": "recording as text", "case.json": "for fieldproof replay"};

function filesPart({ more, run }) {
  if (!more.files) return null;
  const link = (name) => (isBesideFiles(run) ? element("a", {href: `${more.folder}/${name}`.split("/").map(encodeURIComponent).join("/")}, name) : name);
  const files = more.files.map((name) => [link(name), kFiles[name] ? ` (${kFiles[name]})` : ""]);
  return element("p", {class: "files"}, `Stored in ${run.name}/${more.folder}: `, files.flatMap((one, at) => (at ? [", ", one] : [one])));
}

// `row` is {result, more, story, run}.
export function caseDetail(row) {
  const { result, more, story } = row;
  const parts = [
    element("p", {class: "requirement"}, result.requirement || "No requirement is stated."),
    definitions([["Source", sourceText(result.reference)], ["Purpose", result.purpose],
      [result.verdict === "not-applicable" ? "Why it does not apply" : "Reason", result.reason],
      ["Expected by the baseline", result.expected_because ?? ""],
      ["Plan of faults", plannedHitsText(result.planned_hits, row.run.results.run.plan)]]),
    storyPart(story, result.findings),
    result.findings.map((finding, at) => findingPart(finding, result, at, result.findings.length)),
    result.settings ? definitions([["Settings other than usual", lines(result.settings, "")]]) : null,
    timeLinePart(more),
    result.measurements.length ? measurementsPart(result.measurements) : null,
    result.log ? [element("h4", {}, "Log of the implementation"), element("pre", {class: "scroll", tabindex: "0"}, result.log)] : null,
    filesPart(row),
    folded("Seed, fingerprint and times", definitions([["Seed of the case", result.seed], ["Fingerprint", element("code", {}, result.fingerprint)],
      ["Virtual time", timeText(result.virtual_time_ps)], ["Wall time", duration(row.wallTime)]])),
    command(caseCommand(row.run, result.id)),
  ];
  return element("div", {class: "case-detail"}, parts);
}
