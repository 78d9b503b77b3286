#include "protocols/token_bus/line_code.hpp"

#include <algorithm>
#include <array>

#include "harness/kernel/check.hpp"
#include "harness/line/delimited_frame.hpp"
#include "harness/line/manchester.hpp"

namespace fieldproof::token_bus {
namespace {

using enum PhySymbol;

constexpr line::ManchesterLayout kPhyLayout{.one_falls = false, .most_significant_first = false};

const line::ManchesterCode& phy_code() {
  static const line::ManchesterCode code{kPhyLayout};
  return code;
}

// Idle is the level of the line, for both halves of a bit.
line::Symbol line_symbol_of(PhySymbol symbol) {
  if (symbol == idl) return line::Symbol::non_data_plus;
  return symbol == cd1 ? line::Symbol::one : line::Symbol::zero;
}

ReceivedBit received_bit(bool first_half, bool second_half) {
  switch (phy_code().symbol_of(first_half, second_half)) {
    case line::Symbol::zero:
      return {cd0, {}};
    case line::Symbol::one:
      return {cd1, {}};
    case line::Symbol::non_data_plus:
      return {idl, {}};
    case line::Symbol::non_data_minus:
      break;
  }
  return {idl, {.has_carrier = true, .has_signal_error = true}};
}

// The half bit at which bits begin: 0 or 1.
std::size_t first_bit_in(const line::Levels& half_bits) {
  std::size_t edge = 0;
  for (std::size_t n = half_bits.end_of_run(0); n < half_bits.size(); n = half_bits.end_of_run(n)) {
    if (n - edge == 2 && edge > 0) return (edge + 1) % 2;
    edge = n;
  }
  return 0;
}

}  // namespace

std::string written(std::span<const PhySymbol> symbols) {
  std::string text;
  for (const PhySymbol symbol : symbols) text += symbol == idl ? 'I' : symbol == cd1 ? '1' : '0';
  return text;
}

PhyPair MacEncoder::encode(MacSymbol symbol) {
  const bool is_second = is_second_non_data_;
  is_second_non_data_ = symbol == MacSymbol::non_data && !is_second;
  return encoded(symbol, is_second);
}

PhyPair MacEncoder::encoded(MacSymbol symbol, bool is_second_non_data) const {
  switch (symbol) {
    case MacSymbol::silence:
      return {idl, idl};
    case MacSymbol::pad_idle:
    case MacSymbol::one:
      return {cd1, cd0};
    case MacSymbol::zero:
      return {cd0, cd1};
    case MacSymbol::non_data:
      return is_second_non_data ? PhyPair{cd0, cd0} : PhyPair{cd1, cd1};
    case MacSymbol::bad_signal:
      break;
  }
  FIELDPROOF_CHECK(false, "nobody requests bad_signal");
  return {idl, idl};
}

PhySymbols phy_symbols_of(std::span<const MacSymbol> symbols) {
  PhySymbols bits;
  bits.reserve(2 * symbols.size());
  MacEncoder encoder;
  for (const MacSymbol symbol : symbols) {
    const PhyPair pair = encoder.encode(symbol);
    bits.push_back(pair.first);
    bits.push_back(pair.second);
  }
  return bits;
}

void append(line::Levels& half_bits, std::span<const PhySymbol> symbols) {
  for (const PhySymbol symbol : symbols) phy_code().append(half_bits, line_symbol_of(symbol));
}

// Its two half bits, the first in bit 0.
static std::uint64_t halves_of(PhySymbol symbol) {
  static const std::array<std::uint64_t, 3> halves = [] {
    std::array<std::uint64_t, 3> all{};
    for (const PhySymbol one : {cd0, cd1, idl}) {
      line::Levels levels;
      append(levels, std::array{one});
      all.at(static_cast<std::size_t>(one)) = levels.window(0) & 3U;
    }
    return all;
  }();
  return halves[static_cast<std::size_t>(symbol)];
}

line::Levels half_bits_of(std::span<const MacSymbol> symbols) {
  constexpr unsigned kHalfBitsOfSymbol = 4;
  line::Levels half_bits;
  half_bits.make_room(kHalfBitsOfSymbol * symbols.size());
  MacEncoder encoder;
  for (const MacSymbol symbol : symbols) {
    const PhyPair pair = encoder.encode(symbol);
    half_bits.append(halves_of(pair.first) | halves_of(pair.second) << 2, kHalfBitsOfSymbol);
  }
  return half_bits;
}

// ---- MacDecoder ----

namespace {

enum class Cell : std::uint8_t { silence, zero, one, first_non_data, second_non_data, cut, bad };

struct Row {
  PhyPair pair;
  std::array<Cell, 3> cells;  // carrier off; on; on, with a signal error
};

constexpr std::array<Row, 9> kRows{{
    {{cd1, cd0}, {Cell::silence, Cell::one, Cell::bad}},
    {{cd0, cd1}, {Cell::silence, Cell::zero, Cell::bad}},
    {{cd1, cd1}, {Cell::silence, Cell::first_non_data, Cell::bad}},
    {{cd0, cd0}, {Cell::silence, Cell::second_non_data, Cell::bad}},
    {{cd1, idl}, {Cell::silence, Cell::cut, Cell::bad}},
    {{cd0, idl}, {Cell::silence, Cell::cut, Cell::bad}},
    {{idl, cd1}, {Cell::silence, Cell::silence, Cell::bad}},
    {{idl, cd0}, {Cell::silence, Cell::silence, Cell::bad}},
    {{idl, idl}, {Cell::silence, Cell::silence, Cell::bad}},
}};

Cell cell_of(PhyPair pair, LineStatus status) {
  const std::size_t column = !status.has_carrier ? 0 : status.has_signal_error ? 2 : 1;
  const auto* const row = std::ranges::find_if(kRows, [&](const Row& one) { return one.pair == pair; });
  return row->cells.at(column);
}

}  // namespace

void MacDecoder::reset() {
  first_.reset();
  lose_lock();
}

void MacDecoder::lose_lock() {
  clock_->lose_lock();
  expects_second_ = false;
}

std::optional<MacSymbol> MacDecoder::take(PhySymbol bit, LineStatus status) {
  if (clock_->drops_bit()) return std::nullopt;
  if (!first_) {
    first_ = First{bit, status.has_signal_error};
    return std::nullopt;
  }
  status.has_signal_error |= first_->has_signal_error;
  const PhyPair pair{first_->symbol, bit};
  first_.reset();
  return indicate(pair, status);
}

MacSymbol MacDecoder::indication(PhyPair pair, LineStatus status) const {
  using enum MacSymbol;
  switch (cell_of(pair, status)) {
    case Cell::silence:
      return silence;
    case Cell::zero:
      return expects_second_ ? bad_signal : zero;
    case Cell::one:
      return expects_second_ ? bad_signal : one;
    case Cell::first_non_data:
      return expects_second_ ? bad_signal : non_data;
    case Cell::second_non_data:
      return expects_second_ ? non_data : bad_signal;
    case Cell::cut:
      return last_.is_seen() ? silence : bad_signal;
    case Cell::bad:
      break;
  }
  return bad_signal;
}

MacSymbol MacDecoder::indicate(PhyPair pair, LineStatus status) {
  const MacSymbol symbol = indication(pair, status);
  last_.take(symbol);
  if (!status.has_carrier || (!status.has_signal_error && pair.second == idl)) {
    lose_lock();
    return symbol;
  }
  if (pair.first != idl || pair.second != idl) clock_->notice_bits();
  expects_second_ = expects_second_after(symbol);
  clock_->follow(symbol);
  return symbol;
}

// ---- a whole transmission ----

std::vector<ReceivedBit> received_bits(const line::Waveform& wave, std::int64_t phy_bit_rate,
                                       std::size_t* first_half_bit) {
  const line::Levels half_bits = line::half_bits_of(wave, phy_bit_rate);
  std::size_t at = first_bit_in(half_bits);
  if (first_half_bit != nullptr) *first_half_bit = at;
  std::vector<ReceivedBit> bits;
  bits.reserve(half_bits.size() / 2 + 3);
  // Beyond its end the line is idle: a half bit that is left over has its partner there.
  for (; at < half_bits.size(); at += 2) bits.push_back(received_bit(half_bits[at], half_bits[at + 1]));
  for (unsigned n = 0; n < 2; ++n) bits.push_back({idl, {}});
  return bits;
}

std::vector<Indication> indications_in(const line::Waveform& wave, std::int64_t phy_bit_rate) {
  MacDecoder decoder;
  return indications_in(wave, phy_bit_rate, decoder);
}

std::vector<Indication> indications_in(const line::Waveform& wave, std::int64_t phy_bit_rate,
                                       MacDecoder& decoder) {
  std::size_t half_bit = 0;
  const std::vector<ReceivedBit> bits = received_bits(wave, phy_bit_rate, &half_bit);
  std::vector<Indication> indications;
  indications.reserve(bits.size() / 2);
  for (std::size_t n = 0; n < bits.size(); ++n, half_bit += 2) {
    const auto symbol = decoder.take(bits[n].symbol, bits[n].status);
    if (symbol) indications.push_back({*symbol, half_bit >= 2 ? half_bit - 2 : 0});
  }
  return indications;
}

}  // namespace fieldproof::token_bus
