// Frame checks (cyclic redundancy checks) for every parameter set of the public catalogues, widths 3 to 82.
//
// Parameters are written in the usual model: polynomial without its highest term, initial register and final
// XOR in the orientation of the polynomial, `refin` for octets that go least significant bit first, `refout`
// for a check value that is read from the reflected register. The residue is the register after an
// error-free code word, reflected when refout, without the final XOR.
//
// FrameCheck takes all of them: by octets over one table, by eight octets at a time over eight tables, or by
// single bits in line order. A 16-bit check in a hot path is better served by FrameCheck16
// (frame_check_16.hpp). Tables are built once, in the constructor; the object is immutable afterwards and may
// be shared between threads. Widths above 64 run octet by octet over a 128-bit table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace fieldproof::line {

__extension__ using FrameCheckValue = unsigned __int128;

struct FrameCheckParameters {
  std::string_view name;
  unsigned width;  // bits, 3 to 128
  FrameCheckValue poly;
  FrameCheckValue init;
  bool refin;
  bool refout;
  FrameCheckValue xorout;
  FrameCheckValue check;  // of the nine octets "123456789"
  FrameCheckValue residue;
  bool is_in_both_catalogues;  // false: only one of the two catalogues that were compared lists it
  std::string_view aliases;    // other names, separated by ", "; may be empty
};

// All parameter sets, ordered by width. The views live as long as the program.
std::span<const FrameCheckParameters> frame_check_catalogue();

// The set with that name or alias, nullptr when there is none. Letters match in either case.
const FrameCheckParameters* find_frame_check(std::string_view name);
// The same where the name is known to be one; else a broken invariant.
const FrameCheckParameters& frame_check_named(std::string_view name);

// Every name and alias in the order of the catalogue, e.g. to tell which ones are near an unknown one.
std::vector<std::string_view> frame_check_names();

class FrameCheck {
 public:
  // The register, octets in line order: the lowest octet is the next to leave. Opaque to callers.
  struct State {
    FrameCheckValue bits;
    friend bool operator==(const State&, const State&) = default;
  };

  // Impossible parameters (width outside 3 to 128, a value wider than the width, an even polynomial) are a
  // broken invariant.
  explicit FrameCheck(const FrameCheckParameters& parameters);

  const FrameCheckParameters& parameters() const { return parameters_; }

  State start() const { return start_; }
  State update(State state, std::span<const std::uint8_t> octets) const;
  State update_octet(State state, std::uint8_t octet) const {
    if (is_wide()) return update_wide(state, octet);
    const auto bits = static_cast<std::uint64_t>(state.bits);
    return {(bits >> 8) ^ tables_[(bits ^ octet) & 0xFF]};
  }
  // One bit in the order of the line: the most significant of an octet first, or the least with refin.
  State update_bit(State state, bool bit) const;
  // The check value as the catalogues print it.
  FrameCheckValue finish(State state) const;

  FrameCheckValue compute(std::span<const std::uint8_t> octets) const {
    return finish(update(start_, octets));
  }

  // The k-th of the `width` check bits in line order, highest power first; k < width.
  bool check_bit(State state, unsigned k) const;
  // Appends the check octets in line order; the width must be a multiple of eight.
  void append_check(std::vector<std::uint8_t>& message) const;

  // True when what was read is a message followed by its check: the register holds the residue.
  bool is_residue(State state) const { return state == residue_; }
  bool is_code_word(std::span<const std::uint8_t> octets) const { return is_residue(update(start_, octets)); }

 private:
  bool is_wide() const { return parameters_.width > 64; }
  State update_wide(State state, std::uint8_t octet) const {
    return {(state.bits >> 8) ^ wide_table_[static_cast<std::size_t>((state.bits ^ octet) & 0xFF)]};
  }
  // Between the line-order register and the register in the orientation of the check value.
  State to_line_order(FrameCheckValue value, bool reflected) const;
  FrameCheckValue to_value(State state) const;
  void build_tables();

  FrameCheckParameters parameters_;
  std::vector<std::uint64_t> tables_;        // widths to 64: eight tables of 256, table k is k octets ahead
  std::vector<FrameCheckValue> wide_table_;  // widths above 64: one table of 256
  State start_{};
  State residue_{};
};

// The lowest `width` bits of `value` in reverse order.
constexpr FrameCheckValue reflect(FrameCheckValue value, unsigned width) {
  FrameCheckValue reflected = 0;
  for (unsigned bit = 0; bit < width; ++bit) {
    reflected = (reflected << 1) | (value & 1);
    value >>= 1;
  }
  return reflected;
}

}  // namespace fieldproof::line
