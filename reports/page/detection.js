// Random sequences against mutants: after how many commands each is found, and what is not.
import { definitions, element, notice, section } from "./dom.js";
import { number, part, plural } from "./format.js";
import { documentCommand, documentsOf, madeText } from "./summary.js";
import { table } from "./table.js";

function foundBy({ seeds }) {
  return seeds.filter(({ found }) => found !== null);
}

// The median is over the seeds that found it: of the others nobody knows after how many commands they would.
function commandsText(mutant) {
  const counts = foundBy(mutant).map(({ found }) => found).sort((a, b) => a - b);
  if (counts.length === 0) return "";
  const half = Math.floor(counts.length / 2);
  return number(counts.length % 2 ? counts[half] : (counts[half - 1] + counts[half]) / 2);
}

function reasonOf(mutant) {
  const [first] = foundBy(mutant);
  if (first) return first.reason;
  return mutant.suite_catch ? `not found; the suite finds it: ${mutant.suite_catch}` : "not found, nor by the suite";
}

// Those that no seed found come first, then those that some did not.
function detectionTable(role) {
  const share = (mutant) => foundBy(mutant).length / Math.max(mutant.seeds.length, 1);
  const column = (title, cell) => ({title, kind: "number", cell});
  return table(`${role.role}: mutants under ${plural(role.seeds, "seed")} from ${role.first_seed} on, at most ${number(role.most_commands)} commands each`, [
    {title: "mutant", kind: "code", cell: (mutant) => element("span", {title: mutant.description}, mutant.name)},
    column("did otherwise", ({ seeds }) => part(seeds.filter(({ triggered }) => triggered !== null).length, seeds.length)),
    column("found", (mutant) => part(foundBy(mutant).length, mutant.seeds.length)),
    column("commands, median", commandsText),
    {title: "by", kind: "text", cell: reasonOf},
  ], role.mutants.toSorted((a, b) => share(a) - share(b)), "detection");
}

function detectionRole(role) {
  return element("article", {}, element("h4", {}, `${role.role}: found ${part(role.found, role.of)}`,
      role.of > 0 ? ` (${number((100 * role.found) / role.of, 3)} %)` : ""),
      role.complete ? null : notice("The table is incomplete: what was not tried is not found."),
      role.false_alarms.length ? notice(element("strong", {}, "The reference was accused"),
          element("ul", {}, role.false_alarms.map((one) => element("li", {}, one)))) : null,
      detectionTable(role));
}

function detectionPart({ name, content }) {
  return element("article", {}, element("h3", {}, name), definitions([["Made", madeText(content)]]),
      documentCommand(content, name), content.roles.map(detectionRole));
}

// For the cover.
export function detectionRows({ name, content }) {
  return content.roles.map((role) => ({test: `${name}: mutants of ${role.role} under ${plural(role.seeds, "seed")} that random sequences find`,
    result: part(role.found, role.of), limit: "95 %", margin: ""}));
}

export function detectionSection(data) {
  const documents = documentsOf(data, "fieldproof/detection/1");
  return documents.length ? section("detection", "Random sequences against mutants", documents.map(detectionPart)) : null;
}
