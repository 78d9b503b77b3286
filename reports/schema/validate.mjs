// Judges JSON files against a JSON Schema: node validate.mjs SCHEMA.json FILE...
//
// One line per file on stdout: "FILE: valid", or "FILE: invalid: POINTER REASON; ...". Files may hold comments and
// begin with a byte order mark, as our configuration does. Schemas that the schema refers to by "$ref" are found by
// their file name beside it. Exit code: 0 all valid, 1 a file is invalid, 2 called wrongly or the schema is unusable.

import { readFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

// Comments become spaces outside of strings, so that positions in the messages of JSON.parse stay right.
function withoutComments(text) {
  const blank = (comment) => comment.replace(/[^\r\n]/g, " ");
  return text
    .replace(/^\uFEFF/, "")
    .replace(/"(?:\\.|[^"\\])*"|\/\/[^\r\n]*|\/\*[\s\S]*?\*\//g, (part) => (part.startsWith("/") ? blank(part) : part));
}

function read(path) {
  return JSON.parse(withoutComments(readFileSync(path, "utf8")));
}

function stop(sentence) {
  console.error(`validate.mjs: ${sentence}`);
  process.exit(2);
}

// The drafts in use; the schema says in "$schema" which one it is written in.
async function judgeFor(schema, folder) {
  const draft = String(schema.$schema ?? "");
  const module = draft.includes("2020-12") ? "ajv/dist/2020.js" : draft.includes("draft-04") ? "ajv-draft-04" : "ajv";
  try {
    const { default: Ajv } = await import(module);
    const { default: addFormats } = await import("ajv-formats");
    // A referred schema is looked for by the last part of its address: nothing is fetched.
    const loadSchema = async (address) => read(join(folder, basename(address)));
    // Patterns of the published schema of SARIF are none with the flag "u".
    return addFormats(new Ajv({ strict: false, allErrors: true, unicodeRegExp: false, loadSchema }));
  } catch (error) {
    if (error.code !== "ERR_MODULE_NOT_FOUND") throw error;
    return stop(`ajv is not installed; run "npm ci" in ${dirname(fileURLToPath(import.meta.url))}`);
  }
}

function reasons(errors) {
  return errors
    .map(({ instancePath, message, params }) => {
      const key = params.additionalProperty ?? params.unevaluatedProperty;
      const detail = key !== undefined ? ` ("${key}")` : params.allowedValues ? ` (${params.allowedValues.join(", ")})` : "";
      return `${instancePath || "the top level"} ${message}${detail}`;
    })
    .join("; ");
}

function judged(path, validate) {
  let data;
  try {
    data = read(path);
  } catch (error) {
    console.log(`${path}: invalid: ${error.message}`);
    return false;
  }
  const isValid = validate(data);
  console.log(isValid ? `${path}: valid` : `${path}: invalid: ${reasons(validate.errors)}`);
  return isValid;
}

const [schemaPath, ...files] = process.argv.slice(2);
if (schemaPath === undefined || files.length === 0) stop("write: node validate.mjs SCHEMA.json FILE...");
let validate;
try {
  const schema = read(schemaPath);
  const ajv = await judgeFor(schema, dirname(schemaPath));
  validate = await ajv.compileAsync(schema);
} catch (error) {
  stop(`${schemaPath}: the schema is not usable: ${error.message}`);
}
process.exit(files.map((path) => judged(path, validate)).includes(false) ? 1 : 0);
