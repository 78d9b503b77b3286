// The table of cases: filtered by text, verdict and standing, sorted by its heads; a row opens to all that is
// known of its case. A case has the address #<id>; in a page of several runs the later ones have #<n>:<id>.
//
// A page may hold a hundred thousand cases: lines are made when they are shown, some hundreds at a time. On paper
// stand the cases that did not pass, with their details, and of the others a list of names.
import { breakable, element, notice, replaceContent, section } from "./dom.js";
import { caseDetail, unverifiedMark } from "./case_detail.js";
import { duration, part } from "./format.js";
import { cellOf, sortableHead } from "./table.js";

export const kVerdicts = ["error", "fail", "inconclusive", "warn", "pass", "not-applicable", "none"];

// What a reader of paper needs no details of, unless it was opened.
const kNeedsNoDetails = new Set(["pass", "not-applicable"]);

const kWeight = new Map(kVerdicts.map((verdict, at) => [verdict, at]));

const kNothingMore = {};
const kLinesAtATime = 500;
const kMostOnPaper = 12;
const kMostLinesOnPaper = 500;
const kMostNames = 2000;

export function verdictBadge(verdict) {
  return element("span", {class: `verdict ${verdict}`}, verdict === "not-applicable" ? "n/a" : verdict);
}

function rowsOf(data) {
  return data.runs.flatMap((run, at) => {
    const isSameSuite = run.results.run.suite_version === data.catalogue.suite_version;
    return run.results.cases.map((result, position) => ({
      result, run, position: at * 1e6 + position,
      more: run.cases[result.id] ?? kNothingMore, wallTime: run.wall_times_us[position],
      story: isSameSuite ? data.catalogue.stories[result.id] : undefined,
      address: at === 0 ? result.id : `${at + 1}:${result.id}`,
    }));
  });
}

function isUnverified({ result }) {
  return !result.reference.verified || result.findings.some((finding) => !finding.reference.verified);
}

function searchText({ result, run }) {
  const findings = result.findings.flatMap((one) => [one.reason, one.actual, one.requirement]);
  // It is not kept: a hundred thousand of them are more than the results themselves.
  return [result.id, result.verdict, result.reason, result.purpose, result.requirement, result.reference.source, run.name, ...findings]
      .join("\n").toLowerCase();
}

function columnsOf(isJoined) {
  const columns = [
    {title: "Verdict", cell: (row) => verdictBadge(row.result.verdict), value: (row) => kWeight.get(row.result.verdict)},
    {title: "Case", kind: "case-name", cell: (row) => row.opener, value: (row) => row.result.id},
    {title: "Purpose", cell: (row) => row.result.purpose, value: (row) => row.result.purpose},
    {title: "Reason", kind: "reason", cell: (row) => breakable(row.result.reason), value: (row) => row.result.reason},
    {title: "Standing", cell: (row) => unverifiedMark(row.result.reference) ?? row.result.reference.standing,
      value: (row) => row.result.reference.standing},
    {title: "Wall time", kind: "number", cell: (row) => duration(row.wallTime), value: (row) => row.wallTime},
  ];
  if (isJoined) columns.splice(1, 0, {title: "Run", cell: (row) => row.run.name, value: (row) => row.position});
  return columns;
}

class CaseTable {
  constructor(data) {
    this.rows = rowsOf(data);
    this.columns = columnsOf(data.runs.length > 1);
    this.wanted = new Set(kVerdicts);
    this.text = "";
    this.isUnverifiedOnly = false;
    this.most = kLinesAtATime;
    this.body = element("tbody");
    this.rows.sort((a, b) => kWeight.get(a.result.verdict) - kWeight.get(b.result.verdict) || a.position - b.position);
    this.count = element("p", {class: "count", role: "status"});
    this.more = element("button", {type: "button", class: "more-lines", onclick: () => { this.most += kLinesAtATime; this.place(); }});
    this.table = element("table", {class: "cases"},
        element("caption", {class: "unseen"}, "Cases; a row opens to its findings"), sortableHead(this.columns, (compare) => this.order(compare)), this.body);
    this.show();
  }

  // The line of a row, made when it is first asked for.
  lineOf(row) {
    if (row.line) return row.line;
    const detailId = `detail-${row.address}`;
    row.opener = element("button", {type: "button", class: "opener", "aria-expanded": "false", "aria-controls": detailId,
      onclick: () => this.toggle(row)}, breakable(row.result.id));
    row.cell = element("td", {colspan: this.columns.length});
    row.detail = element("tr", {class: "detail", id: detailId, hidden: true}, row.cell);
    const link = element("a", {class: "anchor", href: `#${encodeURI(row.address)}`, "aria-label": `Link to ${row.result.id}`}, "#");
    row.line = element("tr", {class: `case ${row.result.verdict}${kNeedsNoDetails.has(row.result.verdict) ? " quiet" : ""}`, id: row.address}, this.columns.map((column) => cellOf(column, row)));
    row.opener.after(link);
    return row.line;
  }

  place() {
    const lines = this.shown.slice(0, this.most);
    if (this.called && !lines.includes(this.called)) lines.push(this.called);
    this.body.replaceChildren(...lines.flatMap((row) => [this.lineOf(row), row.detail]));
    const rest = this.shown.length - this.most;
    this.more.hidden = rest <= 0;
    this.more.textContent = rest > 0 ? `Show ${Math.min(rest, kLinesAtATime)} more of ${rest}` : "All are shown";
  }

