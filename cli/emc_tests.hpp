// Which tests a call of `emc` asks for.
#pragma once

#include <string_view>
#include <vector>

#include "cli/emc_campaign.hpp"
#include "cli/settings.hpp"

namespace fieldproof::cli {

bool is_typed(const Settings& settings, std::string_view option);

// Bursts, or the channel that takes their place: what is typed wins over what a file or a variable says.
bool wants_bursts(const Settings& settings);

// Each level with each repetition and polarity, or each channel. Throws kernel::Error(configuration, usage)
// for an empty list, one that is too long, and words that are none.
std::vector<EmcTest> tests_from(const Settings& settings, bool has_bursts);

}  // namespace fieldproof::cli
