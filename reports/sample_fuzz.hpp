// For tests: a search of `fuzz` that ended with a finding.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fieldproof::reports {

inline nlohmann::ordered_json sample_fuzz(const std::string& hostile) {
  using Ordered = nlohmann::ordered_json;
  Ordered growth = Ordered::array();
  int edges = 12;
  for (const int run : {1, 2, 5, 10, 20, 50, 100, 200, 341}) {
    growth.push_back({{"run", run}, {"edges", edges}, {"kept", edges / 3}});
    edges += 40 - edges / 8;
  }
  return {{"schema", "fieldproof/fuzz/1"},
          {"role", "valve_bus/node"},
          {"seed", "7"},
          {"implementations", {{{"role", ""}, {"position", 0}, {"uri", hostile}}}},
          {"run", 340},
          {"stored",
           {{"read", 3}, {"run", 1}, {"left_out", {{{"file", hostile}, {"because", "line 1: it is cut"}}}}}},
          {"passed", 340},
          {"silent", 2},
          {"inconclusive", 1},
          {"has_coverage", true},
          {"edges", growth.back()["edges"]},
          {"kept", growth.back()["kept"]},
          {"corpus", 31},
          {"growth", growth},
          {"ended_because", "the time of --max-time was over"},
          {"found",
           {{"found_in", "sequence 341"},
            {"commands", 2},
            {"faults", 1},
            {"is_confirmed", true},
            {"drawn_commands", 14},
            {"shrinking_runs", 312},
            {"input", {"write data0 165 data1 60", hostile}},
            {"reproduce", "fieldproof replay found.json"},
            {"reason", "write_not_taken"},
            {"requirement", "A node takes a command for its address."},
            {"expected", {"valves A5 3C", "valves 00 00"}},
            {"actual", hostile}}},
          {"command", "fieldproof fuzz valve_bus/node --seed 7 --cases 500"}};
}

}  // namespace fieldproof::reports
