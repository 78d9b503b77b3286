// The table of cases: filtered by text, verdict and standing, sorted by its heads; a row opens to all that is
// known of its case. A case has the address #<id>; in a page of several runs the later ones have #<n>:<id>.
import { breakable, element, replaceContent, section } from "./dom.js";
import { caseDetail, unverifiedMark } from "./case_detail.js";
import { duration, part } from "./format.js";
import { cellOf, sortableHead } from "./table.js";

export const kVerdicts = ["error", "fail", "inconclusive", "warn", "pass", "not-applicable", "none"];

// What a reader of paper needs no details of, unless it was opened.
const kNeedsNoDetails = new Set(["pass", "not-applicable"]);

const kWeight = new Map(kVerdicts.map((verdict, at) => [verdict, at]));

export function verdictBadge(verdict) {
  return element("span", {class: `verdict ${verdict}`}, verdict === "not-applicable" ? "n/a" : verdict);
}

function rowsOf(data) {
  return data.runs.flatMap((run, at) => {
    const isSameSuite = run.results.run.suite_version === data.catalogue.suite_version;
    return run.results.cases.map((result, position) => ({
      result, run, position: at * 1e6 + position,
      more: run.cases[result.id] ?? {command: "", wall_time_us: "0"},
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
    {title: "Wall time", kind: "number", cell: (row) => duration(Number(row.more.wall_time_us)), value: (row) => Number(row.more.wall_time_us)},
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
    this.body = element("tbody");
    for (const row of this.rows) this.make(row);
    this.rows.sort((a, b) => kWeight.get(a.result.verdict) - kWeight.get(b.result.verdict) || a.position - b.position);
    this.count = element("p", {class: "count", role: "status"});
    this.table = element("table", {class: "cases"},
        element("caption", {class: "unseen"}, "Cases; a row opens to its findings"), sortableHead(this.columns, (compare) => this.order(compare)), this.body);
    this.place();
    this.show();
  }

  make(row) {
    const detailId = `detail-${row.address}`;
    row.opener = element("button", {type: "button", class: "opener", "aria-expanded": "false", "aria-controls": detailId,
      onclick: () => this.toggle(row)}, breakable(row.result.id));
    row.search = searchText(row);
    row.isUnverified = isUnverified(row);
    row.cell = element("td", {colspan: this.columns.length});
    row.detail = element("tr", {class: "detail", id: detailId, hidden: true}, row.cell);
    const link = element("a", {class: "anchor", href: `#${encodeURI(row.address)}`, "aria-label": `Link to ${row.result.id}`}, "#");
    row.line = element("tr", {class: `case ${row.result.verdict}${kNeedsNoDetails.has(row.result.verdict) ? " quiet" : ""}`, id: row.address}, this.columns.map((column) => cellOf(column, row)));
    row.opener.after(link);
  }

  place() {
    this.body.replaceChildren(...this.rows.flatMap((row) => [row.line, row.detail]));
  }

  order(compare) {
    this.rows.sort((a, b) => compare(a, b) || a.position - b.position);
    this.place();
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
    return this.wanted.has(row.result.verdict) && (!this.isUnverifiedOnly || row.isUnverified) && row.search.includes(this.text);
  }

  show() {
    let count = 0;
    for (const row of this.rows) {
      const isShown = this.isShown(row);
      count += isShown ? 1 : 0;
      row.line.hidden = !isShown;
      row.detail.hidden = !isShown || !this.isOpen(row);
    }
    replaceContent(this.count, `${part(count, this.rows.length)} cases shown`);
  }

  isOpen(row) {
    return row.opener.getAttribute("aria-expanded") === "true";
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
    this.open(row);
    row.line.hidden = false;
    row.line.scrollIntoView({block: "start"});
    row.opener.focus({preventScroll: true});
  }

  fillForPaper() {
    for (const row of this.rows) {
      if (!kNeedsNoDetails.has(row.result.verdict)) this.fill(row);
    }
  }
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
  const place = section("cases", "Cases", cases.controls(), cases.table);
  place.openAddress = () => cases.openAddress();
  return place;
}
