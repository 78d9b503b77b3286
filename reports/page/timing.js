// Measurements: theory beside measurement, distributions with histograms, and input and output as on an
// oscilloscope.
import { histogram, oscilloscope } from "./charts.js";
import { definitions, element, section } from "./dom.js";
import { fixed, number, part } from "./format.js";
import { later } from "./later.js";
import { documentCommand, documentsOf } from "./summary.js";
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

function comparisons(series) {
  if (series.comparisons.length === 0) return null;
  return table(`${series.name}: theory and measurement`, [
    {title: "quantity", cell: (one) => one.quantity},
    {title: "phase", cell: (one) => one.phase ?? "quiet"},
    {title: "theory", kind: "number", cell: (one) => `${one.is_bound ? "at most " : ""}${number(one.theory)} ${one.unit}`},
    {title: "measured", kind: "number", cell: (one) => `${number(one.measured)} ${one.unit}`},
    {title: "deviation", kind: "number", cell: (one) => `${fixed(one.deviation_percent, 3)} % ${one.whole}`},
    {title: "standard error", kind: "number", cell: (one) => number(one.standard_error, 3)},
    {title: "agreement", cell: (one) => agreementMark(one.agreement)},
  ], series.comparisons);
}

function phasesOf(series) {
  return series.distributions.flatMap(({ quantity, unit, phases }) =>
      Object.entries(phases).map(([phase, values]) => ({quantity, unit, phase, values})));
}

function distributions(series, phases) {
  const quantile = (key) => ({values}) => `${values.exact_quantiles ? "" : "~"}${number(values[key])}`;
  const column = (title, key, cell = ({values}) => number(values[key])) => ({title, kind: "number", cell});
  return table(`${series.name}: distributions`, [
    {title: "quantity", cell: ({quantity, unit}) => `${quantity}, ${unit}`},
    {title: "phase", cell: ({phase}) => phase},
    column("count", "count"), column("min", "min"), column("mean", "mean"), column("p50", "p50", quantile("p50")),
    column("p99", "p99", quantile("p99")), column("p99.99", "p99_99", quantile("p99_99")), column("max", "max"),
    column("sd", "standard_deviation"),
  ], phases);
}

function histograms(phases) {
  return element("div", {class: "charts"}, phases.map(({quantity, unit, phase, values}) => {
    const title = `${quantity}, ${phase}`;
    const range = values.min === values.max ? `always ${number(values.min)} ${unit}`
        : `${number(values.min)} to ${number(values.max)} ${unit}, mean ${number(values.mean)}`;
    return element("figure", {}, histogram(`Histogram of ${title}: ${range}`, unit, values.histogram),
        element("figcaption", {}, title, element("span", {class: "quiet"}, ` ${number(values.count)} values, ${range}`)));
  }));
}

function counts(series) {
  return definitions(series.counts.map((one) => [one.what, one.of === 0 ? number(one.count) : part(one.count, one.of)]));
}

export function traceFigure(name, trace) {
  if (trace.length_us <= 0) return null;
  return element("figure", {class: "wide"},
      oscilloscope(`${name}: input with ${number(trace.input.length)} edges above output with ${number(trace.output.length)} edges`, trace),
      element("figcaption", {}, `${name}: input and output`,
          element("span", {class: "quiet"}, ` ${number(trace.length_us / 1000)} ms; drag to zoom, a double click shows all`)));
}

function seriesPart(series) {
  const phases = phasesOf(series);
  return element("article", {}, element("h4", {}, series.name), traceFigure(series.name, series.trace), comparisons(series),
      phases.length ? [distributions(series, phases), histograms(phases)] : null, counts(series));
}

function measurementPart({ name, content }) {
  return element("article", {},
      element("h3", {}, `${content.network} `, agreementMark(content.agreement)),
      (content.failures ?? []).map((failure) => element("p", {}, element("span", {class: "verdict fail"}, "fail"), ` ${failure}`)),
      definitions([["Document", name], ["Protocol", content.protocol], ["Seed", content.seed],
        ["Tolerance", `${number(content.tolerance_percent)} %`], ...content.conditions.map((one) => [one.name, one.value])]),
      documentCommand(content, name), content.series.map((series) => later(() => seriesPart(series))));
}

export function timingSection(data) {
  const documents = documentsOf(data, "fieldproof/measurement/1");
  return documents.length ? section("timing", "Timing and skew", documents.map(measurementPart)) : null;
}
