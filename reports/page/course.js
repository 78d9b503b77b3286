// When the values of a quantity came: the greatest and the mean of each window over virtual time, the bands in
// which bursts were on the line, and the closed form. Phases differ by shape as well as by colour, bands by their
// hatching, so that paper without colours says the same.
import { axis, chartFigure, chartPlace, colour, kQuiet } from "./charts.js";
import { drawn, element } from "./dom.js";
import { alike, number, plural } from "./format.js";
import { table } from "./table.js";

// `shift` puts them beside each other where all came in one window.
const kPhaseMarks = {
  quiet: {colour: "accent", outline: "M-2 0a2 2 0 1 0 4 0a2 2 0 1 0 -4 0Z", isFilled: true, shift: -2.5},
  burst: {colour: "second", outline: "M0 -4.5L4 3.5L-4 3.5Z", isFilled: true, shift: 0},
  recovery: {colour: "third", outline: "M0 -3.5L3.5 0L0 3.5L-3.5 0Z", isFilled: false, shift: 2.5},
};

// Runs one after another on one axis: each begins where the one before ends.
function onOneAxis({runs}) {
  let begin = 0;
  return runs.map((run) => {
    const placed = {...run, begin, end: begin + run.length_s};
    begin = placed.end;
    return placed;
  });
}

// A window for each instant, its points by phase; where runs begin and end one that is empty: the line has a gap
// there, and the axis reaches from end to end.
function windowsOf(runs) {
  const windows = [];
  for (const run of runs) {
    windows.push({at: run.begin, phases: {}});
    for (const point of run.points) {
      const at = run.begin + point.from_s + Math.min(run.window_s, run.length_s - point.from_s) / 2;
      if (windows.at(-1)?.at !== at) windows.push({at, phases: {}});
      windows.at(-1).phases[point.phase] = point;
    }
  }
  return [...windows, {at: runs.at(-1).end, phases: {}}];
}

function meanOf(points) {
  const count = points.reduce((sum, one) => sum + one.count, 0);
  return count === 0 ? null : points.reduce((sum, one) => sum + one.mean * one.count, 0) / count;
}

// A limit that lies far away would leave no room for what was measured.
function isTheoryShown({theory}, {low, high}) {
  const kMost = 3;
  return theory !== undefined && theory <= kMost * high && theory * kMost >= low;
}

function rangeOf(course, points) {
  const range = {low: Math.min(...points.map(({min}) => min)), high: Math.max(...points.map(({max}) => max))};
  const withTheory = isTheoryShown(course, range) ? [range.low, range.high, course.theory] : [range.low, range.high];
  const margin = (Math.max(...withTheory) - Math.min(...withTheory)) * 0.08;
  return {...range, from: Math.min(...withTheory) - margin, to: Math.max(...withTheory) + 1.5 * margin};
}

function withinPlot({ctx, bbox}, draw) {
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  draw();
  ctx.restore();
}

// At least a pixel wide, and with a solid strip on top: what is narrow is seen, too.
export function drawBands(plot, bands) {
  const {ctx, bbox} = plot;
  const places = bands.map(({from, to}) => {
    const left = plot.valToPos(from, "x", true);
    return [left, Math.max(plot.valToPos(to, "x", true) - left, devicePixelRatio)];
  });
  withinPlot(plot, () => {
    ctx.beginPath();
    for (const [left, width] of places) ctx.rect(left, bbox.top, width, bbox.height);
    ctx.fillStyle = colour("warn-soft");
    ctx.fill();
    ctx.fillStyle = colour("warn");
    for (const [left, width] of places) ctx.fillRect(left, bbox.top, width, 5 * devicePixelRatio);
    ctx.clip();
    ctx.strokeStyle = colour("warn");
    ctx.globalAlpha = 0.55;
    ctx.lineWidth = 0.75 * devicePixelRatio;
    ctx.beginPath();
    for (let x = bbox.left - bbox.height; x < bbox.left + bbox.width; x += 7 * devicePixelRatio) {
      ctx.moveTo(x, bbox.top + bbox.height);
      ctx.lineTo(x + bbox.height, bbox.top);
    }
    ctx.stroke();
  });
}

