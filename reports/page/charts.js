// Charts by uPlot: histograms, the two channels of an oscilloscope, curves over logarithmic axes.
//
// A chart is drawn when its place first comes near the view, again when the width or the colour scheme
// changes, and before printing. Beside each stands the text that says the same.
import { drawn, element } from "./dom.js";
import { number, scientific } from "./format.js";

const places = new Set();
const kPaperWidth = 660;
const kPaperHeight = 150;

const nearView = new IntersectionObserver((entries) => {
  for (const entry of entries) if (entry.isIntersecting) draw(entry.target);
}, {rootMargin: "400px"});

const widths = new ResizeObserver((entries) => {
  for (const { target } of entries) if (target.chart && target.drawnWidth !== widthOf(target)) draw(target);
});

function isPrinting() {
  return matchMedia("print").matches;
}

function widthOf(place) {
  // Two stand side by side.
  if (isPrinting() && place.closest(".charts")) return kPaperWidth / 2;
  return isPrinting() ? Math.min(kPaperWidth, place.widest ?? kPaperWidth) : Math.min(place.clientWidth, place.widest ?? 1200);
}

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

function draw(place) {
  const width = widthOf(place);
  if (width <= 0) return;
  place.chart?.destroy();
  place.drawnWidth = width;
  const { options, data } = place.make();
  place.chart = new uPlot({width, height: isPrinting() ? Math.min(place.chartHeight, kPaperHeight) : place.chartHeight, ...options}, data, place);
}

export function drawAllCharts() {
  for (const place of places) if (place.isConnected) draw(place);
}

export function watchCharts() {
  for (const query of ["(prefers-color-scheme: dark)", "print"]) {
    matchMedia(query).addEventListener("change", () => {
      for (const place of places) if (place.chart || isPrinting()) draw(place);
    });
  }
  addEventListener("beforeprint", drawAllCharts);
}

export function chartPlace(label, height, make, widest) {
  const place = element("div", {class: "chart", role: "img", "aria-label": label});
  Object.assign(place, {make, chartHeight: height, widest});
  place.style.minHeight = `min(${height}px, var(--chart-height, 100vh))`;
  places.add(place);
  nearView.observe(place);
  widths.observe(place);
  return place;
}

export function axis(label, more = {}) {
  return {
    stroke: colour("quiet"),
    grid: {stroke: colour("line"), width: 1},
    ticks: {stroke: colour("line"), width: 1},
    font: "11px system-ui, sans-serif",
    labelFont: "11px system-ui, sans-serif",
    labelSize: 18,
    label,
    filter: (plot, splits) => splits,
  values: (plot, splits) => splits.map((value) => (value === null ? "" : number(value))),
    ...more,
  };
}

const kDashes = [[], [6, 3], [2, 3], [10, 3, 2, 3]];

// A chart under its title, and above a legend that paper has as well. Entries are {colour, text, dash}, or with a
// `key` that was drawn already.
export function chartFigure(title, detail, chart, legend, classes = "") {
  const key = ({colour: name, dash}) => drawn("svg", {viewBox: "0 0 24 8", width: 24, height: 8, "aria-hidden": "true"},
      drawn("line", {x1: 0, y1: 4, x2: 24, y2: 4, class: `stroke-${name}`, "stroke-width": 2.5, "stroke-dasharray": kDashes[dash]?.join(" ") || null}));
  return element("figure", {class: classes},
      element("figcaption", {}, element("strong", {}, title), element("span", {class: "quiet"}, ` ${detail}`)), chart,
      element("ul", {class: "legend"}, legend.map((one) => element("li", {}, one.key === undefined ? key(one) : one.key, one.text))));
}

// The cursor shows the value under it.
export const kQuiet = {legend: {show: true, live: true}, cursor: {drag: {x: true, y: false}}};

// Upright lines at values that a reader compares the bars with.
function markLines(marks) {
  return {draw: (plot) => {
    const {ctx, bbox} = plot;
    ctx.save();
    ctx.strokeStyle = colour("second");
    ctx.lineWidth = 1.5 * devicePixelRatio;
    marks.forEach(({at}, which) => {
      const x = plot.valToPos(at, "x", true);
      if (x < bbox.left || x > bbox.left + bbox.width) return;
      ctx.setLineDash(kDashes[which % kDashes.length].map((one) => one * devicePixelRatio));
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
    });
    ctx.restore();
  }};
}

function cumulative(counts) {
  const total = counts.reduce((sum, one) => sum + one, 0);
  let until = 0;
  return counts.map((one) => (100 * (until += one)) / total);
}

