// timeline.json: what happened on the lines of one case around its first finding, for a report to draw.
//
// The protocol's own words come from its dissector. At most 3000 records of each kind are told, 2500 of them
// before the first finding (the last ones, when there is none); `is_cut` says that there was more. Times are
// texts, because they have 64 bit. All text is valid UTF-8.
#pragma once

#include <string>

#include "harness/judge/finding.hpp"
#include "harness/trace/dissector.hpp"
#include "harness/trace/recording.hpp"

namespace fieldproof::reports {

std::string timeline_json(const judge::CaseResult& result, const trace::Recording& recording,
                          const trace::Dissector& dissector);

}  // namespace fieldproof::reports
