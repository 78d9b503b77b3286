#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "harness/kernel/time.hpp"
#include "harness/line/gap_frame.hpp"
#include "harness/line/uart.hpp"

// Every number and every genuine option of the RS-485 bus for pneumatic valves, one member each, with source
// and standing in its row of `kRulesTable`. A station takes its numbers from here and from nowhere else, so a
// mutant may be the reference with one number changed.
//
// The paper gives the frames, the addresses, the block check and the bit rate; it gives no character format,
// no timing and no delimiter of frames. What was added to make a bus of it stands in this one table and is
// marked as the project's own choice: nothing here is a standard.
namespace fieldproof::field {
template <typename T>
struct Table;
}

namespace fieldproof::valve_bus {

enum class CharacterProfile : std::uint8_t {
  ninth_bit_one,  // P0: start, 8 data bits, a ninth bit that is 1, stop; receivers ignore the ninth bit
  even_parity,    // P1: start, 8 data bits, even parity, stop
  eight_bits,     // P2: start, 8 data bits, stop
};

struct Rules {
  // Line.
  std::int64_t bit_rate = 375'000;  // bit/s
  CharacterProfile characters = CharacterProfile::ninth_bit_one;
  unsigned longest_gap_half_characters = 3;  // inside a frame
  unsigned delimiter_half_characters = 7;    // of silence, between frames
  unsigned driver_on_bits = 1;               // at least, in front of the first start bit
  unsigned driver_off_bits = 2;              // at most, behind the last stop bit

  // Frames.
  unsigned first_address = 1;
  unsigned last_address = 99;
  unsigned write_command = 0;
  unsigned read_command = 1;

  // Node. Times begin with the delimiter after the command.
  kernel::Duration turnaround_time_span = 2 * kernel::kMillisecond;  // within which a response begins
  kernel::Duration actuation_limit = 2 * kernel::kMillisecond;
  kernel::Duration output_skew = 1 * kernel::kMicrosecond;  // of the outputs that one command changes
  bool answers_writes = false;    // the option ACK: a node answers a write with what it has taken
  kernel::Duration loss_limit{};  // valves off without a command for so long; zero: they hold

  // Host.
  kernel::Duration response_wait = 3 * kernel::kMillisecond;   // behind the delimiter
  kernel::Duration write_distance = 1 * kernel::kMillisecond;  // behind the delimiter, to the next frame
  unsigned read_attempts = 3;
  kernel::Duration refresh = 50 * kernel::kMillisecond;
  unsigned fifo_octets = 512;
  kernel::Duration partial_command_limit = 100 * kernel::kMillisecond;

  // Network.
  unsigned unit_loads = 32;  // of a segment, host and repeaters included
  unsigned max_nodes = 256;
  unsigned max_length_m = 1000;  // without a repeater
  kernel::Duration repeater_delay = 10 * kernel::kMicrosecond;
  std::int64_t cable_delay_ps_per_m = 5'000;

  friend bool operator==(const Rules&, const Rules&) = default;
};

// What a receiver takes for a character. Of P0 the ninth bit is data bit 8.
line::CharacterFormat character_format(const Rules& rules);
// The line and its times. Of P0 the ninth bit of what is sent is 1.
line::Uart uart(const Rules& rules);
// "P0", "P1", "P2".
std::string_view text_of(CharacterProfile profile);

inline kernel::Duration half_characters(const Rules& rules, unsigned count) {
  return uart(rules).half_characters(count);
}
inline kernel::Duration bits(const Rules& rules, std::int64_t count) {
  return uart(rules).bits(count);
}
inline kernel::Duration character_time(const Rules& rules) {
  return half_characters(rules, 2);
}
inline kernel::Duration longest_gap(const Rules& rules) {
  return half_characters(rules, rules.longest_gap_half_characters);
}
inline kernel::Duration delimiter(const Rules& rules) {
  return half_characters(rules, rules.delimiter_half_characters);
}

inline kernel::Duration character_notice(const Rules& rules) {
  return uart(rules).character_notice();
}
inline line::InterCharacterGaps gaps(const Rules& rules) {
  return {longest_gap(rules), delimiter(rules), character_notice(rules)};
}
// What a node may take after the delimiter, to begin its response and to move its valves: the span and the
// limit of the rules, or twice the notice at bit rates at which that is longer.
kernel::Duration turnaround_time_span(const Rules& rules);
kernel::Duration actuation_limit(const Rules& rules);

// How long a host waits after its last stop bit for the first start bit of the response: a delimiter and the
// wait of the rules, or what a node may take and a notice of it where that is longer.
kernel::Duration response_time_out(const Rules& rules);

// The bit rates of the DIP switches, position by position: what a timer at 12 MHz makes of its reload values.
std::span<const std::int64_t> dip_bit_rates();

// Every member of Rules with its unit, range, source and standing.
extern const field::Table<Rules> kRulesTable;

}  // namespace fieldproof::valve_bus