// Bins {low, high, count} as bars with the share of all values up to each, and upright lines at `marks`, which
// are {name, at}; drag zooms, a double click shows all.
export function histogram(label, unit, bins, marks) {
  const make = () => {
    const margin = (bins[0].high - bins[0].low) / 2;
    const counts = bins.map((bin) => bin.count);
    const range = (plot, low, high) => [low - margin, high + margin];
    return {
      data: [bins.map((bin) => (bin.low + bin.high) / 2), counts, cumulative(counts)],
      options: {
        ...kQuiet,
        hooks: {draw: [markLines(marks).draw]},
        scales: {x: {time: false, range}, y: {range: (plot, low, high) => [0, Math.max(high * 1.05, 1)]}, share: {range: [0, 105]}},
        axes: [axis(unit, {size: 32}), axis("count", {size: 66}),
          axis("%", {scale: "share", side: 1, size: 44, grid: {show: false}, splits: () => [0, 50, 100]})],
        series: [
          {label: unit, value: (plot, value) => (value === null ? "" : number(value))},
          {label: "count", stroke: colour("accent"), fill: colour("accent-soft"), points: {show: false},
            paths: uPlot.paths.bars({size: [0.95, 80]})},
          {label: "up to here, %", scale: "share", stroke: colour("third"), width: 1.5, points: {show: false},
            value: (plot, value) => (value === null ? "" : number(value, 4))},
        ],
      },
    };
  };
  return chartPlace(label, 210, make, 560);
}

// Edges {time_us, level} as a step line from 0 to 1; the level before the first edge is the other one.
function steps(edges, length) {
  const first = edges.length ? !edges[0].level : false;
  const points = [[0, first ? 1 : 0]];
  for (const edge of edges) points.push([edge.time_us, edge.level ? 1 : 0]);
  points.push([length, points.at(-1)[1]]);
  return points;
}

function valueAt(points, time) {
  let value = points[0][1];
  for (const [when, level] of points) {
    if (when > time) break;
    value = level;
  }
  return value;
}

// Input above output, as on the two channels of an oscilloscope.
export function oscilloscope(label, trace) {
  const make = () => {
    const input = steps(trace.input, trace.length_us);
    const output = steps(trace.output, trace.length_us);
    const times = [...new Set([...input, ...output].map(([when]) => when))].sort((a, b) => a - b);
    const stepped = uPlot.paths.stepped({align: 1});
    const names = new Map([[1.8, "input"], [0.3, "output"]]);
    const level = (offset) => (plot, value) => (value === null ? "" : value > offset + 0.5 ? "1" : "0");
    return {
      data: [times.map((one) => one / 1000), times.map((one) => 1.3 + valueAt(input, one)), times.map((one) => valueAt(output, one))],
      options: {
        ...kQuiet,
        scales: {x: {time: false}, y: {range: [-0.2, 2.6]}},
        axes: [axis("ms", {size: 32}), axis("", {size: 56, labelSize: 0, splits: () => [...names.keys()], values: () => [...names.values()],
          grid: {show: false}, ticks: {show: false}})],
        series: [
          {label: "ms", value: (plot, value) => (value === null ? "" : number(value))},
          {label: "input", stroke: colour("accent"), width: 1.5, paths: stepped, points: {show: false}, value: level(1.3)},
          {label: "output", stroke: colour("second"), width: 1.5, paths: stepped, points: {show: false}, value: level(0)},
        ],
      },
    };
  };
  return chartPlace(label, 190, make);
}

// Series {label, values, isPoints} over `x`, both axes logarithmic; values that are not above 0 are left out.
export function logarithmicCurves(label, xLabel, yLabel, x, series) {
  const colours = ["accent", "second", "third"];
  const make = () => ({
    data: [x, ...series.map((one) => one.values.map((value) => (value > 0 ? value : null)))],
    options: {
      ...kQuiet,
      scales: {x: {time: false, distr: 3}, y: {distr: 3}},
      axes: [axis(xLabel, {...kDecades, size: 32}), axis(yLabel, {...kDecades, size: 62})],
      series: [
        {label: xLabel, value: (plot, value) => (value === null ? "" : scientific(value))},
        ...series.map((one, at) => ({label: one.label, stroke: colour(colours[at]), width: 1.5,
          dash: at === 2 ? [6, 4] : undefined, spanGaps: true, points: {show: true, size: 6},
          paths: one.isPoints ? () => null : undefined,
          value: (plot, value) => (value === null ? "" : scientific(value))})),
      ],
    },
  });
  return chartPlace(label, 240, make, 720);
}

