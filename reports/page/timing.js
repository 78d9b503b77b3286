// Measurements: theory beside measurement, distributions with histograms, and input and output as on an
// oscilloscope.
import { chartFigure, histogram, oscilloscope } from "./charts.js";
import { courseFigure } from "./course.js";
import { definitions, element, notice, section } from "./dom.js";
import { alike, number, part, plural, roundedTimes } from "./format.js";
import { later } from "./later.js";
import { documentCommand, documentsOf, madeText } from "./summary.js";
import { table } from "./table.js";

const kAgreement = {
  holds: "holds",
  open: "open: outside the tolerance, but so few samples show it by chance",
  differs: "differs",
};

function agreementMark(agreement) {
  const verdict = {holds: "pass", open: "inconclusive", differs: "fail"}[agreement];
  return element("span", {class: `verdict ${verdict}`, title: kAgreement[agreement]}, agreement);
}

// What is less than the last decimal shown is an error of the arithmetic, no deviation.
function withoutNoise(percent) {
  return Math.abs(percent) < 0.0005 ? 0 : percent;
}

function comparisons(series) {
  if (series.comparisons.length === 0) return null;
  return table(`${series.name}: theory and measurement`, [
    {title: "quantity", cell: (one) => one.quantity},
    {title: "phase", cell: (one) => one.phase ?? "quiet"},
    {title: "theory", amount: (one) => one.theory, show: (text, one) => `${one.is_bound ? "at most " : ""}${text} ${one.unit}`},
    {title: "measured", amount: (one) => one.measured, show: (text, one) => `${text} ${one.unit}`},
    {title: "deviation", amount: (one) => withoutNoise(one.deviation_percent), show: (text, one) => `${text} % ${one.whole}`},
    {title: "standard error", amount: (one) => one.standard_error},
    {title: "agreement", cell: (one) => agreementMark(one.agreement)},
  ], series.comparisons);
}

function phasesOf(series) {
  return series.distributions.flatMap(({ quantity, unit, phases }) =>
      Object.entries(phases).map(([phase, values]) => ({quantity, unit, phase, values})));
}

// All numbers of the table have the same decimals, for the eye to go along a row and down a column.
function distributions(series, phases) {
  const kKeys = ["min", "mean", "p50", "p99", "p99_99", "max", "standard_deviation"];
  const kTitles = {p99_99: "p99.99", standard_deviation: "sd"};
  const text = alike(phases.flatMap(({values}) => kKeys.map((key) => values[key])));
  const about = (key, {exact_quantiles: isExact}) => (key.startsWith("p") && !isExact ? "~" : "");
  return table(`${series.name}: distributions`, [
    {title: "quantity", cell: ({quantity, unit}) => `${quantity}, ${unit}`},
    {title: "phase", cell: ({phase}) => phase},
    {title: "count", amount: ({values}) => values.count},
    ...kKeys.map((key) => ({title: kTitles[key] ?? key, kind: "number", cell: ({values}) => about(key, values) + text(values[key])})),
  ], phases, "raw");
}

// The theory of a quantity, where the document compares it: the whole, or the least and the largest.
function limitsOf(series, quantity, phase, tolerance) {
  const limits = [];
  for (const one of series.comparisons.filter((each) => (each.phase ?? "quiet") === phase)) {
    if (one.quantity === quantity && !one.is_bound) {
      limits.push({name: "lower limit", at: one.theory * (1 - tolerance / 100)}, {name: "upper limit", at: one.theory * (1 + tolerance / 100)});
    } else if (one.quantity === quantity) {
      limits.push({name: "limit", at: one.theory});
    } else if (one.quantity === `least ${quantity}` || one.quantity === `largest ${quantity}`) {
      limits.push({name: `theory, ${one.quantity.split(" ")[0]}`, at: one.theory});
    }
  }
  return limits;
}

function isBeyond({at}, {histogram: bins}) {
  const margin = (bins[0].high - bins[0].low) / 2;
  return at < bins[0].low - margin || at > bins.at(-1).high + margin;
}

