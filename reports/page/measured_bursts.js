// Rows of the cover for a measurement with bursts on the line.
import { number } from "./format.js";

// Of a measurement: which bursts were on the line.
export function burstsOf(content) {
  return (content.conditions ?? []).find(({ name }) => name === "bursts")?.value ?? "";
}

// What bursts and the recovery from them did to the cycle. They refute nothing, because the closed forms are those
// of a quiet network.
export function disturbedRows(name, { course }) {
  if (!course) return [];
  const points = course.runs.flatMap((run) => run.points);
  return [["burst", "during bursts"], ["recovery", "in the recovery from bursts"]].flatMap(([phase, when]) => {
    const those = points.filter((one) => one.phase === phase);
    if (those.length === 0) return [];
    const longest = Math.max(...those.map(({ max }) => max));
    const jitter = longest - Math.min(...those.map(({ min }) => min));
    const count = those.reduce((sum, one) => sum + one.count, 0);
    return [{test: `${name}: ${course.quantity} ${when}, the longest of ${number(count)}`, result: `${number(longest)} ${course.unit}`, limit: "none", margin: ""},
      {test: `${name}: jitter of the ${course.quantity} ${when}, peak to peak`, result: `${number(jitter)} ${course.unit}`, limit: "none", margin: ""}];
  });
}
