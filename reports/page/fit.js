// Counts of a laboratory beside the burst model that was fitted to them.
import { verdictBadge } from "./case_table.js";
import { chartFigure, countedShares } from "./charts.js";
import { grouped } from "./data.js";
import { definitions, element, section } from "./dom.js";
import { number, part, scientific } from "./format.js";
import { later } from "./later.js";
import { documentCommand, documentsOf } from "./summary.js";
import { table } from "./table.js";

const kFitVerdicts = {
  consistent: ["pass", "the counts follow level, repetition and polarity as the model says"],
  contradicts: ["fail", "no gain and strength explain them: another mechanism, or another frame or profile than said"],
  open: ["inconclusive", "too few conditions with errors to put the model to the test"],
};

function endText(value, isOpen, word) {
  return isOpen ? `${word} ${number(value, 3)}` : number(value, 3);
}

function factors(content) {
  return table("What was fitted", [
    {title: "parameter", cell: ([name]) => name},
    {title: "likeliest", kind: "number", cell: ([, one]) => number(one.value, 3)},
    {title: "95 % from", kind: "number", cell: ([, one]) => endText(one.from, one.is_open_below, "below")},
    {title: "to", kind: "number", cell: ([, one]) => endText(one.to, one.is_open_above, "above")},
    {title: "meaning", kind: "text", cell: ([, , meaning]) => meaning},
  ], [["gain", content.gain, "a factor on the voltage"], ["strength", content.strength, "a factor on how often a pulse corrupts a frame"]]);
}

function sigmaText({frames, frames_bad: bad, expected_bad: expected}) {
  const sigma = Math.sqrt(expected * (1 - expected / frames));
  return sigma > 0 ? `${bad >= expected ? "+" : "−"}${Math.abs((bad - expected) / sigma).toFixed(1)}` : "";
}

function conditions(content) {
  return table("Counted beside fitted", [
    {title: "level", kind: "number", cell: (row) => `${number(row.level_v)} V`},
    {title: "pulses", cell: pulsesOf},
    {title: "time", kind: "number", cell: (row) => `${number(row.time_s)} s`},
    {title: "frames", kind: "number", cell: (row) => number(row.frames)},
    {title: "bad", kind: "number", cell: (row) => number(row.frames_bad)},
    {title: "fitted", kind: "number", cell: (row) => number(row.expected_bad, 4)},
    {title: "off by, sigma", kind: "number", cell: sigmaText},
    {title: "undetected", kind: "number", cell: (row) => number(row.undetected)},
  ], content.rows, "many");
}

function pulsesOf({repetition, polarity}) {
  return `${repetition} ${polarity === "-" ? "−" : polarity}`;
}

// A chart for each repetition rate, with both polarities.
function shareCharts(content) {
  const rates = grouped(content.rows.filter((row) => row.frames > 0), (row) => row.repetition);
  return element("div", {class: "charts"}, rates.map(([rate, all]) => {
    const series = grouped(all, pulsesOf).map(([name, rows]) => ({name, rows: rows.toSorted((a, b) => a.level_v - b.level_v)}));
    return chartFigure(`Bad frames over the level, ${rate}`, "points: counted, with the 95 % interval of Wilson; lines: fitted",
        countedShares(`Share of bad frames over the level, counted and fitted, at ${rate}`, series),
        series.map(({name}, at) => ({colour: ["accent", "second", "third"][at], text: name})));
  }));
}

function fitPart({ name, content }) {
  const [verdict, meaning] = kFitVerdicts[content.verdict];
  const {bad, undetected, upper_bound_of_share: bound} = content.undetected;
  return element("article", {}, element("h3", {}, verdictBadge(verdict), ` ${content.network}`), element("p", {}, `${content.verdict}: ${meaning}.`),
      definitions([["Document", name], ["Protocol", content.protocol], ["Profile", content.profile],
        ["Frame", `${number(content.bits)} bits at ${number(content.bit_rate)} bit/s`],
        ["Chi-squared", `${number(content.chi_squared, 3)} with ${number(content.degrees_of_freedom)} degrees of freedom, p = ${number(content.probability, 3)}`],
        ["Undetected", bad === 0 ? "no frame was bad" : `${part(undetected, bad)} bad frames, at most ${scientific(bound)} (one-sided 95 %)`]]),
      documentCommand(content, name), factors(content), later(() => shareCharts(content)), conditions(content));
}

export function fitSection(data) {
  const documents = documentsOf(data, "fieldproof/emc_fit/1");
  return documents.length ? section("fit", "Counts of a laboratory", documents.map(fitPart)) : null;
}
