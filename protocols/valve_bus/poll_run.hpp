#pragma once

#include <cstdint>
#include <vector>

#include "protocols/valve_bus/rules.hpp"

// A whole bus that runs: the reference host, whose PC asks for all nodes in turn and never pauses, and
// reference nodes spread along the cable. What a cycle takes is measured at the PC.
namespace fieldproof::valve_bus {

struct PollRunSettings {
  unsigned dip = 0;     // bit rate: position of the switches
  unsigned nodes = 31;  // 1 to 99, addresses from 1 on
  double length_m = 1000;
  unsigned cycles = 10;
  std::uint64_t seed = 1;
};

struct PollRun {
  std::vector<kernel::Duration> cycles;  // from one response of the first node to the next
  std::uint64_t responses = 0;
  std::uint64_t wrong_responses = 0;  // that do not tell the switches of their node
  std::uint64_t errors = 0;
};

// A bus without a node, or with more than have addresses, is a kernel::Error (usage).
PollRun run_polls(const Rules& rules, const PollRunSettings& settings);

}  // namespace fieldproof::valve_bus
