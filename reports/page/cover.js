// The cover of a page that is handed over: what was tested, with what, and what came out, with limits and
// margins. It is there when the report was asked for one.
import { detectionRows } from "./detection.js";
import { definitions, element, section } from "./dom.js";
import { duration, fixed, number, part, plural, scientific } from "./format.js";
import { criteriaPart, exposedText, longerRun } from "./immunity.js";
import { mutantsCaught } from "./matrix.js";
import { burstsOf, disturbedRows } from "./measured_bursts.js";
import { caveatList, documentsOf, headlineOf, implementationText, partsOf, sentence } from "./summary.js";
import { table } from "./table.js";

function distinct(values) {
  return [...new Set(values.filter(Boolean))];
}

function dates({ runs, documents }) {
  const made = [...runs.map(({ manifest }) => manifest.started), ...documents.map(({ content }) => content.made?.date ?? "")];
  const days = distinct(made.map((one) => one.slice(0, 10))).sort();
  return days.length > 1 ? `${days[0]} to ${days.at(-1)}` : days[0];
}

// Documents of networks name their stations in one text, those of one role as a run does.
function testedIn(content) {
  return Array.isArray(content.implementations) ? implementationText(content) : content.implementations;
}

function testedPart({ runs, documents }) {
  const identities = runs.map(({ results }) => results.run);
  return definitions([
    ["Implementation", distinct([...identities.map(implementationText), ...documents.map(({ content }) => testedIn(content))]).join("; ")],
    ["Suite", distinct(identities.map((one) => one.suite_version)).join("; ")],
    ["Cases", distinct(identities.flatMap((one) => one.selectors)).join(" ")],
    ["Networks", distinct(documents.map(({ content }) => content.network)).join("; ")],
    ["Exposed to the bursts", distinct(documents.map(({ content }) => exposedText(content))).join("; ")],
    ["Declared (PICS), hash", distinct(identities.map((one) => one.pics_hash)).join(", ") || (runs.length ? "nothing is declared" : "")],
  ]);
}

// Who receives the page must not take a model for a laboratory.
function methodText(documents) {
  const has = (schema) => documents.some(({ content }) => content.schema === schema);
  if (!has("fieldproof/emc/1") && !has("fieldproof/measurement/1")) return "";
  return `simulation: the implementation in a simulated network, in virtual time${has("fieldproof/emc/1") || documents.some(({ content }) => burstsOf(content))
    ? "; bursts are an uncalibrated model of IEC 61000-4-4, no laboratory test" : ""}`;
}

// The network, the plan of faults, the profile, the program itself: what is handed over can be compared with it.
function inputsText(contents) {
  return distinct(contents.flatMap(({ inputs }) => inputs ?? []).map(({ path, hash }) => `${path} ${hash || "(not readable)"}`)).join(", ");
}

function benchPart({ runs, documents }) {
  const identities = runs.map(({ results }) => results.run);
  const made = documents.map(({ content }) => content.made).filter(Boolean);
  return definitions([
    ["fieldproof", distinct([...identities, ...made].map((one) => one.tool_version)).join(", ")],
    ["Method", methodText(documents)],
    ["Bursts while measuring", distinct(documents.map(({ content }) => burstsOf(content))).join("; ")],
    ["Date", dates({ runs, documents })],
    ["Host", distinct([...runs.map(({ manifest }) => manifest), ...made].map((one) => one.host)).join(", ")],
    ["Seeds", distinct([...identities, ...documents.map(({ content }) => content)].map((one) => one.seed)).join(", ")],
    ["Inputs, hash", inputsText([...identities, ...documents.map(({ content }) => content)])],
  ]);
}

// Nothing that is measured here is below zero: there it is no limit.
function isOneSided({ low, value }) {
  return low === 0 && value >= 0;
}

// Of each measured quantity of the cases the value that is nearest to a limit of its own.
function tightest(run) {
  const nearest = new Map();
  for (const { measurements } of run.results.cases) {
    for (const one of measurements) {
      if (one.low === one.value && one.high === one.value) continue;
      const margin = isOneSided(one) ? one.high - one.value : Math.min(one.value - one.low, one.high - one.value);
      const known = nearest.get(one.name);
      if (!known || margin < known.margin) nearest.set(one.name, {...one, margin});
    }
  }
  return [...nearest.values()];
}

function rowsOfRun(run, said) {
  const kMost = 12;
  const rows = tightest(run);
  return [{test: run.name, result: sentence(said.sentence), limit: "no failure", margin: ""},
    ...rows.slice(0, kMost).map((one) => ({test: `${run.name}: ${one.name}, the nearest to its limit`, result: `${number(one.value)} ${one.unit}`,
      limit: `${isOneSided(one) ? "at most" : `${number(one.low)} to`} ${number(one.high)} ${one.unit}`, margin: `${number(one.margin)} ${one.unit}`}))];
}

