// The head of the page: the verdict of all that is on it, as the program joined it, with what must be said of
// the results; then for each run its counts with their denominators, what it was and the command that makes it
// again.
import { kVerdicts, verdictBadge } from "./case_table.js";
import { breakable, command, definitions, element, folded, notice, section } from "./dom.js";
import { duration, number, part, plural } from "./format.js";
import { table } from "./table.js";

const kMeaning = {
  error: "the bench or the implementation broke off",
  fail: "a requirement is not met",
  inconclusive: "it cannot be reported",
  warn: "met, with a remark",
  pass: "met",
  "not-applicable": "the implementation declares otherwise",
  none: "selected, not judged",
};

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

export function implementationText(run) {
  if (run.implementations.length === 0) return "ref (the built-in reference)";
  return run.implementations.map((one) => (one.role ? `${one.role}${one.position ? `@${one.position}` : ""}=` : "") + one.uri).join("; ");
}

function setUp({ results, manifest }) {
  const run = results.run;
  return definitions([
    ["Implementation", implementationText(run)],
    ["Cases", run.selectors.join(" ") || "all"],
    ["Suite", run.suite_version],
    ["Seed", run.seed],
    ["Started", manifest.started],
    ["Took", `${duration(Number(manifest.wall_time_us))}, host ${manifest.host}`],
    ["PICS", run.pics_hash ? `hash ${run.pics_hash}` : "none"],
  ]);
}

// What a developer asks who makes it again.
function detailsOf({ results, manifest }) {
  const run = results.run;
  return folded("How it was made", definitions([
    ["Volume", run.volume],
    ["fieldproof", `${run.tool_version}, ${manifest.build.type}, ${manifest.build.compiler}`],
    ["Network", run.network_hash || "the suite's own"],
    ["Finished", manifest.finished || "never"],
    ["Threads", String(manifest.jobs)],
    ["Exit code", String(run.exit_code)],
  ]), element("p", {class: "quiet"}, "As typed: ", element("code", {}, manifest.arguments.join(" "))));
}

function planPart(fault) {
  const title = fault.name ? `${fault.place} (${fault.name})` : fault.place;
  return fault.cases_hit === 0 ? `${title}: never hit in ${plural(fault.cases, "case")}`
      : `${title}: hit ${fault.hits} times, in ${part(fault.cases_hit, fault.cases)} cases`;
}

// Of a long plan as many parts as a reader looks through.
function planOf(results) {
  const faults = results.planned_faults ?? [];
  if (!results.run.plan_hash && faults.length === 0) return null;
  const kMost = 20;
  return definitions([["Plan of faults", [results.run.plan_hash,
    faults.length ? element("ul", {class: "plain"}, faults.slice(0, kMost).map((fault) => element("li", {}, planPart(fault)))) : null,
    faults.length > kMost ? `${number(faults.length - kMost)} more parts are in results.json` : null]]]);
}

// A part of a plan that never hit may be a slip of its writer, and a pass then says less than it seems.
function idleFaults(results) {
  const faults = results.planned_faults ?? [];
  const idle = faults.filter((fault) => fault.cases_hit === 0);
  if (idle.length === 0) return null;
  const named = idle.slice(0, 3).map((fault) => fault.place).join(", ") + (idle.length > 3 ? ", ..." : "");
  return notice(element("strong", {}, "Planned faults that never hit"), `: ${part(idle.length, faults.length)} parts of the plan (${named})`);
}

function runPart(run, said, isJoined) {
  const { results } = run;
  const { counts } = results;
  const trouble = [];
  if (!results.run.complete) {
    trouble.push(notice(element("strong", {}, "This run is incomplete"), `: ${results.run.incomplete_because || "it did not end"}. `,
        `${part(counts.not_run, counts.selected)} selected cases have no verdict.`));
  }
  trouble.push(idleFaults(results));
  for (const stale of results.run.stale_expectations ?? []) trouble.push(notice(element("strong", {}, "Baseline"), `: ${stale}`));
  if (run.journal_was_torn) trouble.push(notice("The last line of its journal was torn; that result is lost."));
  return element("article", {class: `run ${said.verdict}`, id: addressOf("run", said)},
      isJoined ? element("h3", {}, verdictBadge(said.verdict), " ", run.name) : null,
      isJoined ? element("p", {}, sentence(said.sentence)) : null,
      element("p", {class: "quiet"}, `${part(counts.judged, counts.selected)} selected cases judged; not run: ${number(counts.not_run)}.`),
      trouble, countBar(counts), setUp(run), planOf(results), command(run.command), detailsOf(run));
}

