#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "harness/measure/distribution.hpp"
#include "protocols/fieldbus_dll/ff_link.hpp"

// A control loop closed over a link of Foundation Fieldbus: how long from sample to valve, how many samples
// are lost, how often does a block find nothing new, and what does that cost the process?
//
// A scheduler (10), a transmitter (AI, 20), a controller (PID, 21) and a valve (AO, 22), beside eight nodes
// that send messages of 128 octets to each other. Each block runs once in a sampling period, at the same
// place of it whatever the way of its data: AI at 0, PID at 1/2, AO at 19/20. Data go one of two ways:
//   published  into a buffer, which the scheduler compels at 1/8 and at 5/8 of the period
//   by token   as urgent data, when the token comes
//
// With an operator (23) the rest of what applications say goes over the link, too: as a client it writes each
// new setpoint to the controller and reads its value each second; the transmitter reports an alarm as urgent
// data whenever the process crosses the middle between the setpoints, and a trend as time-available data each
// second. The controller knows a setpoint when it has come.
//
// The two phenomena are those of S. H. Hong and others, "Distributed control and automation systems and
// fieldbus", section 5.1 and figures 3 and 4: of several samples that arrive between two executions of a
// block only the newest is used, the others are lost (data loss); a block that finds nothing new works with
// the old (vacant sampling). What arrives at the instant of an execution counts as arrived. Process, tuning
// and messages are this project's choice; the paper names none.
namespace fieldproof::fieldbus_dll {

enum class DataWay : std::uint8_t { published, by_token };

// "published", "by token".
std::string_view text_of(DataWay way);

struct ControlLoopSetting {
  std::uint64_t seed = 1;
  DataWay way = DataWay::published;
  std::int64_t bit_rate = 31'250;
  kernel::Duration sampling_period = 250 * kernel::kMillisecond;
  unsigned periods = 480;
  // Of each of the eight other nodes, time-available; one with 64 waiting drops more.
  double messages_per_s = 0;
  kernel::Duration target_rotation = 60 * kernel::kSecond;  // V(TTRT)
  FfDisturb disturb{};                                      // of all receivers, from the beginning on
  bool has_operator = false;
};

// The link runs for so long before the loop begins, or up to a sampling period longer: by then each node is
// live.
inline kernel::Duration loop_begin(std::int64_t bit_rate) {
  return (bit_rate < 1'000'000 ? 20 : 1) * kernel::kSecond;
}

// The way between two blocks: from AI to PID, from PID to AO. sent == used + lost + missing.
struct HopFigures {
  std::uint64_t sent = 0;
  std::uint64_t used = 0;
  std::uint64_t lost = 0;     // a newer one came before a block used it
  std::uint64_t missing = 0;  // never came, or not before the end
  std::uint64_t vacant = 0;   // executions that found nothing new, since the first that did

  friend bool operator==(const HopFigures&, const HopFigures&) = default;
};

// What a client asked or a station reported. sent == arrived + missing.
struct RelationshipFigures {
  std::uint64_t sent = 0;
  std::uint64_t arrived = 0;    // the response at the client, the report at the operator
  std::uint64_t missing = 0;    // also what was on its way at the end
  measure::Distribution delay;  // ps, until it arrived; of a request until its response did
};

struct LoopPoint {
  double time_s;  // since the loop began
  double setpoint;
  double process;
  double valve;

  friend bool operator==(const LoopPoint&, const LoopPoint&) = default;
};

struct ControlLoop {
  HopFigures to_controller;
  HopFigures to_valve;
  measure::Distribution delay_to_controller;  // ps, from a sample to the execution that uses it
  measure::Distribution loop_delay;           // ps, from a sample to the valve that it moves
  double absolute_error = 0;                  // integral of |setpoint - process|, per cent x s
  double overshoot = 0;                       // the largest, per cent of its step
  double valve_travel = 0;                    // sum of all moves of the valve, per cent
  std::vector<LoopPoint> course;              // ten in a sampling period
  // With an operator.
  RelationshipFigures requests, alarms, trends;
  kernel::Duration longest_without_token{};  // of the transmitter, from PT to PT
};

// Throws kernel::Error(configuration): another rate than the three of the line, a period that is no multiple
// of 250 us or not within 80 ms and 10 s, no period or more than 20 000, a rate that is negative or above 20;
// and when not all nodes are live by loop_begin.
ControlLoop run_control_loop(const ControlLoopSetting& setting);

// The same blocks at the same instants without a bus: what is sent has arrived, and there is no operator.
ControlLoop run_loop_without_bus(const ControlLoopSetting& setting);

}  // namespace fieldproof::fieldbus_dll
