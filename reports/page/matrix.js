// Cases and mutants: which case catches which mutant of the reference.
import { definitions, element, folded, notice, section } from "./dom.js";
import { number, part } from "./format.js";
import { later } from "./later.js";
import { documentCommand, documentsOf } from "./summary.js";

const kCells = {
  caught: ["#", "caught for the declared reason"],
  "caught-undeclared": ["+", "caught, not declared"],
  passed: ["·", "passes"],
  "not-applicable": ["-", "not applicable"],
  missed: ["!", "declared, but not caught"],
  "wrong-cause": ["X", "caught for another reason, or an error"],
  "not-run": [" ", "not run"],
};

function cell({ kind, verdict, reason, declared }, column) {
  const [sign, meaning] = kCells[kind];
  const told = [meaning, reason ?? "", declared && declared !== reason ? `declared: ${declared}` : ""].filter(Boolean).join("; ");
  return element("td", {class: `cell ${kind}`, title: `${column}: ${verdict}, ${told}`}, sign);
}

function shortId(id) {
  return id.split("/").slice(2).join("/") || id;
}

export function mutantsCaught(role) {
  const isCaught = (at) => role.cases.some(({ cells }) => cells[at].kind === "caught" || cells[at].kind === "caught-undeclared");
  return role.mutants.filter((mutant, at) => isCaught(at)).length;
}

// Its label, or its place in the list.
function labelOf(role, mutant) {
  return mutant.label || String(role.mutants.indexOf(mutant) + 1);
}

function roleTable(role) {
  const mutants = role.mutants.map((one) => ({...one, label: labelOf(role, one)}));
  const columns = [{label: "ref", name: "the reference itself"}, ...mutants];
  const head = element("tr", {}, element("th", {scope: "col"}, "case"),
      columns.map((one) => element("th", {scope: "col", class: "upright", title: one.description ?? one.name}, element("span", {}, one.label))));
  const rows = role.cases.map((one) => element("tr", {},
      element("th", {scope: "row", title: one.id}, `${one.purpose} `, element("span", {class: "quiet"}, shortId(one.id))),
      [one.reference, ...one.cells].map((each, at) => cell(each, columns[at].name))));
  const label = `${role.role}: cases and mutants`;
  return element("div", {class: "scroll", role: "region", tabindex: "0", "aria-label": label},
      element("table", {class: "matrix"}, element("caption", {}, label), element("thead", {}, head), element("tbody", {}, rows)));
}

function rolePart(role) {
  const names = folded(`The mutants of the ${role.role}`, element("dl", {class: "names"}, role.mutants.map((one) => [
        element("dt", {}, labelOf(role, one), " ", element("code", {}, one.name)), element("dd", {}, one.description)])));
  return element("article", {}, element("h4", {}, `${role.role}: `, `${part(mutantsCaught(role), role.mutants.length)} mutants caught by `,
      `${number(role.cases.length)} cases`), later(() => roleTable(role)), names);
}

function holesPart(content) {
  if (!content.complete) return notice(element("strong", {}, "The matrix is incomplete."), " What was not run is no proof.");
  if (content.holes.length === 0) return element("p", {}, "No hole: each mutant is caught, each case catches, and the reference passes.");
  return notice(element("strong", {}, `${number(content.holes.length)} holes`),
      element("ul", {}, content.holes.map((hole) => element("li", {}, `${hole.kind}: ${hole.sentence}`))));
}

function matrixPart({ name, content }) {
  const legend = element("ul", {class: "legend"}, Object.entries(kCells).filter(([kind]) => kind !== "not-run")
      .map(([kind, [sign, meaning]]) => element("li", {}, element("span", {class: `cell ${kind}`}, sign), meaning)));
  return element("article", {}, element("h3", {}, content.protocol), definitions([["Document", name], ["Seed", content.seed]]),
      documentCommand(content, name), holesPart(content), legend, content.roles.map(rolePart));
}

export function matrixSection(data) {
  const documents = documentsOf(data, "fieldproof/matrix/1");
  return documents.length ? section("matrix", "Cases and mutants", documents.map(matrixPart)) : null;
}
