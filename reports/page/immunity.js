// Networks under bursts: the performance criterion by level, repetition and polarity, and the ledger of errors.
import { burstCourse } from "./burst_course.js";
import { burstShares } from "./burst_shares.js";
import { definitions, element, notice, section } from "./dom.js";
import { number, part, plural, scientific } from "./format.js";
import { heatMap, shareLines } from "./heat_map.js";
import { later } from "./later.js";
import { pulsePart } from "./pulse.js";
import { documentCommand, documentsOf, madeText } from "./summary.js";
import { table } from "./table.js";
import { sensitivityPart, thresholdsPart } from "./thresholds.js";

function recoveryText(test) {
  if (test.recovered_by_itself) return number(test.recovery_cycles);
  return test.recovered_after_start ? "after a start" : "never";
}

function heatOf(tests) {
  return heatMap("Performance criterion by level, repetition rate and polarity", tests.map((test) => ({
    ...test,
    letter: test.came_up ? test.criterion : "",
    said: "does not come up",
    lines: [...shareLines(test.ledger, test.ledger.balance?.rejected ?? test.ledger.detected),
      test.bursts ? `in ${plural(test.bursts, "burst")}` : null,
      `${part(test.ledger.balance ? test.ledger.sent - test.ledger.balance.untouched : test.ledger.corrupted, test.ledger.sent)} hit`],
  })));
}

export function criteriaPart(content) {
  if (!content.criteria) return null;
  return element("ul", {class: "criteria"}, content.criteria.map((one) =>
    element("li", {}, element("span", {class: `heat criterion-${one.criterion}`}, one.criterion), " ", one.meaning)));
}

// Documents of earlier programs have none.
function balanceColumns(column, tests) {
  if (!tests.every(({ledger: one}) => one.balance)) return [column("sent", ({ledger: one}) => number(one.sent))];
  return [["exposed", "exposed"], ["untouched", "= untouched"], ["hit_without_effect", "+ hit without effect"],
    ["rejected", "+ rejected"], ["accepted_wrong", "+ accepted wrong"], ["data_differed", "data differed"]]
      .map(([key, title]) => column(title, ({ledger: {balance}}) => number(balance[key])));
}

function percent(share) {
  return `${number(100 * share, 2)} %`;
}

// Bounds, not chances: a run without a stop has not shown that none can come.
export function longerRun({evidence}) {
  if (!evidence) return "";
  return [["worse_than_a_at_most", "B or worse", "bursts"], ["c_at_most", "C", "bursts"],
    ["d_at_most", "D", "exchanges whose data differ"]]
      .filter(([key]) => evidence[key] !== undefined && evidence[key] < 1)
      .map(([key, letter, of]) => `${letter} in up to ${percent(evidence[key])} of ${of}`).join(", ");
}

const whichTest = [
  {title: "level", cell: (test) => test.level},
  {title: "pulses", cell: (test) => `${test.repetition} ${test.polarity === "-" ? "−" : test.polarity}`},
  {title: "criterion", cell: (test) => (test.came_up ? test.criterion : "did not come up")},
];

function balance(tests) {
  const column = (title, cell) => ({title, kind: "number", cell});
  return table("How each exchange ended, and what the criterion rests on", [
    ...whichTest, ...balanceColumns(column, tests),
    {title: "rests on", kind: "text", cell: ({complaint, evidence, first_wrong}) => [complaint, evidence?.text, first_wrong && `the first ${first_wrong}`].filter(Boolean).join("; ")},
    {title: "a longer run could still show (95 %)", kind: "text", cell: longerRun},
  ], tests, "many");
}

// Numbers that show that it did otherwise than references; when bursts meet it differs as soon as its timing does.
function asReferences({criterion, reference, ledger: {sent, balance: one}, ...test}) {
  return criterion === reference.criterion && sent === reference.exposed && one.rejected === reference.rejected
      && one.accepted_wrong === reference.accepted_wrong && test.longest_bad_run === reference.longest_bad_run
      && test.bus_stops === reference.bus_stops && recoveryText(test) === recoveryText(reference);
}

// What of a result is the share of the device, and what any device shows on this cable.
function besideReferences(tests) {
  const compared = tests.filter(({came_up: cameUp, reference, ledger: {balance: one}}) => cameUp && reference?.came_up && one);
  if (!compared.length) return null;
  const both = compared.filter((test) => !asReferences(test));
  if (!both.length) return element("p", {}, `The same network with references alone did the same in ${compared.length === 1 ? "the test" : `each of the ${compared.length} tests`}, to the last exchange.`);
  const pair = (title, yours, theirs) => [
    {title: `${title}: yours`, kind: "number", cell: yours}, {title: "references", kind: "number", cell: ({reference}) => theirs(reference)}];
  const same = compared.length - both.length;
  return table(`Beside the same network with references alone${same ? `; in ${plural(same, "more test")} both did the same` : ""}`, [
    {title: "level", cell: ({level}) => level},
    {title: "pulses", cell: (test) => `${test.repetition} ${test.polarity === "-" ? "−" : test.polarity}`},
    {title: "criterion: yours", cell: ({criterion}) => criterion},
    {title: "references", cell: ({reference}) => reference.criterion},
    ...pair("rejected", ({ledger: {balance: one}}) => part(one.rejected, one.exposed), (one) => part(one.rejected, one.exposed)),
    ...pair("accepted wrong", ({ledger: {balance: one}}) => number(one.accepted_wrong), (one) => number(one.accepted_wrong)),
    ...pair("longest bad run", (test) => number(test.longest_bad_run), (one) => number(one.longest_bad_run)),
    ...pair("recovery, exchanges", recoveryText, recoveryText),
    ...pair("bus stops", (test) => number(test.bus_stops), (one) => number(one.bus_stops)),
  ], both, "many");
}