// Of so few a picture of bars says nothing.
const kFewestValues = 10;

// What never changes needs no picture; the table says it.
function histograms(series, phases, tolerance) {
  const changing = phases.filter(({values}) => values.min !== values.max && values.histogram.length > 1);
  const worth = changing.filter(({values}) => values.count >= kFewestValues);
  const few = changing.filter(({values}) => values.count < kFewestValues)
      .map(({quantity, phase, values}) => `${quantity}, ${phase} (${plural(values.count, "value")})`);
  const sentence = few.length === 0 ? null
      : element("p", {class: "quiet few-values"}, `No histogram of fewer than ${kFewestValues} values: ${few.join("; ")}. The table has them.`);
  if (worth.length === 0) return sentence;
  return [sentence, element("div", {class: "charts"}, worth.map(({quantity, unit, phase, values}) => {
    const title = `${quantity}, ${phase}`;
    const text = alike([values.min, values.max, values.mean, values.p99]);
    const range = `${text(values.min)} to ${text(values.max)} ${unit}, mean ${text(values.mean)}, p99 ${text(values.p99)}`;
    const marks = [{name: "mean", at: values.mean}, {name: "p99", at: values.p99}, ...limitsOf(series, quantity, phase, tolerance)];
    return chartFigure(title, `${number(values.count)} values, ${range}`, histogram(`Histogram of ${title}: ${range}`, unit, values.histogram, marks),
        [{colour: "accent", text: "count"}, {colour: "third", text: "share up to here, %"},
          ...marks.map((mark, at) => ({colour: "second", dash: at, text: `${mark.name} ${text(mark.at)} ${unit}${isBeyond(mark, values) ? ", beyond the chart" : ""}`}))]);
  }))];
}

function counts(series) {
  return definitions(series.counts.map((one) => [one.what, one.of === 0 ? number(one.count) : part(one.count, one.of)]));
}

export function traceFigure(name, trace) {
  if (trace.length_us <= 0) return null;
  return chartFigure(`${name}: input and output`, `${number(trace.length_us / 1000)} ms`,
      oscilloscope(`${name}: input with ${number(trace.input.length)} edges above output with ${number(trace.output.length)} edges`, trace),
      [{colour: "accent", text: "input"}, {colour: "second", text: "output"}], "wide");
}

function seriesPart(series, tolerance) {
  const phases = phasesOf(series);
  return element("article", {}, element("h4", {}, series.name), traceFigure(series.name, series.trace), comparisons(series), courseFigure(series.course),
      phases.length ? [distributions(series, phases), histograms(series, phases, tolerance)] : null, counts(series));
}

// Caveats are told once, at the head of the page; documents of earlier programs have them here.
function isNoCaveat({ name }) {
  return name !== "unverified";
}

function measurementPart({ name, content }) {
  return element("article", {},
      element("h3", {}, `${content.network} `, agreementMark(content.agreement)),
      (content.failures ?? []).map((failure) => element("p", {}, element("span", {class: "verdict fail"}, "fail"), ` ${failure}`)),
      definitions([["Document", name], ["Protocol", content.protocol], ["Seed", content.seed],
        ["Tolerance", `${number(content.tolerance_percent)} %`], ["Implementation", content.implementations], ["Made", madeText(content)], ...content.conditions.filter(isNoCaveat).map((one) => [one.name, roundedTimes(one.value)])]),
      content.implementations && content.agreement !== "holds" ? notice("The closed forms are those of the reference stations. Others may be faster or slower within what the standard allows, so a difference is no failure here, and a row that is open may be one; 'fieldproof run' judges each station.") : null,
      documentCommand(content, name), content.series.map((series) => later(() => seriesPart(series, content.tolerance_percent))));
}

export function timingSection(data) {
  const documents = documentsOf(data, "fieldproof/measurement/1");
  return documents.length ? section("timing", "Timing and skew", documents.map(measurementPart)) : null;
}
