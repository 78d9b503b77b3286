// When the values of a quantity came, as the documents of this folder hold it: instants in seconds of virtual
// time since the begin of a run, values in the unit of the quantity.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "harness/measure/measurement.hpp"

namespace fieldproof::reports {

nlohmann::ordered_json course_json(const measure::Course& course);

// Which values were the longest, and when they came; empty where all are equal.
std::string course_text(const measure::Course& course);

}  // namespace fieldproof::reports
