#pragma once

#include <cstdint>

#include "conformance/valve_bus/host_side.hpp"

// What sequences have a PC do that takes many commands or an exact instant. Everything has ended before each
// of them begins.
namespace fieldproof::conformance {

line::Levels levels_of_response(const HostBench& bench, const valve_bus::Response& response);

struct HostBurst {
  unsigned count = 1;
  unsigned nodes = 0;  // of which each gets one command, in front of the rest
  bool is_read = false;
  unsigned part = 0;  // octets of another command
};
void order_burst(HostSide& side, const HostBurst& burst);

// So many writes while a read waits for its response, and so many octets of another, the rest of which comes
// when one of them has been sent.
void fill_up(HostSide& side, unsigned count, unsigned part);
void order_torn(HostSide& side, unsigned count, kernel::Duration between);
// A response that comes when the last attempt has ended.
void serve_late(HostSide& side, std::uint8_t id, const valve_bus::Response& response);
// The line is not silent for so many halves of a time-out while a read is to be sent.
void talk_over(HostSide& side, std::uint8_t id, unsigned halves);
// `judge`: of the jitter; null: none.
void read_in_turn(HostSide& side, unsigned nodes, CaseJudge* judge);

}  // namespace fieldproof::conformance
