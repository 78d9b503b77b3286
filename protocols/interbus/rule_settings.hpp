#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/iut/device.hpp"
#include "protocols/interbus/rules.hpp"

// Rules as settings of a case, by which an implementation outside is told them: what slaves and masters share
// of line, frame, words and supervision. Each role adds its own. Read back, every value is brought into its
// range; one that is not told stays the reference's.
namespace fieldproof::interbus {

using Settings = std::vector<std::pair<std::string, std::int64_t>>;

void tell_rules(const Rules& rules, Settings& settings);
// Throws kernel::Error for a frame check that no catalogue has.
void read_rules(const iut::CaseBegin& begin, Rules& rules);

// A setting within 0 to `most`; `absent` where there is none.
std::int64_t setting_within(const iut::CaseBegin& begin, std::string_view name, std::int64_t absent,
                            std::int64_t most);

}  // namespace fieldproof::interbus