// Windows that are too near to each other for marks of their own are drawn as one.
function drawnTogether(plot, windows, phase) {
  const kRoom = 9 * devicePixelRatio;
  const together = new Map();
  for (const {at, phases} of windows) {
    const point = phases[phase];
    if (!point) continue;
    const slot = Math.floor((plot.valToPos(at, "x", true) - plot.bbox.left) / kRoom);
    const before = together.get(slot);
    together.set(slot, before ? {min: Math.min(before.min, point.min), max: Math.max(before.max, point.max)} : point);
  }
  return [...together].map(([slot, {min, max}]) => ({x: plot.bbox.left + (slot + 0.5) * kRoom, min, max}));
}

function drawPoints(plot, windows) {
  const {ctx} = plot;
  const size = devicePixelRatio;
  for (const [phase, mark] of Object.entries(kPhaseMarks)) {
    const outline = new Path2D(mark.outline);
    ctx.strokeStyle = ctx.fillStyle = colour(mark.colour);
    for (const {x: middle, min, max} of drawnTogether(plot, windows, phase)) {
      const x = middle + mark.shift * size;
      const [low, high] = [min, max].map((value) => plot.valToPos(value, "y", true));
      ctx.lineWidth = size;
      ctx.beginPath();
      ctx.moveTo(x, low);
      ctx.lineTo(x, high);
      ctx.stroke();
      ctx.save();
      ctx.translate(x, high);
      ctx.scale(size, size);
      ctx.lineWidth = 1.4;
      if (mark.isFilled) ctx.fill(outline);
      else ctx.stroke(outline);
      ctx.restore();
    }
  }
}

export function drawUpright(plot, at, name, text, dash = []) {
  const {ctx, bbox} = plot;
  const x = plot.valToPos(at, "x", true);
  ctx.strokeStyle = ctx.fillStyle = colour(name);
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash(dash.map((one) => one * devicePixelRatio));
  ctx.beginPath();
  ctx.moveTo(x, bbox.top);
  ctx.lineTo(x, bbox.top + bbox.height);
  ctx.stroke();
  ctx.setLineDash([]);
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textBaseline = "top";
  ctx.textAlign = "left";
  return (end) => {
    const room = plot.valToPos(end, "x", true) - x - 8 * devicePixelRatio;
    if (ctx.measureText(text).width < room) ctx.fillText(text, x + 4 * devicePixelRatio, bbox.top + 8 * devicePixelRatio);
  };
}

function drawMarks(plot, course, runs, range) {
  const {ctx, bbox} = plot;
  if (runs.length > 1) for (const run of runs) drawUpright(plot, run.begin, "quiet", run.name)(run.end);
  for (const run of runs.filter((one) => one.stopped_s !== undefined)) {
    drawUpright(plot, run.begin + run.stopped_s, "fail", "stopped", [2, 3])(run.end);
  }
  if (!isTheoryShown(course, range)) return;
  const y = plot.valToPos(course.theory, "y", true);
  ctx.strokeStyle = colour("ink");
  ctx.lineWidth = 1.5 * devicePixelRatio;
  ctx.setLineDash([6, 3].map((one) => one * devicePixelRatio));
  ctx.beginPath();
  ctx.moveTo(bbox.left, y);
  ctx.lineTo(bbox.left + bbox.width, y);
  ctx.stroke();
  ctx.setLineDash([]);
}

function courseChart(label, course, runs, phases) {
  const windows = windowsOf(runs);
  const range = rangeOf(course, runs.flatMap(({points}) => points));
  const bands = runs.flatMap((run) => run.bursts.map(({from_s, to_s}) => ({from: run.begin + from_s, to: run.begin + to_s})));
  const shown = (plot, value) => (value === null ? "" : number(value, 6));
  // What the draw hook draws is not drawn twice; the legend reads its values from here.
  const read = {paths: () => null, points: {show: false}, value: shown};
  const make = () => ({
    data: [windows.map(({at}) => at), ...phases.map((phase) => windows.map((one) => one.phases[phase]?.max ?? null)),
      windows.map((one) => meanOf(Object.values(one.phases)))],
    options: {
      ...kQuiet,
      hooks: {
        drawClear: [(plot) => drawBands(plot, bands)],
        draw: [(plot) => withinPlot(plot, () => {
          drawMarks(plot, course, runs, range);
          drawPoints(plot, windows);
        })],
      },
      scales: {x: {time: false, range: (plot, low, high) => [low, high]}, y: {range: () => [range.from, range.to]}},
      axes: [axis("s of virtual time", {size: 32}), axis(`${course.quantity}, ${course.unit}`, {size: 66})],
      series: [{label: "s", value: shown},
        ...phases.map((phase) => ({...read, label: `longest, ${phase}`, stroke: colour(kPhaseMarks[phase].colour)})),
        {label: "mean", stroke: colour("quiet"), width: 1, points: {show: false}, value: shown}],
    },
  });
  return chartPlace(label, 260, make);
}

