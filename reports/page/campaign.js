// Campaigns: what of how many jobs ended how, the rows, what did not end well with the command that shows it again,
// the error ledgers added up, and the criterion by level where emc was among the jobs.
import { verdictBadge } from "./case_table.js";
import { grouped } from "./data.js";
import { command, definitions, element, folded, notice, section } from "./dom.js";
import { number, part, plural, scientific } from "./format.js";
import { growthFigure } from "./fuzz.js";
import { heatMap, shareLines } from "./heat_map.js";
import { later } from "./later.js";
import { documentsOf } from "./summary.js";
import { table } from "./table.js";

const kEndings = {0: "pass", 1: "fail", 2: "inconclusive", 3: "warn", 4: "none"};
const kCriteria = ["A", "B", "C", "D"];

function endingOf(code) {
  return kEndings[code] ?? "error";
}

function countsText(counts, each = "") {
  return Object.entries(counts).filter(([, count]) => count > 0).map(([name, count]) => `${number(count)} ${each}${name}`).join(", ");
}

function codesOf(counts) {
  return Object.entries(counts).map(([code, count], at) => [at === 0 ? "" : ", ",
    code === "0" || code === "4" ? `${number(count)} with ` : [verdictBadge(endingOf(code)), ` ${number(count)} with `], `exit code ${code}`]);
}

function rowsPart(content) {
  const rows = table("Jobs by row: what differs in the seed alone", [
    {title: "command", kind: "code", cell: (row) => element("code", {}, row.command)},
    {title: "jobs", kind: "number", cell: (row) => number(row.jobs)},
    {title: "ended", cell: (row) => codesOf(row.by_exit_code)},
    {title: "said", cell: (row) => countsText(row.by_headline)},
    {title: "cases", cell: (row) => countsText(row.cases)},
  ], content.rows, "jobs");
  return [rows, content.rows_left_out > 0 ? notice(`${number(content.rows_left_out)} more rows are in the document.`) : null];
}

function jobFinding(job) {
  const failed = job.failed ?? [];
  return element("article", {class: "finding-text"},
      element("p", {}, verdictBadge(job.exit_code === 0 ? "fail" : endingOf(job.exit_code)), ` job ${number(job.id)}: exit code ${job.exit_code}`,
          job.headline ? `, ${kCriteria.includes(job.headline) ? "criterion " : ""}${job.headline}` : "", job.killed ? `; its process ${job.killed}` : ""),
      job.message ? element("p", {}, job.message) : null,
      failed.length ? element("ul", {class: "plain"}, failed.map((one) => element("li", {}, element("code", {}, one))),
          job.failed_left_out ? element("li", {}, `and ${number(job.failed_left_out)} more`) : null) : null,
      command(job.command));
}

function jobFindings(content) {
  if (content.findings.length === 0) return element("p", {}, "No job has a finding.");
  const kOpen = 10;
  const more = content.findings.slice(kOpen);
  return [element("h4", {}, "Findings, each with the command that shows it again"), content.findings.slice(0, kOpen).map(jobFinding),
    more.length ? folded(plural(more.length, "more finding"), more.map(jobFinding)) : null,
    content.findings_left_out > 0 ? notice(`${number(content.findings_left_out)} more are in the document.`) : null];
}

const kLedgerNames = {sent: "exchanges sent", data_differed: "exchanges whose data differed"};

function ledgerPart({ ledger }) {
  if (!ledger) return null;
  return [table("Wrong words that were accepted, in all jobs of emc together", [
    {title: "of", cell: (one) => kLedgerNames[one.of]},
    {title: "exchanges", kind: "number", cell: (one) => number(one.total)},
    {title: "with a wrong word", kind: "number", cell: (one) => number(one.wrong)},
    {title: "share", kind: "number", cell: (one) => (one.total > 0 ? scientific(one.wrong / one.total) : "none")},
    {title: "at most (95 %)", kind: "number", cell: (one) => (one.total > 0 ? scientific(one.upper_bound_95) : "none")},
    {title: "how it is known", kind: "text", cell: (one) => (one.total > 0 ? "one-sided and exact, from the count (Clopper and Pearson)" : "there was nothing to see")},
  ], ledger.accepted_wrong), definitions(Object.entries(ledger.counts).map(([name, count]) => [name.replaceAll("_", " "), number(count)]))];
}

