#pragma once

#include "harness/kernel/time.hpp"
#include "protocols/valve_bus/rules.hpp"

// How long a poll of one node and a cycle over all of them take. The paper prints no time; the forms are
// computed from the frames and the times of Rules.
namespace fieldproof::valve_bus {

// What a poll of one node is made of.
struct PollTime {
  kernel::Duration command{};          // five characters
  kernel::Duration turnaround_time{};  // of the node, to its first start bit
  kernel::Duration response{};         // three characters
  kernel::Duration silence{};          // in front of the next command
  kernel::Duration way{};              // to the node and back

  kernel::Duration total() const { return command + turnaround_time + response + silence + way; }
};

// The least: the next command follows the response by a delimiter.
PollTime least_poll_time(const Rules& rules, kernel::Duration turnaround_time,
                         kernel::Duration distance = {});
// As the reference stations do it: a host that learns of characters at their end is sure of a whole response
// one character later, and its driver comes on in front of the start bit.
PollTime reference_poll_time(const Rules& rules, kernel::Duration distance = {});

// From the first start bit of a write to that of what follows it: a rest where nobody answers it, else as of
// a poll.
kernel::Duration reference_write_time(const Rules& rules, kernel::Duration distance = {});

// Where the node number `node` (from 0) of `nodes` lies on a cable of so many metres, spread evenly, as the
// time from the host to it. After each 30 nodes (31 on the segment of the host) there is a repeater: 32 unit
// loads are 31 nodes and the host, and two of them are repeaters in the segments after.
kernel::Duration distance_of(const Rules& rules, unsigned node, unsigned nodes, double length_m);

}  // namespace fieldproof::valve_bus
