// Reads the data of the page and shows them.
import { appendixSection } from "./appendix.js";
import { campaignSection } from "./campaign.js";
import { caseSection } from "./case_table.js";
import { watchCharts } from "./charts.js";
import { comparisonSection } from "./comparison.js";
import { coverSection } from "./cover.js";
import { coverageSection } from "./coverage.js";
import { unpack } from "./data.js";
import { detectionSection } from "./detection.js";
import { append, element, replaceContent, visible } from "./dom.js";
import { fitSection } from "./fit.js";
import { fuzzSection } from "./fuzz.js";
import { historySection } from "./history.js";
import { immunitySection } from "./immunity.js";
import { makeLater } from "./later.js";
import { matrixSection } from "./matrix.js";
import { publicationSection } from "./publication.js";
import { residualSection } from "./residual.js";
import { summarySection } from "./summary.js";
import { timingSection } from "./timing.js";

const kSections = [coverSection, summarySection, comparisonSection, historySection, campaignSection, caseSection, timingSection, immunitySection, fuzzSection, fitSection, residualSection, publicationSection,
  matrixSection, detectionSection, coverageSection, appendixSection];

// The same verdict in the title, the headline and the icon of the tab.
function titleOf({ joined, cover, runs }) {
  const verdict = joined.verdict === "none" ? "" : `${joined.verdict}: `;
  const what = cover?.title || (runs.length === 1 ? `${joined.sentence}, seed ${runs[0].results.run.seed}` : joined.sentence);
  return `${verdict}${what}`;
}

const kIconColours = {pass: "#1a7037", fail: "#b3261e", error: "#84207a", warn: "#b57b00", inconclusive: "#b57b00"};

function showIcon(verdict) {
  const picture = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 8 8"><circle cx="4" cy="4" r="4" fill="${kIconColours[verdict] ?? "#57606a"}"/></svg>`;
  document.querySelector("link[rel=icon]").href = `data:image/svg+xml,${encodeURIComponent(picture)}`;
}

// For paper, where no head with links is.
function contentsList(sections) {
  return element("nav", {class: "contents", "aria-label": "Contents"}, element("h2", {}, "Contents"),
      element("ol", {}, sections.map((one) => element("li", {}, element("a", {href: `#${one.id}`}, shortName(one))))));
}

// The title of a cover is any text, and its place is the first.
function shortName(place) {
  return place.id === "cover" ? "Cover" : place.querySelector("h2").textContent;
}

function showPage() {
  const data = unpack(JSON.parse(document.getElementById("data").textContent));
  document.title = visible(titleOf(data));
  showIcon(data.joined.verdict);
  makeLater();
  const sections = kSections.map((make) => make(data)).filter(Boolean);
  const [first, ...others] = sections;
  replaceContent(document.getElementById("content"), element("h1", {class: "unseen"}, titleOf(data)), first, contentsList(sections), others);
  append(document.getElementById("sections"), sections.filter((one) => !one.classList.contains("paper-only")).map((one) => element("a", {href: `#${one.id}`}, shortName(one))));
  append(document.getElementById("end"), [element("p", {},
      "One file, no network: this page asks for nothing. Simulated time is virtual; what a source does not verify is marked unverified. ",
      "Charts by uPlot (MIT licence, in the source of this page).")]);
  watchCharts();
  sections.find((one) => one.id === "cases")?.openAddress();
}

showPage();
