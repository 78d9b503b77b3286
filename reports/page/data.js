// The data of the page as its modules read them: what the program packed is unpacked.

const kNothing = Object.freeze([]);

function share(part, shared) {
  for (const key of ["purpose", "requirement", "reference"]) {
    if (typeof part[key] === "number") part[key] = shared[part[key]];
  }
}

// Each result as results.json has it.
export function unpack(data) {
  for (const { results } of data.runs) {
    for (const result of results.cases) {
      share(result, results.shared);
      result.reason ??= "";
      result.log ??= "";
      result.measurements ??= kNothing;
      result.findings ??= kNothing;
      for (const finding of result.findings) share(finding, results.shared);
    }
  }
  return data;
}

// The command that runs a case of `run` again.
export function caseCommand(run, id) {
  const [before, ...after] = run.case_command.split("@CASE@");
  return before + (run.cases[id]?.quoted ?? id) + after.join("@CASE@");
}

// Pairs of a key and all of `values` that have it, in the order in which the keys come.
export function grouped(values, keyOf) {
  const groups = new Map();
  for (const value of values) {
    const key = keyOf(value);
    if (groups.has(key)) groups.get(key).push(value);
    else groups.set(key, [value]);
  }
  return [...groups];
}