// Curves {name, points: {x, y}}, each with points of its own, over linear axes.
export function linearCurves(label, xLabel, yLabel, series) {
  const colours = ["accent", "second", "third", "quiet"];
  const at = [...new Set(series.flatMap((one) => one.points.map(({x}) => x)))].sort((a, b) => a - b);
  const make = () => ({
    data: [at, ...series.map((one) => {
      const values = new Map(one.points.map(({x, y}) => [x, y]));
      return at.map((x) => values.get(x) ?? null);
    })],
    options: {
      ...kQuiet,
      scales: {x: {time: false}},
      axes: [axis(xLabel, {size: 32}), axis(yLabel, {size: 52})],
      series: [
        {label: xLabel, value: (plot, value) => (value === null ? "" : number(value))},
        ...series.map((one, n) => ({label: one.name, stroke: colour(colours[n % colours.length]), width: 1.5,
          dash: n >= colours.length ? [6, 4] : undefined, spanGaps: true, points: {show: one.points.length <= 40, size: 5},
          value: (plot, value) => (value === null ? "" : number(value))})),
      ],
    },
  });
  return chartPlace(label, 240, make, 720);
}

// The interval of Wilson for a share, which stays within 0 and 1.
export function wilson(count, whole) {
  const kZ = 1.96;
  const share = count / whole;
  const middle = (share + (kZ * kZ) / (2 * whole)) / (1 + (kZ * kZ) / whole);
  const reach = (kZ / (1 + (kZ * kZ) / whole)) * Math.sqrt((share * (1 - share)) / whole + (kZ * kZ) / (4 * whole * whole));
  return [Math.max(middle - reach, 0), Math.min(middle + reach, 1)];
}

// Upright bars {x, low, high, colour, shift}, each with a short line at both ends, `shift` pixels beside its place.
export function intervalBars(bars) {
  return (plot) => {
    const {ctx} = plot;
    const reach = 4 * devicePixelRatio;
    ctx.save();
    ctx.lineWidth = 1.5 * devicePixelRatio;
    for (const bar of bars) {
      const x = plot.valToPos(bar.x, "x", true) + (bar.shift ?? 0) * devicePixelRatio;
      const ends = [bar.low, bar.high].map((value) => plot.valToPos(value, "y", true));
      ctx.strokeStyle = colour(bar.colour);
      ctx.beginPath();
      ctx.moveTo(x, ends[0]);
      ctx.lineTo(x, ends[1]);
      for (const y of ends) {
        ctx.moveTo(x - reach, y);
        ctx.lineTo(x + reach, y);
      }
      ctx.stroke();
    }
    ctx.restore();
  };
}

// Shares of bad frames over the level: series {name, rows}, the rows of a fit in the order of their levels.
export function countedShares(label, series) {
  const colours = ["accent", "second", "third"];
  const levels = [...new Set(series.flatMap(({rows}) => rows.map((row) => row.level_v)))].sort((a, b) => a - b);
  const bars = series.flatMap(({rows}, at) => rows.map((row) => {
    const [low, high] = wilson(row.frames_bad, row.frames);
    return {x: row.level_v, low: 100 * low, high: 100 * high, colour: colours[at]};
  }));
  const most = Math.max(...bars.map(({high}) => high), ...series.flatMap(({rows}) => rows.map((row) => (100 * row.expected_bad) / row.frames)));
  const margin = Math.max((levels.at(-1) - levels[0]) * 0.04, levels[0] * 0.04);
  const of = (rows, member) => {
    const values = new Map(rows.map((row) => [row.level_v, (100 * row[member]) / row.frames]));
    return levels.map((level) => values.get(level) ?? null);
  };
  const shown = (plot, value) => (value === null ? "" : number(value, 3));
  const make = () => ({
    data: [levels, ...series.flatMap(({rows}) => [of(rows, "frames_bad"), of(rows, "expected_bad")])],
    options: {
      ...kQuiet,
      hooks: {draw: [intervalBars(bars)]},
      scales: {x: {time: false, range: () => [levels[0] - margin, levels.at(-1) + margin]}, y: {range: () => [0, most * 1.05 || 1]}},
      axes: [axis("level, V", {size: 32}), axis("bad frames, %", {size: 60})],
      series: [
        {label: "V", value: shown},
        ...series.flatMap(({name}, at) => [
          {label: `${name}, counted`, stroke: colour(colours[at]), paths: () => null, points: {show: true, size: 6, fill: colour(colours[at])}, value: shown},
          {label: "fitted", stroke: colour(colours[at]), width: 1.5, spanGaps: true, points: {show: false}, value: shown},
        ]),
      ],
    },
  });
  return chartPlace(label, 240, make, 720);
}

// Grid and labels at powers of ten, at most ten of them.
export const kDecades = {
  splits: (plot, which, low, high) => {
    const first = Math.ceil(Math.log10(low) - 1e-9);
    const last = Math.floor(Math.log10(high) + 1e-9);
    const step = Math.ceil((last - first + 1) / 10);
    return Array.from({length: Math.floor((last - first) / step) + 1}, (none, at) => 10 ** (first + at * step));
  },
  filter: (plot, splits) => splits,
  values: (plot, splits) => splits.map((value) => (value === null ? "" : value.toExponential(0))),
};
