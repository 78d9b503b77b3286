#include "cli/emc_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "cli/burst_options.hpp"
#include "emc/residual/residual_error.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

using emc::Level;
using emc::Polarity;
using emc::Repetition;

constexpr std::array<std::string_view, 5> kBurstOptions = {"test-levels", "repetition", "polarity", "profile",
                                                           "worst"};

// "bsc:0.002".
std::vector<EmcTest> channel_tests_from(const Settings& settings) {
  std::vector<EmcTest> tests;
  for (const std::string& word : settings.words("channel")) {
    const auto flips = word.starts_with("bsc:") ? real_of(std::string_view(word).substr(4)) : std::nullopt;
    if (!flips || !(*flips >= emc::kLeastBer && *flips <= emc::kGreatestBer)) {
      settings.refuse("channel", fmt::format("'{}' is no channel; write bsc:P with P from {:g} to {:g}", word,
                                             emc::kLeastBer, emc::kGreatestBer));
    }
    EmcTest& test = tests.emplace_back();
    test.flip_probability = *flips;
  }
  return tests;
}

std::vector<EmcTest> burst_tests_from(const Settings& settings) {
  const auto repetitions = repetitions_from(settings);
  const auto polarities = polarities_from(settings);
  std::vector<EmcTest> tests;
  for (const Level& level : levels_from(settings)) {
    for (const Repetition repetition : repetitions) {
      for (const Polarity polarity : polarities) {
        EmcTest& test = tests.emplace_back();
        test.level = level;
        test.repetition = repetition;
        test.polarity = polarity;
      }
    }
  }
  return tests;
}

}  // namespace

bool is_typed(const Settings& settings, std::string_view option) {
  return settings.origin(option) == Origin::command_line;
}

bool wants_bursts(const Settings& settings) {
  if (!settings.is_set("channel")) return true;
  const auto typed =
      std::ranges::find_if(kBurstOptions, [&](auto option) { return is_typed(settings, option); });
  if (typed == kBurstOptions.end()) return false;
  if (!is_typed(settings, "channel")) return true;
  settings.refuse("channel", fmt::format("a channel takes the place of bursts; leave out --{}", *typed));
}

std::vector<EmcTest> tests_from(const Settings& settings, bool has_bursts) {
  std::vector<EmcTest> tests = has_bursts ? burst_tests_from(settings) : channel_tests_from(settings);
  if (tests.empty()) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        "an empty list of levels, repetition rates or polarities leaves nothing to test");
  }
  if (tests.size() > kMostTests) {
    settings.refuse(has_bursts ? "test-levels" : "channel",
                    fmt::format("these are {} tests; at most {} make a campaign", tests.size(), kMostTests));
  }
  return tests;
}

}  // namespace fieldproof::cli