function isOpen({agreement}) {
  return agreement !== "holds";
}

function agreementsText(comparisons) {
  const of = (agreement) => comparisons.filter((one) => one.agreement === agreement).length;
  const said = ["differs", "open"].filter((agreement) => of(agreement) > 0).map((agreement) => `${of(agreement)} ${agreement === "open" ? "open" : "differ"}`);
  return said.join(", ") || "all hold";
}

// What edges need from an input to an output, over all signals and paths: the least and the most.
function skewRow(name, comparisons, tolerance) {
  const least = comparisons.filter((one) => one.quantity.startsWith("least delay"));
  const largest = comparisons.filter((one) => one.quantity.startsWith("largest delay"));
  if (least.length === 0 || largest.length === 0) return [];
  const range = (key) => `${number(Math.min(...least.map((one) => one[key])))} to ${number(Math.max(...largest.map((one) => one[key])))} ${least[0].unit}`;
  return [{test: `${name}: delay from the edge of an input to that of its output (input/output skew)`, result: `${range("measured")} (${agreementsText([...least, ...largest])})`,
    limit: `${range("theory")} \u00b1 ${number(tolerance)} % ${least[0].whole}`, margin: ""}];
}

// Cycle time, jitter and the device's own times one by one, of each the series that deviates most, in the quiet
// phase: bursts and recovery decide nothing. Then the skew of all paths, and how many comparisons more there are.
function rowsOfMeasurement({ name, content }) {
  const tolerance = content.tolerance_percent;
  const worst = new Map();
  const ofPaths = [];
  for (const series of content.series) {
    const quiet = series.comparisons.filter((one) => (one.phase ?? "quiet") === "quiet").map((one) => ({...one, series: series.name}));
    if (quiet.some((one) => one.quantity.startsWith("least delay"))) {
      ofPaths.push(...quiet);
      continue;
    }
    for (const one of quiet) {
      const known = worst.get(one.quantity);
      if (!known || Math.abs(one.deviation_percent) > Math.abs(known.deviation_percent)) worst.set(one.quantity, one);
    }
  }
  const ofWorst = (one) => {
    const over = one.is_bound ? one.deviation_percent : Math.abs(one.deviation_percent);
    const test = `${name}: ${one.quantity}`;
    // A count that has to be 0 has no margin.
    if (one.theory === 0 && one.unit === "") return {test, result: `${number(one.measured)} (${one.agreement})`, limit: "none", margin: ""};
    return {test, result: `${number(one.measured)} ${one.unit} (${one.agreement})`,
      limit: `${one.is_bound ? "at most " : ""}${number(one.theory)} ${one.unit} ${one.is_bound ? "+" : "\u00b1"} ${number(tolerance)} % ${one.whole}`,
      margin: `${fixed(tolerance - over, 2)} % ${one.whole}`};
  };
  const others = ofPaths.filter((one) => !/^(least|largest) delay/.test(one.quantity));
  const open = others.filter(isOpen).map((one) => `${one.quantity}, ${one.series}`);
  return [...[...worst.values()].map(ofWorst), ...content.series.flatMap((series) => disturbedRows(name, series)), ...skewRow(name, ofPaths, tolerance),
    ...(others.length === 0 ? [] : [{test: `${name}: ${plural(others.length, "comparison")} more of delays, widths, duty cycles and losses${open.length ? `; not: ${open.slice(0, 3).join("; ")}${open.length > 3 ? " and others" : ""}` : ""}`,
      result: agreementsText(others), limit: "as the theory of each", margin: ""}])];
}

// Of `--worst`.
const kLimits = {A: "A", B: "B, and no stop", C: "C"};

// What the letter rests on, and what so short a run cannot exclude.
function groundsOf(test) {
  const longer = longerRun(test);
  const grounds = [test.evidence?.text, longer && `with 95 % a longer run could still show ${longer}`].filter(Boolean).join("; ");
  return grounds && ` (${grounds})`;
}

