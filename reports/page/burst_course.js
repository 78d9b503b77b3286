// When the errors of an immunity test came: what was rejected and what was accepted wrong in each part of its time,
// the bursts, and where the bus stopped.
import { axis, chartFigure, chartPlace, colour, kQuiet } from "./charts.js";
import { bandKey, drawBands, drawUpright } from "./course.js";
import { number, plural } from "./format.js";

function percentOf(count, whole) {
  return whole > 0 ? (100 * count) / whole : 0;
}

// Each window of the time in which bursts come, and the recovery as one more.
function windowsWithErrors({length_s: length, window_s: width, windows}) {
  const kMostWindows = 1000;
  const rows = [];
  for (let n = 0; n <= Math.min(Math.round(length / width), kMostWindows); ++n) {
    const one = windows.find(({from_s: from}) => Math.abs(from - n * width) < width / 2);
    rows.push({at: (n + 0.5) * width, rejected: one ? percentOf(one.rejected, one.exchanges) : 0,
      wrong: one ? percentOf(one.accepted_wrong, one.exchanges) : 0});
  }
  return rows;
}

function errorsChart(label, course) {
  const rows = windowsWithErrors(course);
  const bands = course.bursts.map(({from_s: from, to_s: to}) => ({from, to}));
  const stops = course.windows.filter((one) => one.stops > 0);
  const bars = {points: {show: false}, paths: uPlot.paths.bars({size: [0.9, 60]}),
    value: (plot, value) => (value === null ? "" : `${number(value, 3)} %`)};
  const make = () => ({
    data: [rows.map(({at}) => at), rows.map(({rejected, wrong}) => rejected + wrong), rows.map(({wrong}) => wrong)],
    options: {
      ...kQuiet,
      hooks: {
        drawClear: [(plot) => drawBands(plot, bands)],
        draw: [(plot) => {
          plot.ctx.save();
          for (const one of stops) drawUpright(plot, one.from_s + course.window_s / 2, "fail", "stopped", [2, 3])(course.length_s);
          drawUpright(plot, course.length_s, "quiet", "", [6, 3])(course.length_s);
          plot.ctx.restore();
        }],
      },
      scales: {x: {time: false, range: () => [0, course.length_s + course.window_s]}, y: {range: (plot, low, high) => [0, Math.min(105, Math.max(1, 1.1 * high))]}},
      axes: [axis("s of virtual time", {size: 32}), axis("% of the exchanges", {size: 66})],
      series: [{label: "s", value: (plot, value) => (value === null ? "" : number(value, 4))},
        {...bars, label: "rejected or accepted wrong", stroke: colour("accent"), fill: colour("accent-soft")},
        {...bars, label: "accepted wrong", stroke: colour("fail"), fill: colour("fail")}],
    },
  });
  return chartPlace(label, 200, make);
}

// Of the tests with errors the one with the worst criterion, at the lowest voltage at which that was seen.
function worstWithErrors(tests) {
  const shown = tests.filter(({came_up: cameUp, course}) => cameUp && course?.windows.length > 0 && course.window_s > 0);
  const order = (one) => [-one.criterion.codePointAt(0), one.open_circuit_volts];
  return shown.sort((a, b) => order(a)[0] - order(b)[0] || order(a)[1] - order(b)[1])[0];
}

export function burstCourse(tests) {
  const test = worstWithErrors(tests);
  if (!test) return null;
  const {course} = test;
  const bursts = course.bursts.reduce((sum, {count}) => sum + count, 0);
  const stops = course.windows.reduce((sum, one) => sum + one.stops, 0);
  const title = `Errors over time: level ${test.level}, ${test.repetition} ${test.polarity}, criterion ${test.criterion}`;
  const said = `${plural(bursts, "burst")} in ${number(course.length_s)} s, then the recovery, in windows of ${number(course.window_s, 3)} s`;
  return chartFigure(title, said, errorsChart(`${title}: ${said}`, course),
      [{colour: "accent", text: "exchanges that were rejected, or accepted wrong"}, {colour: "fail", text: "accepted wrong"},
        {key: bandKey(), text: "bursts on the line; those too near to each other are one band"},
        ...(stops ? [{colour: "fail", dash: 2, text: `the bus stopped ${stops === 1 ? "once" : `${stops} times`}`}] : []),
        {colour: "quiet", dash: 1, text: "after it nothing disturbs any more"}], "wide course");
}
