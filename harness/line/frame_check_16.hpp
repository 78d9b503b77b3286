// A 16-bit frame check for hot paths: small tables in the object, everything short inline.
//
// Same results as FrameCheck with the same parameters. The register is kept in line order for both
// directions of bits: its low octet is the next check octet to leave, so one loop serves reflected and
// unreflected sets, and `check_octets` is the register itself. One octet costs a table look-up; eight octets
// go through eight tables at once; from 64 octets on the message is folded by carry-less multiplication where
// the processor has it (asked once, at run time; the result never depends on it).
//
// An object is 4 kB of immutable tables: build one and share it (`shared_frame_check_16`), between threads
// too. It can be constexpr.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "harness/kernel/check.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::line {

class FrameCheck16 {
 public:
  // The register in line order.
  using State = std::uint16_t;

  // The width must be 16 and refin == refout, as in every 16-bit set of the catalogue.
  constexpr explicit FrameCheck16(const FrameCheckParameters& parameters);

  constexpr State start() const { return start_; }

  constexpr State update_octet(State state, std::uint8_t octet) const {
    return static_cast<State>((state >> 8) ^ tables_[0][(state ^ octet) & 0xFF]);
  }

  State update(State state, std::span<const std::uint8_t> octets) const {
    return octets.size() < kFoldFrom ? update_short(state, octets.data(), octets.size())
                                     : update_long(state, octets);
  }

  // The ways that `update` chooses from, for tests and measurements. fold() needs at least 64 octets and
  // can_fold().
  State update_by_table(State state, std::span<const std::uint8_t> octets) const;
  State update_by_slices(State state, std::span<const std::uint8_t> octets) const {
    return update_short(state, octets.data(), octets.size());
  }
  State update_by_folding(State state, std::span<const std::uint8_t> octets) const;
  static bool can_fold();

  // One bit in the order of the line.
  constexpr State update_bit(State state, bool bit) const;

  // The check value as the catalogues print it.
  constexpr std::uint16_t finish(State state) const {
    return static_cast<std::uint16_t>((is_reflected_ ? state : swapped(state)) ^ xorout_);
  }
  std::uint16_t compute(std::span<const std::uint8_t> octets) const { return finish(update(start_, octets)); }

  // What a sender puts on the line after the message, in this order.
  constexpr std::array<std::uint8_t, 2> check_octets(State state) const {
    const auto bits = static_cast<unsigned>(state ^ xorout_in_line_order_);
    return {static_cast<std::uint8_t>(bits & 0xFF), static_cast<std::uint8_t>(bits >> 8)};
  }

  // True when what was read is a message followed by its check octets.
  constexpr bool is_residue(State state) const { return state == residue_; }

 private:
  static constexpr std::size_t kFoldFrom = 64;
  static constexpr std::size_t kSlices = 8;

  // Multipliers that move the upper and the lower half of a 128-bit block ahead by `distance` bits; `low`
  // goes with the half in the low word of the register.
  struct Fold {
    std::uint64_t low;
    std::uint64_t high;
  };

  static constexpr std::uint16_t swapped(unsigned bits) {
    return static_cast<std::uint16_t>(((bits << 8) | ((bits >> 8) & 0xFF)) & 0xFFFF);
  }
  static constexpr State in_line_order(FrameCheckValue value, bool value_is_reflected, bool reflected) {
    if (value_is_reflected != reflected) value = reflect(value, 16);
    const auto bits = static_cast<unsigned>(value);
    return reflected ? static_cast<State>(bits) : swapped(bits);
  }
  constexpr Fold fold_by(unsigned distance) const;
  constexpr unsigned power_of_x(unsigned exponent) const;

  static std::uint64_t load(const std::uint8_t* octets) {
    std::uint64_t word = 0;
    std::memcpy(&word, octets, sizeof word);
    if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap64(word);
    return word;
  }

