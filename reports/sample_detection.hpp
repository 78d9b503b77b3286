// For tests: what `matrix --sequences` says of three mutants under two seeds.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fieldproof::reports {

// One is found under both seeds, one under one of them, one does nothing else than the reference.
inline nlohmann::ordered_json sample_detection(const std::string& hostile) {
  using Ordered = nlohmann::ordered_json;
  const auto seed = [](const Ordered& triggered, const Ordered& found) {
    return Ordered{{"commands", 1000},
                   {"triggered", triggered},
                   {"found", found},
                   {"reason", found.is_null() ? "" : "write_not_taken"}};
  };
  const auto mutant = [](const std::string& name, const std::string& suite_catch, const Ordered& seeds) {
    return Ordered{
        {"name", name}, {"description", "does " + name}, {"suite_catch", suite_catch}, {"seeds", seeds}};
  };
  Ordered mutants = Ordered::array();
  mutants.push_back(mutant("answers_late", "case_1, late", Ordered::array({seed(10, 40), seed(30, 60)})));
  mutants.push_back(mutant(hostile, "case_2, lost", Ordered::array({seed(700, nullptr), seed(5, 8)})));
  mutants.push_back(mutant("sleeps", "", Ordered::array({seed(nullptr, nullptr), seed(nullptr, nullptr)})));
  Ordered role = {{"role", "valve_bus/node"},
                  {"first_seed", "7"},
                  {"seeds", 2},
                  {"most_commands", 1000},
                  {"complete", true},
                  {"found", 3},
                  {"of", 6},
                  {"false_alarms", Ordered::array()},
                  {"mutants", std::move(mutants)}};
  return {{"schema", "fieldproof/detection/1"},
          {"roles", Ordered::array({std::move(role)})},
          {"command", "fieldproof matrix valve_bus/node --sequences --seed 7 --seeds 2 --commands 1000"}};
}

}  // namespace fieldproof::reports
