// The head of the page: for each run its verdict, counts with their denominators, what it was and the command
// that makes it again; for each document where it comes from.
import { kVerdicts, verdictBadge } from "./case_table.js";
import { command, definitions, element, notice, section } from "./dom.js";
import { duration, number, part, plural } from "./format.js";

const kMeaning = {
  error: "the bench or the implementation broke off",
  fail: "a requirement is not met",
  inconclusive: "it cannot be reported",
  warn: "met, with a remark",
  pass: "met",
  "not-applicable": "the implementation declares otherwise",
  none: "selected, not judged",
};

function headlineText({ headline, counts }) {
  const of = counts.by_verdict;
  const judged = `of ${plural(counts.judged, "judged case")}`;
  if (counts.judged === 0) return "No case was judged";
  if (of.fail + of.error > 0 && headline !== "fail" && headline !== "error") {
    return `${number(of.fail + of.error)} ${judged} failed, as the baseline expects; all others passed`;
  }
  if (of.fail + of.error > 0) {
    const errors = of.error ? ` and ${number(of.error)} ended in an error` : "";
    return `${number(of.fail)} ${judged} failed${errors}`;
  }
  if (of.inconclusive > 0) return `${number(of.inconclusive)} ${judged} could not be told; none failed`;
  return headline === "warn" ? `No failure among ${plural(counts.judged, "judged case")}, ${plural(of.warn, "warning")}`
      : `All ${plural(counts.judged, "judged case")} passed`;
}

// One bar, as wide as the selection; its parts are listed below it.
function countBar(counts) {
  const numbers = {...counts.by_verdict, none: counts.not_run};
  const parts = kVerdicts.filter((verdict) => numbers[verdict] > 0);
  const bar = element("div", {class: "bar", "aria-hidden": "true"}, parts.map((verdict) => {
    const piece = element("span", {class: verdict});
    piece.style.flexGrow = numbers[verdict];
    return piece;
  }));
  const items = parts.map((verdict) => element("li", {}, verdictBadge(verdict), " ",
      element("strong", {}, number(numbers[verdict])), " ", element("span", {class: "quiet"}, verdict === "none" ? "not run" : kMeaning[verdict])));
  return [bar, element("ul", {class: "counts"}, items)];
}

function implementationText(run) {
  if (run.implementations.length === 0) return "ref (the built-in reference)";
  return run.implementations.map((one) => (one.role ? `${one.role}${one.position ? `@${one.position}` : ""}=` : "") + one.uri).join("; ");
}

function setUp({ results, manifest }) {
  const run = results.run;
  return definitions([
    ["Implementation", implementationText(run)],
    ["Seed", run.seed],
    ["Cases", run.selectors.join(" ") || "all"],
    ["Volume", run.volume],
    ["Suite", run.suite_version],
    ["fieldproof", `${run.tool_version}, ${manifest.build.type}, ${manifest.build.compiler}`],
    ["Plan of faults", planText(results)],
    ["Network", run.network_hash || "the suite's own"],
    ["PICS", run.pics_hash || "none"],
    ["Started", manifest.started],
    ["Finished", manifest.finished || "never"],
    ["Took", `${duration(Number(manifest.wall_time_us))}, ${plural(manifest.jobs, "thread")}, host ${manifest.host}`],
    ["Exit code", String(run.exit_code)],
  ]);
}

function planPart(fault) {
  const title = fault.name ? `${fault.place} (${fault.name})` : fault.place;
  return fault.cases_hit === 0 ? `${title}: never hit in ${plural(fault.cases, "case")}`
      : `${title}: hit ${fault.hits} times, in ${part(fault.cases_hit, fault.cases)} cases`;
}

// Of a long plan as many parts as a reader looks through.
function planText(results) {
  const faults = results.planned_faults ?? [];
  const kMost = 20;
  return [results.run.plan_hash || "none",
    faults.length ? element("ul", {class: "plain"}, faults.slice(0, kMost).map((fault) => element("li", {}, planPart(fault)))) : null,
    faults.length > kMost ? `${number(faults.length - kMost)} more parts are in results.json` : null];
}

// A part of a plan that never hit may be a slip of its writer, and a pass then says less than it seems.
function idleFaults(results) {
  const faults = results.planned_faults ?? [];
  const idle = faults.filter((fault) => fault.cases_hit === 0);
  if (idle.length === 0) return null;
  const named = idle.slice(0, 3).map((fault) => fault.place).join(", ") + (idle.length > 3 ? ", ..." : "");
  return notice(element("strong", {}, "Planned faults that never hit"), `: ${part(idle.length, faults.length)} parts of the plan (${named})`);
}

function runPart(run, isJoined) {
  const { results } = run;
  const { counts } = results;
  const trouble = [];
  if (!results.run.complete) {
    trouble.push(notice(element("strong", {}, "This run is incomplete"), `: ${results.run.incomplete_because || "it did not end"}. `,
        `${part(counts.not_run, counts.selected)} selected cases have no verdict.`));
  }
  trouble.push(idleFaults(results));
  for (const stale of results.run.stale_expectations ?? []) trouble.push(notice(element("strong", {}, "Baseline"), `: ${stale}`));
  for (const caveat of results.run.caveats ?? []) trouble.push(notice(element("strong", {}, "Unverified"), `: ${caveat}`));
  if (run.journal_was_torn) trouble.push(notice("The last line of its journal was torn; that result is lost."));
  return element("article", {class: `run ${results.headline}`},
      isJoined ? element("h3", {}, run.name) : null,
      element("p", {class: "headline"}, verdictBadge(results.headline), " ", headlineText(results)),
      element("p", {class: "quiet"}, `${part(counts.judged, counts.selected)} selected cases judged; not run: ${number(counts.not_run)}.`),
      trouble, countBar(counts), setUp(run),
      element("p", {class: "quiet"}, "As typed: ", element("code", {}, run.manifest.arguments.join(" "))), command(run.command));
}

const kDocuments = {
  "fieldproof/emc/1": ["#immunity", "a network under bursts"],
  "fieldproof/measurement/1": ["#timing", "a measurement beside the theory"],
  "fieldproof/publication/2": ["#publication", "a paper beside its reproduction"],
  "fieldproof/residual/1": ["#residual", "undetected errors of a frame check"],
  "fieldproof/matrix/1": ["#matrix", "cases and mutants"],
};

function documentList(documents) {
  const items = documents.map(({ name, content }) => {
    const [target, what] = kDocuments[content.schema];
    return element("li", {}, element("code", {}, name), ": ", element("a", {href: target}, what));
  });
  return [element("h3", {}, "Documents"), element("ul", {class: "plain"}, items)];
}

export function summarySection(data) {
  const isJoined = data.runs.length > 1;
  const place = section("summary", "Summary", data.runs.map((run) => runPart(run, isJoined)),
      data.documents.length ? documentList(data.documents) : null);
  place.querySelector("h2").classList.add("unseen");
  return place;
}

// The command that makes a document again, as far as the document tells it.
export function documentCommand(content, name) {
  return content.command ? command(content.command)
      : element("p", {class: "quiet"}, `${name} does not hold the command that made it.`);
}

export function documentsOf(data, schema) {
  return data.documents.filter(({ content }) => content.schema === schema);
}