  order(compare) {
    this.rows.sort((a, b) => compare(a, b) || a.position - b.position);
    this.show();
  }

  controls() {
    const filter = element("input", {type: "search", id: "case-filter", autocomplete: "off",
      oninput: () => { this.text = filter.value.trim().toLowerCase(); this.show(); }});
    const chips = kVerdicts.filter((verdict) => this.rows.some((row) => row.result.verdict === verdict)).map((verdict) => this.chip(verdict));
    const only = element("input", {type: "checkbox", id: "unverified-only",
      onchange: () => { this.isUnverifiedOnly = only.checked; this.show(); }});
    return element("div", {class: "controls"},
        element("div", {}, element("label", {for: "case-filter"}, "Filter ids, reasons, requirements "), filter),
        element("div", {class: "chips", role: "group", "aria-label": "Verdicts"}, chips),
        element("label", {for: "unverified-only"}, only, " unverified only"), this.count);
  }

  chip(verdict) {
    const count = this.rows.filter((row) => row.result.verdict === verdict).length;
    const chip = element("button", {type: "button", class: "chip", "aria-pressed": "true", onclick: () => {
      if (!this.wanted.delete(verdict)) this.wanted.add(verdict);
      chip.setAttribute("aria-pressed", String(this.wanted.has(verdict)));
      this.show();
    }}, verdictBadge(verdict), ` ${count}`);
    return chip;
  }

  isShown(row) {
    return this.wanted.has(row.result.verdict) && (!this.isUnverifiedOnly || isUnverified(row)) &&
        (this.text === "" || searchText(row).includes(this.text));
  }

  show() {
    this.shown = this.rows.filter((row) => this.isShown(row));
    this.most = kLinesAtATime;
    this.called = null;
    this.place();
    replaceContent(this.count, `${part(this.shown.length, this.rows.length)} cases shown`);
  }

  isOpen(row) {
    return row.opener?.getAttribute("aria-expanded") === "true";
  }

  fill(row) {
    if (!row.cell.hasChildNodes()) row.cell.append(caseDetail(row));
  }

  open(row) {
    this.fill(row);
    row.opener.setAttribute("aria-expanded", "true");
    row.detail.hidden = false;
  }

  toggle(row) {
    if (!this.isOpen(row)) return this.open(row);
    row.opener.setAttribute("aria-expanded", "false");
    row.detail.hidden = true;
  }

  // The address of the page: opens its case, whatever the filter hides.
  openAddress() {
    const address = decodedAddress();
    const row = this.rows.find((one) => one.address === address);
    if (!row) return;
    this.called = row;
    this.place();
    this.open(row);
    row.line.scrollIntoView({block: "start"});
    row.opener.focus({preventScroll: true});
  }

  fillForPaper() {
    const loud = this.rows.filter(({ result }) => !kNeedsNoDetails.has(result.verdict));
    for (const row of loud.slice(0, kMostLinesOnPaper)) {
      if (!row.line?.isConnected) this.body.append(this.lineOf(row), row.detail);
    }
    for (const row of loud.slice(0, kMostOnPaper)) {
      this.fill(row);
      row.detail.classList.add("on-paper");
    }
    replaceContent(this.forPaper, paperList(this.rows.filter(({ result }) => kNeedsNoDetails.has(result.verdict)), loud.length));
  }

  forPaper = element("div", {class: "paper-only"});
}

// Names in columns, by protocol, role and group.
function paperList(rows, loud) {
  const groups = new Map();
  for (const row of rows.slice(0, kMostNames)) {
    const words = row.result.id.split("/");
    const name = `${row.result.verdict === "pass" ? "Passed" : "Not applicable"}: ${words.slice(0, -1).join("/")}`;
    if (!groups.has(name)) groups.set(name, new Map());
    const names = groups.get(name);
    names.set(words.at(-1), (names.get(words.at(-1)) ?? 0) + 1);
  }
  const listed = [...groups].map(([name, names]) => element("li", {}, element("strong", {}, name), " ",
      [...names].map(([one, times]) => (times > 1 ? `${one} (${times} times)` : one)).join(", ")));
  return [loud > kMostOnPaper ? notice(`Of ${loud} cases that did not pass, the first ${kMostOnPaper} stand here with their details` +
      `${loud > kMostLinesOnPaper ? `, ${kMostLinesOnPaper} with a line` : ""}; the page itself has all.`) : null,
    listed.length ? element("ul", {class: "names-on-paper"}, listed) : null,
    rows.length > kMostNames ? element("p", {}, `${part(rows.length - kMostNames, rows.length)} such cases are not named on paper.`) : null];
}

function decodedAddress() {
  try {
    return decodeURIComponent(location.hash.slice(1));
  } catch {
    return "";
  }
}

export function caseSection(data) {
  if (data.runs.length === 0) return null;
  const cases = new CaseTable(data);
  addEventListener("hashchange", () => cases.openAddress());
  addEventListener("beforeprint", () => cases.fillForPaper());
  matchMedia("print").addEventListener("change", () => cases.fillForPaper());
  const place = section("cases", "Cases", cases.controls(), cases.table, cases.more, cases.forPaper);
  place.openAddress = () => cases.openAddress();
  return place;
}
