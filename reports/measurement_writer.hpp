// A measurement (harness/measure) for people and for programs.
//
// Contract: the JSON is valid against reports/schema/measurement.schema.json for every content, "schema" is
// "fieldproof/measurement/1"; equal measurements give equal octets of both. Quantiles are exact unless
// "exact_quantiles" is false or the text says "~": then they are within Distribution::kRelativeError.
#pragma once

#include <string>
#include <string_view>

#include "harness/measure/measurement.hpp"

namespace fieldproof::reports {

// The name of a condition that is a caveat, in a sentence. In the JSON it stands in "unverified".
inline constexpr std::string_view kCaveat = "unverified";

std::string measurement_json(const measure::Measurement& measurement);

// Conditions; then for each series its theory beside what was measured, its distributions apart for each
// phase that has values, and its counts.
std::string measurement_text(const measure::Measurement& measurement);

// Input above output, high as '#', low as '_', in so many columns.
std::string trace_text(const measure::Trace& trace, std::size_t columns);

}  // namespace fieldproof::reports
