// For tests: documents of a campaign and of a fit, with names that try to leave their element.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace fieldproof::reports {

// Three jobs of each of eight levels and pulses, and a run that fails.
inline nlohmann::ordered_json sample_campaign(const char* hostile) {
  using Ordered = nlohmann::ordered_json;
  Ordered jobs = Ordered::array();
  for (int n = 0; n < 24; ++n) {
    jobs.push_back(
        {{"id", n + 1},
         {"command",
          fmt::format("fieldproof emc interbus --test-levels={} --repetition={} --polarity={} "
                      "--seed={} --duration=1s",
                      n / 12 + 3, n / 6 % 2 == 0 ? "5kHz" : "100kHz", n / 3 % 2 == 0 ? "+" : "-", n % 3 + 1)},
         {"exit_code", 0},
         {"headline", n < 12 ? "A" : "B"},
         {"ledger", {{"sent", 1000}, {"detected", n}, {"wrong_cycles", 0}, {"data_differed", n}}}});
  }
  jobs.push_back({{"id", 25},
                  {"command", fmt::format("fieldproof run 'x{}' --seed=1", hostile)},
                  {"exit_code", 1},
                  {"headline", "fail"},
                  {"cases", {{"pass", 3}, {"fail", 1}}},
                  {"failed", {hostile}}});
  jobs.push_back(
      {{"id", 26}, {"command", "fieldproof run y --seed=1"}, {"exit_code", 1}, {"killed", "got signal 9"}});
  return {{"schema", "fieldproof/campaign/1"},
          {"title", hostile},
          {"suite_version", "0.1.0"},
          {"plan_hash", "0123456789abcdef"},
          {"is_complete", true},
          {"incomplete_because", ""},
          {"exit_code", 1},
          {"counts",
           {{"planned", 30},
            {"jobs", 26},
            {"killed", 1},
            {"by_exit_code", {{"0", 24}, {"1", 2}}},
            {"by_headline", {{"A", 12}, {"B", 12}, {"fail", 1}}}}},
          {"cases", {{"by_verdict", {{"pass", 3}, {"fail", 1}}}, {"failed", 1}}},
          {"ledger",
           {{"counts", {{"sent", 24000}, {"detected", 276}, {"wrong_cycles", 0}, {"data_differed", 276}}},
            {"accepted_wrong",
             {{{"of", "sent"}, {"wrong", 0}, {"total", 24000}, {"upper_bound_95", 1.2e-4}},
              {{"of", "data_differed"}, {"wrong", 0}, {"total", 276}, {"upper_bound_95", 0.0108}}}}}},
          {"search",
           {{"counts", {{"run", 24'000}}},
            {"corpora",
             {{{"name", "valve_bus-node-1"},
               {"command", fmt::format("fieldproof fuzz valve_bus/node --iut '{}' --cases=0", hostile)},
               {"jobs", {1, 2, 3}},
               {"sequences", 31},
               {"edges", 132},
               {"growth",
                {{{"run", 1}, {"all", 3}, {"edges", 12}},
                 {{"run", 10}, {"all", 30}, {"edges", 90}},
                 {{"run", 100}, {"all", 300}, {"edges", 131}}}}}}}}},
          {"unverified", {"The coupling is not calibrated."}},
          {"confidence",
           {{"rate", 1e-3},
            {"confidence", 0.95},
            {"of", "sent"},
            {"wrong", 0},
            {"total", 24000},
            {"looks", 4},
            {"lower_bound", 0.0},
            {"upper_bound", 1.3e-4},
            {"decision", "below"}}},
          {"jobs", std::move(jobs)}};
}

inline nlohmann::ordered_json sample_fit(const char* hostile) {
  using Ordered = nlohmann::ordered_json;
  Ordered rows = Ordered::array();
  for (int n = 0; n < 12; ++n) {
    rows.push_back({{"level_v", 250 << (n / 4)},
                    {"repetition", n % 4 < 2 ? "5kHz" : "100kHz"},
                    {"polarity", n % 2 == 0 ? "+" : "-"},
                    {"time_s", 60.0},
                    {"frames", 70000},
                    {"frames_bad", 20 * n},
                    {"undetected", 0},
                    {"expected_bad", 20.0 * n + 3}});
  }
  const Ordered factor = {
      {"value", 0.7}, {"from", 0.6}, {"to", 0.9}, {"is_open_below", true}, {"is_open_above", false}};
  return {{"schema", "fieldproof/emc_fit/1"},
          {"protocol", "interbus"},
          {"network", hostile},
          {"profile", "A"},
          {"bits", 182},
          {"bit_rate", 500000},
          {"gain", factor},
          {"strength", factor},
          {"chi_squared", 9.5},
          {"degrees_of_freedom", 10},
          {"probability", 0.48},
          {"verdict", "consistent"},
          {"undetected", {{"bad", 1320}, {"undetected", 0}, {"upper_bound_of_share", 2.3e-3}}},
          {"rows", std::move(rows)},
          {"command", "fieldproof emc interbus --fit counts.csv"}};
}

}  // namespace fieldproof::reports
