// timeline.json as a page holds it: the same in a quarter of the octets, so that the time lines of many cases
// fit. page/time_line_model.js opens it again.
//
//   {"is_cut": false, "begin_ps": "1000000", "channels": ["master"], "texts": ["data telegram 25h", ...],
//    "transmissions": [[channel, start, length, text, levels, is_changed], ...],
//    "faults": [[channel, time, text], ...], "observations": [[channel, time, what, value], ...],
//    "findings": [[time, requirement, expected, actual], ...], "windows": [[kind, from, to], ...]}
//
// A text is its place in `texts`; times are picoseconds since `begin_ps`, decimal.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace fieldproof::reports {

// `timeline` satisfies timeline.schema.json; a time that is no 64-bit integer is
// kernel::Error(configuration).
nlohmann::ordered_json packed_timeline(const nlohmann::ordered_json& timeline);

}  // namespace fieldproof::reports
