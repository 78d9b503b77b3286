// results.json, manifest.json and timings.json, and their readers.
//
// Contract: results.json and manifest.json are valid against reports/schema/*.schema.json for every content;
// equal runs give equal bytes of results.json, with any number of jobs. "schema" is "fieldproof/results/1":
// the number grows only when a reader of the former one would misread; keys may be added without it. 64-bit
// integers are strings (result_json.hpp).
//
// Readers skip unknown keys and throw kernel::Error(configuration), with `place`, line and pointer, for what
// is no such document, for a newer schema, for a value of a wrong type or range and for two results of one
// case.
#pragma once

#include <string>
#include <string_view>

#include "reports/results.hpp"

namespace fieldproof::reports {

std::string results_json(const Run& run);
std::string manifest_json(const Manifest& manifest, const Run& run);
std::string timings_json(const Manifest& manifest, const Run& run);  // wall time per case

Run run_from_json(std::string_view text, const std::string& place);
Manifest manifest_from_json(std::string_view text, const std::string& place);
// Fills in the wall times of the cases that the text names.
void add_timings(std::string_view text, const std::string& place, Run& run);

}  // namespace fieldproof::reports
