// A signal and what followed it, as the JSON documents of this folder hold it: instants in microseconds.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/measure/measurement.hpp"

namespace fieldproof::reports {

nlohmann::ordered_json trace_json(const measure::Trace& trace);

}  // namespace fieldproof::reports
