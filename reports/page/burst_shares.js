// How the share of exchanges that were rejected, and of those in which a wrong word was accepted, grows with the
// voltage. What was counted stands with its interval; where nothing was, a bound says what the run cannot exclude.
import { axis, chartFigure, chartPlace, colour, intervalBars, kDecades, kQuiet, wilson } from "./charts.js";
import { grouped } from "./data.js";
import { drawn, element } from "./dom.js";
import { number } from "./format.js";

const kEnds = [{member: "rejected", name: "rejected", isFilled: true, colours: {"+": "accent", "-": "third"}},
  {member: "accepted_wrong", name: "accepted wrong", isFilled: false, colours: {"+": "fail", "-": "error"}}];
const kDot = "M-3 0a3 3 0 1 0 6 0a3 3 0 1 0 -6 0Z";
const kRing = "M0 -4.5L4.5 0L0 4.5L-4.5 0Z";
const kArrow = "M-4 0L4 0M0 0L0 9M-3 6L0 9L3 6";

// In per cent. Of none in n the exact one-sided bound (Clopper and Pearson) is this power.
function boundOfNone(exchanges) {
  return 100 * (1 - 0.05 ** (1 / exchanges));
}

// Series {name, colour, isFilled, shift, points}, a point {x, share, low, high} or {x, bound}.
function sharesOf(tests) {
  const series = [...grouped(tests, ({polarity}) => polarity)].flatMap(([polarity, those]) => kEnds.map((end) => ({
    name: `${end.name}, ${polarity === "-" ? "\u2212" : polarity}`, colour: end.colours[polarity] ?? "quiet", isFilled: end.isFilled,
    points: those.toSorted((a, b) => a.open_circuit_volts - b.open_circuit_volts).map(({open_circuit_volts: x, ledger: {balance: one}}) => {
      const count = one[end.member];
      if (count === 0) return {x, bound: boundOfNone(one.exposed)};
      const [low, high] = wilson(count, one.exposed).map((share) => 100 * share);
      return {x, share: (100 * count) / one.exposed, low, high};
    }),
  })));
  return series.map((one, at) => ({...one, shift: 9 * (at - (series.length - 1) / 2)}));
}

function drawMarksOfShares(plot, series) {
  const {ctx, bbox} = plot;
  const size = devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  for (const one of series) {
    ctx.strokeStyle = ctx.fillStyle = colour(one.colour);
    for (const {x, share, bound} of one.points) {
      ctx.save();
      ctx.translate(plot.valToPos(x, "x", true) + one.shift * size, plot.valToPos(share ?? bound, "y", true));
      ctx.scale(size, size);
      ctx.lineWidth = 1.5;
      const outline = new Path2D(share === undefined ? kArrow : one.isFilled ? kDot : kRing);
      if (share !== undefined && one.isFilled) ctx.fill(outline);
      else ctx.stroke(outline);
      ctx.restore();
    }
  }
  ctx.restore();
}

function sharesChart(label, series) {
  const points = series.flatMap((one) => one.points);
  const volts = [...new Set(points.map(({x}) => x))].sort((a, b) => a - b);
  const margin = (volts.at(-1) - volts[0]) * 0.08;
  const from = 10 ** Math.floor(Math.log10(Math.min(...points.map(({low, bound}) => low ?? bound / 3))));
  const to = 10 ** Math.ceil(Math.log10(Math.max(...points.map(({high, bound}) => high ?? bound))));
  const bars = series.flatMap((one) => one.points.filter(({share}) => share !== undefined)
      .map(({x, low, high}) => ({x, low, high, colour: one.colour, shift: one.shift})));
  const shown = (plot, value) => (value === null ? "" : number(value, 3));
  const make = () => ({
    data: [volts, ...series.map((one) => volts.map((x) => one.points.find((point) => point.x === x)?.share ?? null))],
    options: {
      ...kQuiet,
      hooks: {draw: [intervalBars(bars), (plot) => drawMarksOfShares(plot, series)]},
      scales: {x: {time: false, range: () => [volts[0] - margin, volts.at(-1) + margin]}, y: {distr: 3, range: () => [from, to]}},
      axes: [axis("open-circuit voltage, V", {size: 32}), axis("% of the exchanges", {...kDecades, size: 62, values: (plot, splits) => splits.map((one) => number(one))})],
      series: [{label: "V", value: shown},
        ...series.map((one) => ({label: one.name, stroke: colour(one.colour), paths: () => null, points: {show: false}, value: shown}))],
    },
  });
  return chartPlace(label, 260, make, 720);
}

function shareKey(outline, name, isFilled) {
  return drawn("svg", {viewBox: "-8 -7 16 17", width: 16, height: 17, "aria-hidden": "true"},
      drawn("path", {d: outline, class: `stroke-${name} ${isFilled ? `fill-${name}` : "fill-none"}`, "stroke-width": 1.5}));
}

function shareAtText({x, share, bound}) {
  return share === undefined ? `none at ${number(x)} V, at most ${number(bound, 2)} %` : `${number(share, 3)} % at ${number(x)} V`;
}

// A test of the search is there because it went worse than others, so it is no fair sample. One voltage is no course.
export function burstShares(tests) {
  const fair = tests.filter(({came_up: cameUp, of_search_s: ofSearch, ledger}) => cameUp && ofSearch === undefined && ledger.balance?.exposed > 0);
  const rates = grouped(fair, ({repetition}) => repetition).filter(([, those]) => new Set(those.map((one) => one.open_circuit_volts)).size > 1);
  if (rates.length === 0) return null;
  return element("div", {class: "charts shares"}, rates.map(([rate, those]) => {
    const series = sharesOf(those);
    const said = series.map((one) => `${one.name}: ${one.points.map(shareAtText).join(", ")}`).join("; ");
    return chartFigure(`Share of bad exchanges over the voltage, ${rate}`, "with the 95 % interval of Wilson; logarithmic",
        sharesChart(`Share of exchanges over the voltage, at ${rate}: ${said}`, series),
        [...series.map((one) => ({key: shareKey(one.isFilled ? kDot : kRing, one.colour, one.isFilled), text: one.name})),
          {key: shareKey(kArrow, "quiet", false), text: "none was counted: one-sided exact 95 % bound (Clopper and Pearson)"}]);
  }));
}