function ledger(tests) {
  const column = (title, cell) => ({title, kind: "number", cell});
  return table("Error ledger of each test", [
    ...whichTest,
    column("levels changed", ({ledger: one}) => number(one.corrupted)),
    column("not served", ({ledger: one}) => number(one.detected)),
    column("retries", ({ledger: one}) => number(one.retried)),
    column("held", ({ledger: one}) => number(one.detected - Math.min(one.detected, one.partly_latched))),
    column("repeated", ({ledger: one}) => number(one.repeated)),
    column("wrong inputs accepted", ({ledger: one}) => number(one.accepted_wrong_inputs)),
    column("wrong outputs accepted", ({ledger: one}) => number(one.accepted_wrong_outputs)),
    column("outputs missed", ({ledger: one}) => number(one.missed_outputs)),
    column("outputs cleared", ({ledger: one}) => number(one.cleared_outputs)),
    column("partly latched", ({ledger: one}) => number(one.partly_latched)),
    column("longest bad run", (test) => number(test.longest_bad_run)),
    column("recovery", recoveryText),
    column("bus stops", (test) => number(test.bus_stops)),
    column("wrong levels", ({line}) => number(line.wrong_levels)),
    column("transmissions hit", ({line}) => part(line.hit, line.transmissions)),
  ], tests, "many");
}

// A channel on which every bit flips with the same chance: the count beside what the theory lets come.
function channels(tests) {
  const column = (title, cell) => ({title, kind: "number", cell});
  return table("On a channel of the textbooks instead of bursts", [
    {title: "each bit flips with", cell: (test) => scientific(test.flip_probability)},
    ...balanceColumns(column, tests),
    column("longest bad run", (test) => number(test.longest_bad_run)),
    column("bus stops", (test) => number(test.bus_stops)),
    column("cycles accepted wrong", ({ledger: one}) => number(one.wrong_cycles)),
    column("theory allows at most", (test) => number(test.expected_wrong_cycles_at_most, 3)),
    column("chance of so many or more", (test) => number(test.chance_of_count, 3)),
  ], tests, "many");
}

// What counting shows, beside what the frame check itself allows.
function totalPart({ total, residual }) {
  const wrong = total.balance ? total.balance.accepted_wrong : total.accepted_wrong;
  const differed = total.balance ? total.balance.data_differed : total.corrupted;
  const bound = ["upper bound", differed ? scientific(total.upper_bound_of_share) : "none", number(total.upper_bound_of_share * differed, 3),
    differed ? "one-sided 95 %, from the count (Clopper and Pearson)" : "data differed in no exchange: the check was not put to the test"];
  return table(total.balance ? "Exchanges whose data differed and that pass unseen" : "Corrupted cycles that pass unseen", [
    {title: "", cell: ([what]) => what},
    {title: "share", kind: "number", cell: ([, share]) => share},
    {title: "exchanges", kind: "number", cell: ([, , exchanges]) => exchanges},
    {title: "how it is known", kind: "text", cell: ([, , , how]) => how},
  ], [
    ["counted", scientific(wrong / Math.max(differed, 1)), number(wrong),
      `${plural(total.accepted_wrong, "wrong word")}; data differed in ${plural(differed, "exchange")}`],
    bound,
    [`exact: ${residual.frame_check} over ${number(residual.bits)} bits`, scientific(residual.worst_share_of_corrupted),
      `at most ${number(residual.expected_wrong_at_most, 3)}`,
      `at the worst bit-error rate, ${scientific(residual.worst_ber)}, where every bit flips with the same chance`],
    ["exact, at a bit-error rate of 0.01", scientific(residual["probability_at_ber_0.01"]), "",
      ["probability of each cycle; per hour ", scientific(residual["rate_per_hour_at_ber_0.01"]), " by a formula of IEC 61784-3 ",
        element("span", {class: "unverified"}, "unverified")]],
  ]);
}

// Which receivers the bursts reach, and which they do not.
export function exposedText({places = []}) {
  if (places.length === 0) return "";
  const hidden = places.filter(({exposed}) => !exposed);
  const kMost = 6;
  const listed = (names) => names.slice(0, kMost).join(", ") + (names.length > kMost ? ` and ${names.length - kMost} more` : "");
  const exposed = listed(places.filter(({exposed: is}) => is).map(({receiver}) => receiver));
  return hidden.length === 0 ? `all receivers: ${exposed}` : `${exposed}; not ${listed(hidden.map(({receiver}) => receiver))}`;
}

function campaign({ name, content }) {
  const hasBursts = content.tests.length > 0;
  return element("article", {}, element("h3", {}, content.network),
      definitions([["Document", name], ["Implementation", content.implementations],
        ...(hasBursts ? [["Profile", content.profile],
          ["A receiver can be wrong from", `${number(content.threshold_volts, 3)} V on`]] : []),
        ["Seed", content.seed], ["Each test", `${number(content.duration_s)} s`], ["Exposed to the bursts", exposedText(content)], ["Made", madeText(content)]]),
      documentCommand(content, name),
      content.is_complete ? null : notice("The campaign ended before all of its tests were made: what is not here was not tested."),
      thresholdsPart(content),
      hasBursts ? [heatOf(content.tests), criteriaPart(content), burstShares(content.tests), burstCourse(content.tests), pulsePart(content), besideReferences(content.tests)] : null, sensitivityPart(content), totalPart(content),
      content.channels.length ? channels(content.channels) : null, hasBursts ? [balance(content.tests), ledger(content.tests)] : null);
}

export function immunitySection(data) {
  const documents = documentsOf(data, "fieldproof/emc/1");
  return documents.length ? section("immunity", "Immunity to bursts", documents.map((document) => later(() => campaign(document)))) : null;
}
