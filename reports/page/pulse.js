// One pulse of a burst: as the generator makes it, and at a receiver over the levels of its line. A level that is
// sampled while the receiver's output is wrong is taken for the other one.
import { axis, chartFigure, chartPlace, colour, kQuiet } from "./charts.js";
import { drawUpright } from "./course.js";
import { element } from "./dom.js";
import { fixed, number, plural } from "./format.js";

const kPhases = 256;
const kShown = [-1, 2];  // in levels around the one that is hit

// Where the pulse begins, in ns from the begin of the level on, so that as many samples as can be are wrong.
function worstMeeting({level_ns: level, sampled_sixteenths: sixteenths, wrong_ns: wrong}) {
  const samples = sixteenths.map((one) => (one * level) / 16);
  const ends = wrong.flat(2);
  const reach = Math.max(...ends, 0);
  const meetings = [1, 0].flatMap((driven) => Array.from({length: kPhases}, (_, n) => {
    const begin = samples[0] - (reach * n) / kPhases;
    return {driven, begin, samples, hit: samples.filter((at) => wrong[driven].some(([from, to]) => at >= begin + from && at < begin + to))};
  }));
  const most = Math.max(...meetings.map(({hit}) => hit.length));
  const worst = meetings.filter(({hit}) => hit.length === most);
  const alike = worst.filter(({driven}) => driven === worst[0].driven);
  return alike[Math.floor(alike.length / 2)];
}

// What happens to the level, in words.
function fateText({hit, samples, driven}) {
  if (hit.length === 0) return "the output is wrong at no instant at which the receiver samples";
  const count = samples.length === 1 ? "the sample is wrong" : `${hit.length} of ${samples.length} samples are wrong`;
  return 2 * hit.length > samples.length ? `${count}: a ${driven} is taken for a ${1 - driven}` : `${count}: the others outvote it`;
}

function lineVolts(meeting, pulse, at) {
  const isMiddle = at >= 0 && at < pulse.level_ns;
  const level = isMiddle ? meeting.driven : 1 - meeting.driven;
  const n = (at - meeting.begin) / pulse.step_ns;
  const disturbance = n < 0 ? 0 : pulse.receiver_v[Math.round(n)] ?? 0;
  return (level ? pulse.bit_v : -pulse.bit_v) + disturbance;
}

// The edges of the line, the pulse at each of its values, and enough in between.
function instantsOf(meeting, pulse) {
  const from = kShown[0] * pulse.level_ns;
  const to = kShown[1] * pulse.level_ns;
  const edges = [from, -1e-3, 0, pulse.level_ns - 1e-3, pulse.level_ns, meeting.begin - 1e-3, to];
  const values = pulse.receiver_v.map((_, n) => meeting.begin + n * pulse.step_ns);
  return [...new Set([...edges, ...values])].filter((at) => at >= from && at <= to).sort((a, b) => a - b);
}

function drawWrong(plot, {begin, driven}, pulse) {
  const {ctx, bbox} = plot;
  ctx.fillStyle = colour("fail");
  for (const [from, to] of pulse.wrong_ns[driven]) {
    const left = Math.max(plot.valToPos(begin + from, "x", true), bbox.left);
    const right = Math.min(plot.valToPos(begin + to, "x", true), bbox.left + bbox.width);
    if (right > left) ctx.fillRect(left, bbox.top, Math.max(right - left, devicePixelRatio), 6 * devicePixelRatio);
  }
}

function drawSamples(plot, meeting, pulse) {
  plot.ctx.save();
  for (const start of [kShown[0], 0, 1].map((n) => n * pulse.level_ns)) {
    for (const sample of meeting.samples) {
      const isHit = start === 0 && meeting.hit.includes(sample);
      drawUpright(plot, start + sample, isHit ? "fail" : "quiet", "", isHit ? [] : [2, 3]);
    }
  }
  plot.ctx.restore();
}

const shown = (plot, value) => (value === null ? "" : number(value, 4));

function receiverChart(label, meeting, pulse) {
  const instants = instantsOf(meeting, pulse);
  const make = () => ({
    data: [instants, instants.map((at) => lineVolts(meeting, pulse, at)), instants.map(() => pulse.threshold_v)],
    options: {
      ...kQuiet,
      hooks: {drawClear: [(plot) => drawWrong(plot, meeting, pulse)], draw: [(plot) => drawSamples(plot, meeting, pulse)]},
      scales: {x: {time: false, range: () => kShown.map((n) => n * pulse.level_ns)}},
      axes: [axis("ns from the begin of the level", {size: 32}), axis("V between the wires", {size: 66})],
      series: [{label: "ns", value: shown},
        {label: "at the receiver", stroke: colour("accent"), width: 1.5, points: {show: false}, value: shown},
        {label: "threshold", stroke: colour("ink"), dash: [6, 3], width: 1, points: {show: false}, value: shown}],
    },
  });
  return chartPlace(label, 220, make, 720);
}

function generatorChart(label, pulse) {
  const kEnd = 200;  // ns: four times its width
  const volts = pulse.generator_v.filter((_, n) => n * pulse.step_ns <= kEnd);
  const make = () => ({
    data: [volts.map((_, n) => n * pulse.step_ns), volts],
    options: {
      ...kQuiet,
      scales: {x: {time: false}},
      axes: [axis("ns", {size: 32}), axis("V", {size: 66})],
      series: [{label: "ns", value: shown}, {label: "V", stroke: colour("accent"), width: 1.5, points: {show: false}, value: shown}],
    },
  });
  return chartPlace(label, 220, make, 720);
}

export function pulsePart({pulse}) {
  if (!pulse) return null;
  const meeting = worstMeeting(pulse);
  const peak = pulse.receiver_v.reduce((most, one) => Math.max(most, Math.abs(one)), 0);
  const volts = `${number(pulse.open_circuit_volts)} V ${pulse.polarity === "-" ? "\u2212" : pulse.polarity}`;
  const generator = `Pulse 5/50 ns of the generator, ${volts}`;
  const receiver = `The same pulse at ${pulse.receiver}, at its worst instant`;
  const said = `up to ${fixed(peak, 1)} V on levels of ${fixed(pulse.bit_v, 1)} V; ${fateText(meeting)}`;
  const samples = plural(meeting.samples.length, "sample");
  return element("div", {class: "charts pulse"},
      chartFigure(generator, "at this open-circuit setting, in the shape of the profile", generatorChart(generator, pulse), [{colour: "accent", text: "voltage of the generator"}]),
      chartFigure(receiver, said, receiverChart(`${receiver}: ${said}`, meeting, pulse), [
        {colour: "accent", text: `what it sees: levels of ${number(pulse.level_ns, 4)} ns and the pulse after its filter`},
        {colour: "ink", dash: 1, text: `threshold, ${number(pulse.threshold_v)} V; hysteresis ${number(pulse.hysteresis_mv)} mV`},
        {colour: "quiet", dash: 2, text: `where it samples: ${samples} of each level`},
        {colour: "fail", text: `${meeting.hit.length ? "samples that are wrong; " : ""}bar on top: while its output is wrong, by this voltage or by the common mode`}]));
}
