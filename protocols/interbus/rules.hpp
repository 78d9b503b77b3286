#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/telegram.hpp"

// Every number and every genuine option of INTERBUS that this project uses, one member each, with source and
// standing in its row of `kRulesTable`. A station takes its numbers from here and from nowhere else, so a
// mutant may be the reference with one number changed.
//
// What could not be verified without IEC 61158-3-8/-4-8 at hand (order and polarity of the header levels, the
// loopback word, the coding of status word, control word and message bits, the final XOR of the frame check)
// stands in this one table and can be exchanged as a whole. Wire compatibility with real INTERBUS is
// therefore not claimed.
namespace fieldproof::field {
template <typename T>
struct Table;
}

namespace fieldproof::interbus {

// Length code of an ID code (its bits 8..12): not the binary number of words.
struct LengthCode {
  std::uint8_t code;
  std::uint16_t words;
};

// The codes with a whole number of words, by rising words; 00h is "no data". The codes 08h..0Dh, 10h and
// 18h..1Fh stay undefined: the first seven are said to mean lengths below or between whole words, but their
// values could not be verified.
std::span<const LengthCode> published_length_codes();

struct Rules {
  // Line.
  std::int64_t bit_rate = 500'000;  // bit/s
  line::TelegramLayout telegram;
  // Mean idle time after a telegram of a cycle, in thousandths of a bit: 0.15 * 13 bit.
  unsigned telegram_gap_millibits = 1950;
  unsigned status_pitch_bits = 6;  // from start to start of status telegrams in a pause
  // Retiming of a remote-bus station on the way out and on the way back, in half bits: 2 * 1.5 bit a station.
  unsigned forward_delay_half_bits = 3;
  unsigned return_delay_half_bits = 3;
  // The same for a station on a local bus: its logic-level lines run inside one remote-bus station.
  unsigned local_delay_half_bits = 0;
  std::int64_t cable_delay_ps_per_m = 5'000;

  // Cycle.
  std::uint16_t loopback_word = 0xA55A;
  std::string frame_check = "CRC-16/IBM-3740";
  std::uint16_t status_clean = 0x0000;
  std::uint16_t status_marked = 0xFFFF;  // an erring station ORs these bits in
  // Telegrams after the status word. The printed formula counts 8 + n telegrams where the text of the same
  // source has 6 + n; 2 here gives the printed reading.
  unsigned end_telegrams = 0;
  kernel::Duration software_time = 450 * kernel::kMicrosecond;  // of the master, chip generation 4

  // Supervision.
  kernel::Duration silence_limit = 25 * kernel::kMillisecond;
  kernel::Duration silence_tolerance = 1 * kernel::kMillisecond;
  kernel::Duration latch_limit = 50 * kernel::kMicrosecond;  // outputs, after the last check telegram
  unsigned stop_after_bad_cycles = 10;
  unsigned quality_bad_cycles = 20;
  unsigned quality_window_cycles = 1'000'000;
  unsigned published_recovery_cycles = 5;

  // Limits.
  unsigned max_stations = 512;
  unsigned max_io_points = 4096;
  unsigned max_levels = 16;       // the main line is the first
  unsigned max_distance_m = 400;  // of cable between two remote-bus stations; 150 at 2 Mbit/s
  unsigned max_cable_m = 12'800;  // of remote bus in a network

  // Control word, master to slave in the ID cycle.
  std::uint16_t control_remote_off = 0x0001;   // OUT1
  std::uint16_t control_local_off = 0x0002;    // OUT2
  std::uint16_t control_reset = 0x0004;        // the outgoing bus
  std::uint16_t control_acknowledge = 0x0008;  // clears the messages

  // Message bits of the ID register, slave to master in the ID cycle.
  std::uint16_t message_reconfiguration = 0x2000;
  std::uint16_t message_check_error = 0x4000;
  std::uint16_t message_peripheral_fault = 0x8000;

  std::vector<LengthCode> length_codes;  // empty: published_length_codes()
};

// The codes in force.
std::span<const LengthCode> length_codes_of(const Rules& rules);

// Every member of Rules with its unit, range, source and standing.
extern const field::Table<Rules> kRulesTable;
// The same without the bit rate, which a network file gives beside its rules.
extern const field::Table<Rules> kRulesInAFile;

}  // namespace fieldproof::interbus