function rowsOfBursts({ name, content }) {
  const levels = distinct(content.tests.map((test) => test.level));
  const rows = levels.map((level) => {
    const tests = content.tests.filter((test) => test.level === level);
    const judged = tests.filter((test) => test.came_up);
    const worst = judged.map((test) => test.criterion).sort().at(-1);
    const stops = tests.filter((test) => test.bus_stops > 0).length;
    const references = judged.filter(({reference}) => reference?.came_up).map(({reference}) => reference.criterion).sort().at(-1);
    const beside = references && (references === worst ? "references alone the same" : `references alone ${references}`);
    const gone = tests.filter((test) => test.came_up && test.complaint);
    const wrong = tests.find((test) => test.first_wrong);
    const said = [worst && `criterion ${worst}${groundsOf(judged.find((test) => test.criterion === worst))}`, beside, wrong && `a wrong word ${wrong.first_wrong}`,
      gone.length > 0 && `${gone[0].decided_by} in ${part(gone.length, tests.length)} tests: ${gone[0].complaint}`,
      stops > 0 && `the bus stopped in ${part(stops, tests.length)} tests`,
      judged.length < tests.length && `the network did not come up in ${part(tests.length - judged.length, tests.length)} tests`];
    return {test: `${name}: bursts, level ${level}`, result: said.filter(Boolean).join(", "),
      limit: kLimits[content.worst_allowed ?? "B"], margin: ""};
  });
  if (content.thresholds) rows.push({test: `${name}: from which voltage on each criterion was seen, by a search`,
    result: content.thresholds.text, limit: "none", margin: ""});
  const recovered = content.tests.filter((test) => test.came_up && test.recovered_by_itself);
  if (recovered.length > 0 && content.recovery_limit) {
    const { exchanges, exchange } = content.recovery_limit;
    const most = Math.max(...recovered.map((test) => test.recovery_cycles));
    const seconds = Math.max(...recovered.map((test) => test.recovery_s ?? NaN));
    const took = Number.isNaN(seconds) ? "" : `, ${duration(1e6 * seconds)} at most`;
    rows.push({test: `${name}: recovery, from the last pulse until each word has arrived again, the longest`, result: `${number(most)} \u00d7 ${exchange}${took}`,
      limit: `${number(exchanges)} \u00d7 ${exchange}`, margin: `${number(exchanges - most)} \u00d7 ${exchange}`});
  }
  return rows;
}

function rowsOfMatrix({ name, content }) {
  return content.roles.map((role) => ({test: `${name}: mutants of ${content.protocol}/${role.role} that are caught`,
    result: part(mutantsCaught(role), role.mutants.length), limit: "all", margin: ""}));
}

function rowsOfFit({ name, content }) {
  return [{test: `${name}: counts of ${content.rows.length} conditions beside the burst model`, result: content.verdict,
    limit: "consistent", margin: ""}];
}

function rowsOfCampaign(data, { name, content }) {
  const said = data.joined.documents[data.documents.findIndex((one) => one.name === name)];
  const rows = [{test: name, result: sentence(said.sentence), limit: "exit code 0 of each job", margin: ""}];
  const goal = content.confidence;
  if (goal) rows.push({test: `${name}: share of ${goal.of === "sent" ? "all exchanges" : "exchanges whose data differed"} in which a wrong word was accepted`,
    result: `${part(goal.wrong, goal.total)}, at most ${scientific(goal.upper_bound)}`, limit: scientific(goal.rate), margin: ""});
  return rows;
}

function resultRows(data) {
  const of = (schema, rows) => documentsOf(data, schema).flatMap(rows);
  const said = new Map(data.documents.map((document, at) => [document, data.joined.documents[at]]));
  return [...data.runs.flatMap((run, at) => rowsOfRun(run, data.joined.runs[at])), ...of("fieldproof/measurement/1", rowsOfMeasurement),
    ...of("fieldproof/emc/1", rowsOfBursts), ...of("fieldproof/matrix/1", rowsOfMatrix), ...of("fieldproof/detection/1", detectionRows), ...of("fieldproof/emc_fit/1", rowsOfFit),
    ...of("fieldproof/campaign/1", (document) => rowsOfCampaign(data, document)),
    ...of("fieldproof/fuzz/1", (document) => [{test: document.name, result: sentence(said.get(document).sentence), limit: "no finding", margin: ""}]),
    ...of("fieldproof/publication/2", (document) => [{test: document.name, result: sentence(said.get(document).sentence), limit: "no row DIFFERS", margin: ""}])];
}

// What the letters of the table stand for, each list of meanings once.
function criteriaOf(data) {
  const lists = new Map(documentsOf(data, "fieldproof/emc/1").filter(({ content }) => content.tests.length > 0 && content.criteria)
      .map(({ content }) => [JSON.stringify(content.criteria), content]));
  if (lists.size === 0) return null;
  return [element("h3", {}, "What the criteria mean"), [...lists.values()].map(criteriaPart)];
}

export function coverSection(data) {
  const { cover } = data;
  if (!cover) return null;
  return section("cover", cover.title || "Test report",
      definitions([["Device", cover.device], ["Customer", cover.customer], ["Note", cover.note]]),
      headlineOf(data), element("h3", {}, "What was tested"), testedPart(data), element("h3", {}, "With what"), benchPart(data),
      table("Results", [
        {title: "test", kind: "text", cell: (row) => row.test},
        {title: "result", cell: (row) => row.result},
        {title: "limit", cell: (row) => row.limit},
        {title: "margin", kind: "number", cell: (row) => row.margin},
      ], resultRows(data), "stacked"),
      criteriaOf(data),
      caveatList(data, partsOf(data).length));
}
