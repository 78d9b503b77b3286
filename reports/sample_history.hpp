// For tests: a history with everything on it, and names that try to leave their element.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>

#include "reports/history.hpp"

namespace fieldproof::reports {

inline std::shared_ptr<const History> sample_history(const std::string& hostile) {
  auto history = std::make_shared<History>();
  history->folder = hostile;
  history->setups = {"ref, volume full", hostile};
  for (std::size_t n = 0; n < 12; ++n) {
    history->runs.push_back({fmt::format("2026/{}{}", n, hostile),
                             fmt::format("2026-01-{:02}T00:00:00Z", n + 1), n % 2, "suite 1", n,
                             n == 11 ? judge::Verdict::fail : judge::Verdict::pass, "1 of 9 failed",
                             8 + n % 2, 1 - n % 2, 0, 0, 1'000'000 + 40'000 * n});
  }
  history->flaky = {
      {"valve_bus/node/" + hostile,
       1,
       "suite 1",
       true,
       {{1, judge::Verdict::pass}, {3, judge::Verdict::fail}, {5, judge::Verdict::inconclusive}}}};
  history->broken = {{"valve_bus/node/" + hostile, 0, 4, 6, hostile}};
  Quantity rising{hostile, "us", 0, {}, {12, 1e-7, 1.5}};
  Quantity open{"gap", "us", 1, {}, {12, 0.03, 0.5}};
  for (std::size_t n = 0; n < 12; ++n) {
    rising.values.emplace_back(n, 800 + 1.5 * static_cast<double>(n));
    open.values.emplace_back(n, static_cast<double>(n * 7 % 5));
  }
  history->quantities = {rising, open};
  history->varying = 2;
  history->found = {3, {{hostile, hostile}}};
  return history;
}

}  // namespace fieldproof::reports