const kDocuments = {
  "fieldproof/emc/1": ["immunity", "a network under bursts"],
  "fieldproof/measurement/1": ["timing", "a measurement beside the theory"],
  "fieldproof/publication/2": ["publication", "a paper beside its reproduction"],
  "fieldproof/residual/1": ["residual", "undetected errors of a frame check"],
  "fieldproof/matrix/1": ["matrix", "cases and mutants"],
  "fieldproof/detection/1": ["detection", "random sequences against mutants"],
  "fieldproof/emc_fit/1": ["fit", "counts of a laboratory beside the burst model"],
  "fieldproof/campaign/1": ["campaign", "many jobs of other verbs"],
  "fieldproof/fuzz/1": ["fuzz", "a search for sequences that fail"],
};

// The program writes its sentences without a capital, to be joined.
export function sentence(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

function addressOf(kind, said) {
  return `${kind}-${said.at}`;
}

// Verdicts of all parts, each with its place on the page.
export function partsOf(data) {
  const { joined } = data;
  const runs = joined.runs.map((said, at) => ({...said, at, what: "a run of cases", target: addressOf("run", {at})}));
  const documents = joined.documents.map((said, at) => {
    const [target, what] = kDocuments[data.documents[at].content.schema];
    return {...said, at, what, target};
  });
  const histories = joined.histories.map((said, at) => ({...said, at, what: "runs one after another", target: "history"}));
  return [...runs, ...histories, ...documents];
}

function partsTable(parts) {
  return table("Runs and documents", [
    {title: "", cell: (one) => (one.verdict === "none" ? element("span", {class: "quiet"}, "no verdict") : verdictBadge(one.verdict))},
    {title: "name", cell: (one) => element("a", {href: `#${one.target}`}, breakable(one.name))},
    {title: "what it is", cell: (one) => one.what},
    {title: "what it says", kind: "text", cell: (one) => sentence(one.sentence)},
  ], parts, "parts");
}

// Each is said once, however many parts it holds for.
export function caveatList({ joined }, parts) {
  const of = (names) => (parts > 1 ? element("span", {class: "quiet"}, ` (${names.join(", ")})`) : null);
  return joined.caveats.length === 0 ? null
      : notice(element("strong", {}, "What must be said of these results"),
          element("ul", {}, joined.caveats.map(({ text, names }) => element("li", {}, text, of(names)))));
}

export function headlineOf({ joined }) {
  return element("p", {class: `headline ${joined.verdict}`}, verdictBadge(joined.verdict), " ", sentence(joined.sentence));
}

export function summarySection(data) {
  const isJoined = data.runs.length > 1;
  const parts = partsOf(data);
  // With a cover, one document has nothing left to sum up.
  if (data.cover && parts.length === 1 && data.runs.length === 0) return null;
  const place = section("summary", "Summary", data.cover ? null : headlineOf(data),
      parts.length > 1 ? partsTable(parts) : null, data.cover ? null : caveatList(data, parts.length),
      data.runs.map((run, at) => runPart(run, {...data.joined.runs[at], at}, isJoined)));
  if (!data.cover) place.querySelector("h2").classList.add("unseen");
  return place;
}

// With what, when and where; documents of earlier programs do not say.
export function madeText({made}) {
  return made ? `by fieldproof ${made.tool_version} on ${made.host}, ${made.date}` : "";
}

// The command that makes a document again, as far as the document tells it.
export function documentCommand(content, name) {
  return content.command ? command(content.command)
      : element("p", {class: "quiet"}, `${name} does not hold the command that made it.`);
}

export function documentsOf(data, schema) {
  return data.documents.filter(({ content }) => content.schema === schema);
}
