#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "harness/line/waveform.hpp"
#include "protocols/token_bus/line_code.hpp"

// How the two sides of a physical layer service translator are levels: four for each unit, and four of idle
// say that nothing is on.
//
//   physical side, each bit of IEEE 802.3    no carrier, no signal error, first half, second half
//   MAC side, each MAC symbol                SMREQ* or SMIND*, symbol 2, symbol 1, symbol 0
//
// On the physical side the halves are those of the Manchester bit, 11 of idle. Of what a translator sends,
// "no carrier" is 0 while its transmitter is on. On the MAC side these are the four circuits of a channel
// beside its clock. Their codes are from memory of the IEEE 802.4G modem interface, consistent with what the
// MC68824's manual says of them: 2 1 0 are
//
//   MAC mode, SM* = 1         zero 000, one 001, non_data 10x, silence 11x; pad_idle (of a request) and
//                             bad_signal (of an indication) 01x
//   management mode, SM* = 0  request: RESET 111, DISABLE LOOPBACK 101, ENABLE TRANSMITTER 011, idle 001,
//                             serial data 000
//                             indication: IDLE 00, ACK 01, NACK 10, physical error 11, and 1
namespace fieldproof::token_bus {

inline constexpr unsigned kUnitLevels = 4;

// ---- physical side ----

struct PhyCell {
  PhySymbol symbol = PhySymbol::idl;
  LineStatus status{.has_carrier = false};

  friend bool operator==(const PhyCell&, const PhyCell&) = default;
};

inline std::int64_t phy_side_rate(std::int64_t phy_bit_rate) {
  return kUnitLevels * phy_bit_rate;
}
std::uint64_t levels_of(const PhyCell& cell);
void append(line::Levels& levels, const PhyCell& cell);
// Two halves of 0 are no bit: idle, with a signal error.
PhyCell phy_cell_at(const line::Levels& levels, std::size_t unit);

// ---- MAC side ----

enum class ManagementCommand : std::uint8_t {
  reset,
  disable_loopback,
  enable_transmitter,
  idle,
  serial_data,
  unknown
};
enum class ManagementAnswer : std::uint8_t { idle, ack, nack, physical_error };
std::string_view text_of(ManagementCommand command);
std::string_view text_of(ManagementAnswer answer);

// In management mode it is a command, else a symbol.
struct MacRequest {
  MacSymbol symbol = MacSymbol::silence;
  std::optional<ManagementCommand> command{};

  friend bool operator==(const MacRequest&, const MacRequest&) = default;
};
struct MacIndication {
  MacSymbol symbol = MacSymbol::silence;
  std::optional<ManagementAnswer> answer{};

  friend bool operator==(const MacIndication&, const MacIndication&) = default;
};

inline std::int64_t mac_side_rate(std::int64_t phy_bit_rate) {
  return kUnitLevels * phy_bit_rate / 2;
}
// bad_signal is no request, pad_idle no indication, `unknown` no command to send: a broken invariant.
std::uint64_t levels_of(const MacRequest& request);
std::uint64_t levels_of(const MacIndication& indication);
void append(line::Levels& levels, const MacRequest& request);
void append(line::Levels& levels, const MacIndication& indication);
MacRequest mac_request_at(const line::Levels& levels, std::size_t unit);
MacIndication mac_indication_at(const line::Levels& levels, std::size_t unit);

// Its four levels as they are.
std::uint64_t unit_at(const line::Levels& levels, std::size_t unit);

// A unit that is cut off ends in idle.
inline std::size_t units_in(const line::Levels& levels) {
  return (levels.size() + kUnitLevels - 1) / kUnitLevels;
}

// Levels at about this rate; others are taken anew from the middle of each level.
line::Waveform at_rate(const line::Waveform& wave, std::int64_t rate);

}  // namespace fieldproof::token_bus
