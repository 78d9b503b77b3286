// What was looked at, of how much there is.
import { standingText } from "./case_detail.js";
import { element, section } from "./dom.js";
import { part } from "./format.js";
import { mutantsCaught } from "./matrix.js";
import { documentsOf } from "./summary.js";
import { table } from "./table.js";

function groupOf(id) {
  const end = id.indexOf("/", id.indexOf("/") + 1);
  return end < 0 ? id : id.slice(0, end);
}

function isJudged({ verdict }) {
  return verdict !== "none" && verdict !== "not-applicable";
}

// By protocol and role that took part in the run: in the catalogue, with a result, judged.
function groups(run, catalogue) {
  const isKnown = run.results.run.suite_version === catalogue.suite_version;
  const rows = new Map();
  for (const { id, verdict, reference } of run.results.cases) {
    const name = groupOf(id);
    if (!rows.has(name)) rows.set(name, {name, known: isKnown ? catalogue.roles[name] ?? 0 : 0, results: 0, judged: 0, passed: 0, unverified: 0});
    const row = rows.get(name);
    row.results += 1;
    row.judged += isJudged({verdict}) ? 1 : 0;
    row.passed += verdict === "pass" ? 1 : 0;
    row.unverified += reference.verified ? 0 : 1;
  }
  return [...rows.values()];
}

function sum(rows, key) {
  return rows.reduce((total, row) => total + row[key], 0);
}

function coverageOf(run, catalogue) {
  const rows = groups(run, catalogue);
  const keys = ["known", "results", "judged", "passed", "unverified"];
  rows.push({name: "all", class: "sum", ...Object.fromEntries(keys.map((key) => [key, sum(rows, key)]))});
  const column = (title, cell) => ({title, kind: "number", cell});
  const whole = (row) => row.known || row.results;
  return [
    table(`Coverage of ${run.name}`, [
      {title: "cases", cell: (row) => row.name},
      column("with a result, of the catalogue", (row) => (row.known ? part(row.results, row.known) : "the catalogue is another")),
      column("judged, of the catalogue", (row) => part(row.judged, whole(row))),
      column("passed, of the judged", (row) => part(row.passed, row.judged)),
      column("resting on an unverified source", (row) => part(row.unverified, row.results)),
    ], rows),
    element("p", {class: "quiet"}, `Selected: ${run.results.counts.selected}; not run: ${run.results.counts.not_run}.`),
    standings(run),
  ];
}

function standings(run) {
  const byStanding = new Map();
  for (const { reference } of run.results.cases) {
    const row = byStanding.get(reference.standing) ?? {reference, count: 0};
    row.count += 1;
    byStanding.set(reference.standing, row);
  }
  const rows = [...byStanding.values()].sort((a, b) => Number(b.reference.verified) - Number(a.reference.verified) || b.count - a.count);
  return table(`What the requirements of ${run.name} rest on`, [
    {title: "standing", cell: ({reference}) => reference.standing},
    {title: "meaning", cell: ({reference}) => standingText(reference)},
    {title: "", cell: ({reference}) => (reference.verified ? "verified" : element("span", {class: "unverified"}, "unverified"))},
    {title: "cases", kind: "number", cell: ({count}) => part(count, run.results.cases.length)},
  ], rows);
}

function caughtPart({ name, content }) {
  return table(`Mutants caught, ${name}`, [
    {title: "role", cell: (role) => `${content.protocol}/${role.role}`},
    {title: "mutants caught", kind: "number", cell: (role) => part(mutantsCaught(role), role.mutants.length)},
    {title: "cases", kind: "number", cell: (role) => String(role.cases.length)},
  ], content.roles);
}

export function coverageSection(data) {
  const matrices = documentsOf(data, "fieldproof/matrix/1");
  if (data.runs.length + matrices.length === 0) return null;
  const hint = matrices.length ? null : element("p", {class: "quiet"}, "How many mutants the cases catch is reported by ",
      element("code", {}, "fieldproof matrix PROTOCOL --json F"), ", given to the same report.");
  return section("coverage", "Coverage", data.runs.map((run) => coverageOf(run, data.catalogue)), matrices.map(caughtPart), hint);
}