function markKey({colour: name, outline, isFilled}) {
  return drawn("svg", {viewBox: "-8 -6 16 12", width: 16, height: 12, "aria-hidden": "true"},
      drawn("path", {d: outline, class: `stroke-${name} ${isFilled ? `fill-${name}` : "fill-none"}`, "stroke-width": 1.2}));
}

export function bandKey() {
  return drawn("svg", {viewBox: "0 0 24 12", width: 24, height: 12, class: "band-key", "aria-hidden": "true"},
      drawn("rect", {x: 0, y: 0, width: 24, height: 12, class: "band"}), drawn("rect", {x: 0, y: 0, width: 24, height: 3, class: "strip"}),
      [-6, 2, 10, 18].map((x) => drawn("line", {x1: x, y1: 12, x2: x + 12, y2: 0, class: "hatch"})));
}

function theoryText(course, text, range) {
  const name = course.is_bound ? "limit by the closed form" : "closed form";
  return `${name} ${text(course.theory)} ${course.unit}${isTheoryShown(course, range) ? "" : ", beyond the chart"}`;
}

function legendOf(course, runs, phases, text) {
  const range = rangeOf(course, runs.flatMap(({points}) => points));
  const bands = runs.flatMap(({bursts}) => bursts);
  const bursts = bands.reduce((sum, {count}) => sum + count, 0);
  const joined = bands.length < bursts ? "; those too near to each other are one band" : "";
  return [
    ...phases.map((phase) => ({key: markKey(kPhaseMarks[phase]), text: phase})),
    {key: null, text: "each mark is the longest, its line goes down to the shortest"},
    {colour: "quiet", text: "mean"},
    ...(course.theory === undefined ? [] : [{colour: "ink", dash: 1, text: theoryText(course, text, range)}]),
    ...(bursts ? [{key: bandKey(), text: `${plural(bursts, "burst")} on the line${joined}`}] : []),
    ...runs.filter(({stopped_s}) => stopped_s !== undefined).map((run) => ({colour: "fail", dash: 2, text: `${run.name}: the bus stopped after ${number(run.stopped_s)} s`})),
    ...(runs.length > 1 ? [{key: null, text: `one signal after another: ${runs.map(({name, end}) => `${name} until ${number(end, 4)} s`).join(", ")}`}] : []),
  ];
}

function longestTable(course, runs) {
  const kMost = 5;
  const rows = runs.flatMap((run) => run.longest.map((one) => ({...one, signal: run.name})))
      .sort((a, b) => b.value - a.value).slice(0, kMost);
  return table(`${course.quantity}: the longest, and when they ended`, [
    {title: `${course.quantity}, ${course.unit}`, amount: ({value}) => value},
    {title: "s after the begin of its signal", cell: ({at_s}) => at_s.toFixed(6), kind: "number"},
    {title: "phase", cell: ({phase}) => phase},
    {title: "signal", cell: ({signal}) => signal},
  ], rows);
}

// What never changes, but for the rounding of instants, needs no picture.
function isConstant({low, high}) {
  return high - low <= 1e-6 * Math.abs(high);
}

export function courseFigure(course) {
  const runs = onOneAxis(course ?? {runs: []});
  const points = runs.flatMap((run) => run.points);
  if (points.length === 0) return null;
  const range = rangeOf(course, points);
  const text = alike([range.low, range.high, course.theory ?? range.high]);
  if (isConstant(range)) {
    return element("p", {class: "quiet"}, `${course.quantity} over time: ${text(range.high)} ${course.unit} from the first to the last, so there is no chart of it.`);
  }
  const phases = Object.keys(kPhaseMarks).filter((phase) => points.some((one) => one.phase === phase));
  const windows = [...new Set(runs.map(({window_s}) => number(window_s, 3)))].join(", ");
  const said = `${text(range.low)} to ${text(range.high)} ${course.unit} in windows of ${windows} s`;
  const title = `${course.quantity} over time`;
  return [chartFigure(title, said, courseChart(`${title}: ${said}`, course, runs, phases), legendOf(course, runs, phases, text), "wide course"),
    longestTable(course, runs)];
}
