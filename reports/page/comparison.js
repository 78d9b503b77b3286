// Two runs side by side: what changed from the first to the second, and for a case that changed both time lines.
import { verdictBadge } from "./case_table.js";
import { breakable, definitions, element, folded, notice, section } from "./dom.js";
import { number, plural } from "./format.js";
import { later } from "./later.js";
import { table } from "./table.js";
import { timeLine } from "./time_line.js";

const kMostSideBySide = 40;

function endOf(verdict, reason) {
  return [verdict === "none" ? element("span", {class: "quiet"}, "not there") : verdictBadge(verdict), reason ? [" ", breakable(reason)] : null];
}

function changesTable(title, changes) {
  if (changes.length === 0) return null;
  return table(`${title} (${number(changes.length)})`, [
    {title: "case", cell: (one) => element("a", {href: `#${encodeURI(`2:${one.id}`)}`}, breakable(one.id))},
    {title: "before", cell: (one) => endOf(one.before, one.reason_before)},
    {title: "after", cell: (one) => endOf(one.after, one.reason_after)},
  ], changes);
}

function idList(title, ids) {
  return ids.length === 0 ? null : folded(`${title} (${number(ids.length)})`, element("ul", {class: "plain"}, ids.map((id) => element("li", {}, breakable(id)))));
}

function driftsTable(drifts) {
  if (drifts.length === 0) return null;
  return table(`Measurements that moved (${number(drifts.length)})`, [
    {title: "case", cell: (one) => breakable(one.id)},
    {title: "measured", cell: (one) => one.measurement},
    {title: "before", kind: "number", cell: (one) => `${number(one.before)} ${one.unit}`},
    {title: "after", kind: "number", cell: (one) => `${number(one.after)} ${one.unit}`},
    {title: "moved by", kind: "number", cell: (one) => (typeof one.relative === "number" ? `${number(100 * one.relative, 3)} %` : "")},
  ], drifts, "many");
}

// One half of a pair: how the case ended in a run, and its time line there.
function sideOf(run, id, what) {
  const result = run.results.cases.find((one) => one.id === id);
  const more = run.cases[id] ?? {};
  const missing = more.timeline_left_out ? "Its time line is not in this page, which holds as many as fit."
      : "No time line is stored of it: --record all keeps those of cases that pass, too.";
  return element("div", {class: "side"}, element("h5", {}, `${what}: ${run.name} `, result ? verdictBadge(result.verdict) : "not there"),
      result?.findings[0] ? element("p", {}, result.findings[0].actual) : null,
      more.timeline ? timeLine(more.timeline) : element("p", {class: "quiet"}, missing));
}

// Without any time line there is nothing to look at side by side.
function sidesPart([before, after], {new_failures: failures, fixed, changed}) {
  const ids = [...failures, ...fixed, ...changed].map(({id}) => id).filter((id) => before.cases[id]?.timeline || after.cases[id]?.timeline);
  if (ids.length === 0) return null;
  return [element("h4", {}, "Before and after, side by side"), ids.slice(0, kMostSideBySide).map((id, at) => {
    const place = folded(id, element("div"));
    place.classList.add("pair");
    const open = () => place.lastChild.replaceWith(element("div", {class: "sides"}, sideOf(before, id, "before"), sideOf(after, id, "after")));
    place.addEventListener("toggle", open, {once: true});
    if (at === 0) place.open = true;
    return place;
  }), ids.length > kMostSideBySide ? notice(`${number(ids.length - kMostSideBySide)} more are below, each run by itself.`) : null];
}

function sameTable([before, after], difference) {
  const isOther = new Set([...difference.new_failures, ...difference.fixed, ...difference.changed].map(({id}) => id));
  const known = new Map(before.results.cases.map((one) => [one.id, one]));
  const same = after.results.cases.filter((one) => known.has(one.id) && !isOther.has(one.id));
  if (same.length === 0) return null;
  const kMost = 2000;
  return folded(`${plural(same.length, "case")} ended as before`, later(() => table("As before", [
    {title: "case", cell: (one) => breakable(one.id)},
    {title: "before and after", cell: (one) => endOf(one.verdict, one.reason)},
  ], same.slice(0, kMost))), same.length > kMost ? notice(`The first ${number(kMost)} of ${number(same.length)} are shown.`) : null);
}

export function comparisonSection({runs, comparison: difference}) {
  if (!difference) return null;
  const [before, after] = runs;
  const changes = [["New failures", difference.new_failures], ["Fixed", difference.fixed], ["Changed otherwise", difference.changed]];
  return section("comparison", "Before and after", definitions([["Before", before.name], ["After", after.name]]),
      difference.incomplete.map((one) => notice(element("strong", {}, "Not all is known"), `: ${one}`)),
      difference.identity.length ? element("ul", {class: "plain"}, difference.identity.map((one) => element("li", {}, one))) : null,
      changes.map(([title, list]) => changesTable(title, list)),
      changes.every(([, list]) => list.length === 0) ? element("p", {}, "No case changed its verdict or its reason.") : null,
      idList("Cases that the first run does not have", difference.appeared), idList("Cases that the second run does not have", difference.disappeared),
      sidesPart(runs, difference), driftsTable(difference.drifts),
      difference.fingerprints.length ? element("p", {}, `${plural(difference.fingerprints.length, "case")} with an equal seed drove the line otherwise than before.`) : null,
      sameTable(runs, difference));
}
