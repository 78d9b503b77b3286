#include "protocols/token_bus/service_signals.hpp"

#include <algorithm>
#include <array>

#include "harness/kernel/check.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr std::uint64_t kUnitMask = (1U << kUnitLevels) - 1;

// 2 1 0 as a number, and SM*; the first circuit is the first level.
std::uint64_t circuits(bool is_management, unsigned code) {
  return (is_management ? 0U : 1U) | (code >> 2 & 1U) << 1 | (code >> 1 & 1U) << 2 | (code & 1U) << 3;
}
bool is_management(std::uint64_t unit) {
  return (unit & 1) == 0;
}
unsigned code_in(std::uint64_t unit) {
  return static_cast<unsigned>((unit >> 1 & 1) << 2 | (unit >> 2 & 1) << 1 | (unit >> 3 & 1));
}

// By code; that of `other` is the one symbol that requests and indications do not share.
MacSymbol symbol_of(unsigned code, MacSymbol other) {
  using enum MacSymbol;
  const std::array symbols{zero, one, other, other, non_data, non_data, silence, silence};
  return symbols.at(code);
}
unsigned code_of(MacSymbol symbol, MacSymbol other) {
  constexpr unsigned kSilence = 7;
  if (symbol == MacSymbol::silence) return kSilence;
  for (unsigned code = 0; code < kSilence; ++code)
    if (symbol_of(code, other) == symbol) return code;
  FIELDPROOF_CHECK(false, "a channel carries its own symbols");
  return kSilence;
}

constexpr std::array kCommands{ManagementCommand::serial_data, ManagementCommand::idle,
                               ManagementCommand::unknown,     ManagementCommand::enable_transmitter,
                               ManagementCommand::unknown,     ManagementCommand::disable_loopback,
                               ManagementCommand::unknown,     ManagementCommand::reset};

}  // namespace

std::uint64_t unit_at(const line::Levels& levels, std::size_t unit) {
  return levels.window(std::min(unit * kUnitLevels, levels.size())) & kUnitMask;
}

// ---- physical side ----

std::uint64_t levels_of(const PhyCell& cell) {
  const std::uint64_t halves = cell.symbol == PhySymbol::idl ? 3 : cell.symbol == PhySymbol::cd1 ? 2 : 1;
  return (cell.status.has_carrier ? 0U : 1U) | (cell.status.has_signal_error ? 0U : 2U) | halves << 2;
}

void append(line::Levels& levels, const PhyCell& cell) {
  levels.append(levels_of(cell), kUnitLevels);
}

PhyCell phy_cell_at(const line::Levels& levels, std::size_t unit) {
  const std::uint64_t bits = unit_at(levels, unit);
  PhyCell cell{.status = {.has_carrier = (bits & 1) == 0, .has_signal_error = (bits & 2) == 0}};
  const std::uint64_t halves = bits >> 2;
  if (halves == 0) cell.status.has_signal_error = true;
  if (halves == 1 || halves == 2) cell.symbol = halves == 2 ? PhySymbol::cd1 : PhySymbol::cd0;
  return cell;
}

// ---- MAC side ----

std::string_view text_of(ManagementCommand command) {
  constexpr std::array<std::string_view, 6> kTexts{"RESET",   "DISABLE LOOPBACK", "ENABLE TRANSMITTER",
                                                   "SM idle", "serial data",      "an unknown command"};
  return kTexts.at(static_cast<std::size_t>(command));
}

std::string_view text_of(ManagementAnswer answer) {
  constexpr std::array<std::string_view, 4> kTexts{"IDLE", "ACK", "NACK", "physical error"};
  return kTexts.at(static_cast<std::size_t>(answer));
}

std::uint64_t levels_of(const MacRequest& request) {
  if (!request.command) return circuits(false, code_of(request.symbol, MacSymbol::pad_idle));
  FIELDPROOF_CHECK(*request.command != ManagementCommand::unknown, "a command that is sent is known");
  const auto* const at = std::ranges::find(kCommands, *request.command);
  return circuits(true, static_cast<unsigned>(at - kCommands.begin()));
}

std::uint64_t levels_of(const MacIndication& indication) {
  if (!indication.answer) return circuits(false, code_of(indication.symbol, MacSymbol::bad_signal));
  return circuits(true, static_cast<unsigned>(*indication.answer) << 1 | 1U);
}

void append(line::Levels& levels, const MacRequest& request) {
  levels.append(levels_of(request), kUnitLevels);
}
void append(line::Levels& levels, const MacIndication& indication) {
  levels.append(levels_of(indication), kUnitLevels);
}

MacRequest mac_request_at(const line::Levels& levels, std::size_t unit) {
  const std::uint64_t bits = unit_at(levels, unit);
  if (is_management(bits)) return {.command = kCommands.at(code_in(bits))};
  return {.symbol = symbol_of(code_in(bits), MacSymbol::pad_idle)};
}

MacIndication mac_indication_at(const line::Levels& levels, std::size_t unit) {
  const std::uint64_t bits = unit_at(levels, unit);
  if (is_management(bits)) return {.answer = static_cast<ManagementAnswer>(code_in(bits) >> 1)};
  return {.symbol = symbol_of(code_in(bits), MacSymbol::bad_signal)};
}

line::Waveform at_rate(const line::Waveform& wave, std::int64_t rate) {
  constexpr std::int64_t kPartsOfTolerance = 100;
  const std::int64_t away = wave.rate < rate ? rate - wave.rate : wave.rate - rate;
  if (away <= rate / kPartsOfTolerance) return wave;
  line::Waveform taken{wave.start, rate, {}};
  const kernel::Duration half = kernel::levels_duration(1, 2 * rate);
  while (taken.end() + half < wave.end()) taken.levels.append(wave.at(taken.end() + half) ? 1 : 0, 1);
  return taken;
}

}  // namespace fieldproof::token_bus
