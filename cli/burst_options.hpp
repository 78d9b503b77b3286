// The options of verbs that couple bursts into a network: --test-levels, --repetition and --polarity of a
// campaign,
// --bursts of a measurement, --profile of both. What is no such thing is refused as Settings says.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "cli/settings.hpp"
#include "emc/generator.hpp"
#include "emc/profile.hpp"

namespace fieldproof::cli {

inline constexpr std::size_t kMostTests = 10'000;  // of a campaign

// "3", "1..4", "x:1000", "x:1000..4500:500" and several of them.
std::vector<emc::Level> levels_from(const Settings& settings);
std::vector<emc::Repetition> repetitions_from(const Settings& settings);
std::vector<emc::Polarity> polarities_from(const Settings& settings);
// "3", "3,100kHz", "x:1000,5kHz,-": one level, and what is not said as BurstSettings has it.
emc::BurstSettings bursts_from(const Settings& settings);
emc::Profile profile_from(const Settings& settings);  // a built-in one by its name, or a file

// All of a text as a number.
std::optional<double> real_of(std::string_view text);

}  // namespace fieldproof::cli