  State update_eight(State state, const std::uint8_t* octets) const {
    const std::uint64_t x = state ^ load(octets);
    return static_cast<State>(tables_[7][x & 0xFF] ^ tables_[6][(x >> 8) & 0xFF] ^
                              tables_[5][(x >> 16) & 0xFF] ^ tables_[4][(x >> 24) & 0xFF] ^
                              tables_[3][(x >> 32) & 0xFF] ^ tables_[2][(x >> 40) & 0xFF] ^
                              tables_[1][(x >> 48) & 0xFF] ^ tables_[0][x >> 56]);
  }
  State update_short(State state, const std::uint8_t* octets, std::size_t left) const {
    for (; left >= kSlices; left -= kSlices, octets += kSlices) state = update_eight(state, octets);
    for (; left > 0; --left) state = update_octet(state, *octets++);
    return state;
  }
  State update_long(State state, std::span<const std::uint8_t> octets) const {
    return can_fold() ? update_by_folding(state, octets) : update_by_slices(state, octets);
  }

  std::array<std::array<std::uint16_t, 256>, kSlices> tables_{};
  bool is_reflected_;
  unsigned poly_;
  State start_;
  State residue_;
  State xorout_in_line_order_;
  std::uint16_t xorout_;
  // Ahead by one, two, three and four blocks of 128 bits.
  std::array<Fold, 4> folds_{};
};

// One object per 16-bit set of the catalogue, built at its first use and shared by the whole program; the
// name may be an alias. Throws kernel::Error (configuration) for a name that is no 16-bit set.
const FrameCheck16& shared_frame_check_16(std::string_view name);

constexpr FrameCheck16::FrameCheck16(const FrameCheckParameters& parameters)
    : is_reflected_(parameters.refin),
      poly_(static_cast<unsigned>(parameters.poly)),
      start_(in_line_order(parameters.init, false, parameters.refin)),
      residue_(in_line_order(parameters.residue, parameters.refout, parameters.refin)),
      xorout_in_line_order_(in_line_order(parameters.xorout, parameters.refout, parameters.refin)),
      xorout_(static_cast<std::uint16_t>(parameters.xorout)) {
  FIELDPROOF_CHECK(parameters.width == 16 && parameters.refin == parameters.refout && (poly_ & 1) == 1,
                   "FrameCheck16 is made from parameters that are not those of a 16-bit check");
  for (unsigned octet = 0; octet < 256; ++octet) {
    State state = 0;
    for (unsigned bit = 0; bit < 8; ++bit) {
      state = update_bit(state, ((octet >> (is_reflected_ ? bit : 7 - bit)) & 1) != 0);
    }
    tables_[0][octet] = state;
  }
  for (std::size_t slice = 1; slice < kSlices; ++slice) {
    for (std::size_t octet = 0; octet < 256; ++octet) {
      tables_[slice][octet] = update_octet(tables_[slice - 1][octet], 0);
    }
  }
  for (unsigned blocks = 1; blocks <= folds_.size(); ++blocks) folds_[blocks - 1] = fold_by(128 * blocks);
}

constexpr FrameCheck16::State FrameCheck16::update_bit(State state, bool bit) const {
  const unsigned in = bit ? 1 : 0;
  if (is_reflected_) {
    const bool leaves = ((state ^ in) & 1) != 0;
    return static_cast<State>((state >> 1) ^ (leaves ? static_cast<unsigned>(reflect(poly_, 16)) : 0));
  }
  const unsigned value = swapped(state);
  const bool leaves = ((value >> 15) ^ in) != 0;
  return swapped(((value << 1) & 0xFFFF) ^ (leaves ? poly_ : 0));
}

// x^exponent modulo the polynomial.
constexpr unsigned FrameCheck16::power_of_x(unsigned exponent) const {
  unsigned power = 1;
  for (; exponent > 0; --exponent) power = ((power << 1) & 0xFFFF) ^ ((power & 0x8000) != 0 ? poly_ : 0);
  return power;
}

constexpr FrameCheck16::Fold FrameCheck16::fold_by(unsigned distance) const {
  if (!is_reflected_) return {power_of_x(distance), power_of_x(distance + 64)};
  // The product of two reflected 64-bit words lies one bit low in 128 bits: one power less makes up for it.
  return {static_cast<std::uint64_t>(reflect(power_of_x(distance + 63), 64)),
          static_cast<std::uint64_t>(reflect(power_of_x(distance - 1), 64))};
}

}  // namespace fieldproof::line
