// Reads the data of the page and shows them.
import { caseSection } from "./case_table.js";
import { watchCharts } from "./charts.js";
import { coverageSection } from "./coverage.js";
import { append, element, replaceContent, visible } from "./dom.js";
import { immunitySection } from "./immunity.js";
import { makeLater } from "./later.js";
import { matrixSection } from "./matrix.js";
import { publicationSection } from "./publication.js";
import { residualSection } from "./residual.js";
import { summarySection } from "./summary.js";
import { timingSection } from "./timing.js";

const kSections = [summarySection, caseSection, timingSection, immunitySection, residualSection, publicationSection, matrixSection,
  coverageSection];

function titleOf(data) {
  const [run] = data.runs;
  if (!run) return "fieldproof report";
  return `${run.results.headline}: ${run.results.run.selectors.join(" ") || "all cases"}, seed ${run.results.run.seed}`;
}

function showPage() {
  const data = JSON.parse(document.getElementById("data").textContent);
  document.title = visible(titleOf(data));
  const sections = kSections.map((make) => make(data)).filter(Boolean);
  replaceContent(document.getElementById("content"), element("h1", {class: "unseen"}, titleOf(data)), sections);
  append(document.getElementById("sections"), sections.map((one) => element("a", {href: `#${one.id}`}, one.querySelector("h2").textContent)));
  append(document.getElementById("end"), [element("p", {},
      "One file, no network: this page asks for nothing. Simulated time is virtual; what a source does not verify is marked unverified. ",
      "Charts by uPlot (MIT licence, in the source of this page).")]);
  makeLater();
  watchCharts();
  sections.find((one) => one.id === "cases")?.openAddress();
}

showPage();
