// On paper, tables of raw numbers stand at the end, and in their places it says where. On a screen they stay.
import { element, section } from "./dom.js";

const kRaw = "table.raw, table.many";
const kWithRaw = ["fieldproof/measurement/1", "fieldproof/emc/1", "fieldproof/residual/1", "fieldproof/emc_fit/1"];

function moveToEnd(place) {
  for (const table of document.querySelectorAll(kRaw)) {
    const box = table.closest(".scroll");
    if (!box || place.contains(box)) continue;
    const number = place.querySelectorAll(".raw-table").length + 1;
    const owner = box.closest("section")?.querySelector("h2")?.textContent ?? "";
    const mark = element("p", {class: "quiet"}, `${table.caption.textContent}: see table A${number} in the appendix.`);
    box.replaceWith(mark);
    const moved = element("div", {class: "raw-table"}, element("h3", {}, `A${number}. ${owner}`), box);
    moved.goBack = () => { mark.replaceWith(box); moved.remove(); };
    place.append(moved);
  }
}

function moveBack(place) {
  for (const moved of place.querySelectorAll(".raw-table")) moved.goBack();
}

export function appendixSection(data) {
  const isOfRuns = data.history || data.comparison?.drifts.length > 0;
  if (!isOfRuns && !data.documents.some(({ content }) => kWithRaw.includes(content.schema))) return null;
  const place = section("appendix", "Appendix: tables of all numbers");
  place.classList.add("paper-only");
  addEventListener("beforeprint", () => moveToEnd(place));
  addEventListener("afterprint", () => moveBack(place));
  matchMedia("print").addEventListener("change", ({ matches }) => (matches ? moveToEnd(place) : moveBack(place)));
  return place;
}