const kDecisions = {
  below: ["pass", "shown to be below"],
  above: ["fail", "shown to be above"],
  open: ["inconclusive", "not decided against"],
};

function decisionPart({ confidence: goal }) {
  if (!goal) return null;
  const [verdict, words] = kDecisions[goal.decision];
  return element("p", {}, verdictBadge(verdict), ` The share of ${kLedgerNames[goal.of]} in which a wrong word was accepted is ${words} `,
      element("strong", {}, scientific(goal.rate)), ` with ${number(100 * goal.confidence)} %: ${part(goal.wrong, goal.total)}, so between `,
      `${scientific(goal.lower_bound)} and ${scientific(goal.upper_bound)} after ${plural(goal.looks, "look")}.`);
}

// What a command says of `option`, if it is one value.
function valueIn(text, option) {
  const said = new RegExp(` '?--${option}=([^' ]+)'?`).exec(text)?.[1];
  return said && !said.includes(",") && !said.includes("..") ? said : null;
}

function cellOfRow(row) {
  const said = kCriteria.filter((one) => row.by_headline[one]);
  return {
    row,
    level: valueIn(row.command, "test-levels"),
    repetition: valueIn(row.command, "repetition") ?? "all rates",
    polarity: valueIn(row.command, "polarity") ?? "+ and −",
    rest: row.command.replace(/ '?--(test-levels|repetition|polarity)=[^ ]*/g, ""),
    letter: said.at(-1) ?? "",
    said: "no result",
    lines: [...shareLines(row.ledger, row.ledger.detected), said.length > 1 ? countsText(row.by_headline) : `in ${plural(row.jobs, "job")}`],
  };
}

// One for each network and other options, where there is more than one cell to compare.
function heatMaps(content) {
  const cells = content.rows.filter((row) => row.ledger.sent !== undefined).map(cellOfRow).filter((cell) => cell.level);
  return grouped(cells, (cell) => cell.rest).filter(([, all]) => all.length > 1)
      .map(([rest, all]) => [element("h4", {}, "Performance criterion, the worst of the jobs"), element("p", {}, element("code", {}, rest)),
        heatMap("by level, repetition rate and polarity", all.toSorted((a, b) => a.level.localeCompare(b.level, "en", {numeric: true})))]);
}

// What searches of one implementation passed together, and what is stored of it.
function corporaPart({ search }) {
  return (search?.corpora ?? []).map((one) => [element("h4", {}, `Fuzzing together: ${one.name}`),
    growthFigure(`How coverage grew in ${plural(one.jobs.length, "job")}`, one.growth, " in each job"),
    element("p", {}, `${plural(one.sequences, "sequence")} in corpus/${one.name} pass ${plural(one.edges, "edge")} together.`),
    one.message ? notice(`The corpus was not made smaller: ${one.message}`) : null]);
}

function campaignPart({ name, content }) {
  const { counts } = content;
  const planned = counts.jobs < counts.planned ? `${number(counts.jobs)} of ${number(counts.planned)} planned` : number(counts.jobs);
  return element("article", {}, element("h3", {}, content.title || name),
      definitions([["Document", name], ["Jobs", planned], ["Worst exit code", String(content.exit_code)],
        ["Ended", codesOf(counts.by_exit_code)], ["Said", countsText(counts.by_headline)],
        ["Killed", counts.killed > 0 ? plural(counts.killed, "job") : ""],
        ["Cases of run", content.cases ? countsText(content.cases.by_verdict) : ""],
        ["Suite", content.suite_version], ["Plan", content.plan_hash]]),
      content.is_complete ? null : notice(element("strong", {}, "This campaign is incomplete"), `: ${content.incomplete_because}. What is not here was not run.`),
      decisionPart(content), ledgerPart(content), heatMaps(content), corporaPart(content), jobFindings(content), later(() => element("div", {}, rowsPart(content))));
}

export function campaignSection(data) {
  const documents = documentsOf(data, "fieldproof/campaign/1");
  return documents.length ? section("campaign", "Campaigns", documents.map(campaignPart)) : null;
}
