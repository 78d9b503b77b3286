// Where each criterion of an immunity campaign was seen first, and how far that depends on what nobody measured.
import { element } from "./dom.js";
import { number, plural } from "./format.js";
import { table } from "./table.js";

// A hint without a search stands alone.
export function thresholdsPart({thresholds, hint}) {
  const advice = hint ? element("p", {class: "hint"}, element("strong", {}, "Hint: "), hint) : null;
  if (!thresholds) return advice;
  return [element("p", {class: "thresholds"}, element("strong", {}, "Threshold search: "), thresholds.text,
      ` (${plural(thresholds.tests, "test")} of ${number(thresholds.test_s)} s; what a probe does not show may still come)`,
      thresholds.references ? [element("br"), element("strong", {}, "References alone: "), thresholds.references.text] : null), advice];
}

function valueOf(value, unit) {
  return `${number(value, 3)} ${unit}`.trim();
}

function other(next, unit) {
  return next ? `${next.criterion} at ${valueOf(next.value, unit)}` : "";
}

export function sensitivityPart({sensitivity}) {
  if (!sensitivity) return null;
  return table(`Where ${sensitivity.criterion} at ${sensitivity.level} stays, one parameter of the coupling at a time`, [
    {title: "parameter", cell: ({name}) => name},
    {title: "in the profile", kind: "number", cell: ({value, unit}) => valueOf(value, unit)},
    {title: "stays from", kind: "number", cell: ({from, unit}) => valueOf(from, unit)},
    {title: "to", kind: "number", cell: ({to, unit}) => valueOf(to, unit)},
    {title: "below", cell: ({below, unit}) => other(below, unit)},
    {title: "above", cell: ({above, unit}) => other(above, unit)},
  ], sensitivity.parameters);
}
