#include "harness/line/frame_check.hpp"

#include <bit>
#include <cctype>
#include <cstring>
#include <string>

#include "harness/kernel/check.hpp"

// How the register is kept. A check over octets that go least significant bit first has its register
// reflected, so that the next bit to leave is bit 0. For the other direction the register is aligned to the
// top of its word (widths below eight need that too) and then its octets are swapped: the next octet to leave
// is again the lowest one. Both directions and all widths thus run through the same loop,
// (r >> 8) ^ table[(r ^ octet) & 0xFF], and differ only in the contents of the tables.

namespace fieldproof::line {
namespace {

constexpr unsigned kOctets = 256;
constexpr unsigned kSlices = 8;

constexpr std::uint64_t swap_octets(std::uint64_t word) {
  std::uint64_t swapped = 0;
  for (int octet = 0; octet < 8; ++octet) {
    swapped = (swapped << 8) | (word & 0xFF);
    word >>= 8;
  }
  return swapped;
}

constexpr FrameCheckValue swap_octets(FrameCheckValue word) {
  return (FrameCheckValue{swap_octets(static_cast<std::uint64_t>(word))} << 64) |
         swap_octets(static_cast<std::uint64_t>(word >> 64));
}

std::uint64_t little_endian(const std::uint8_t* octets) {
  std::uint64_t word = 0;
  std::memcpy(&word, octets, sizeof word);
  if constexpr (std::endian::native == std::endian::big) word = swap_octets(word);
  return word;
}

FrameCheckValue mask_of(unsigned width) {
  return ~FrameCheckValue{0} >> (128 - width);
}

bool are_possible(const FrameCheckParameters& p) {
  if (p.width < 3 || p.width > 128 || (p.poly & 1) == 0) return false;
  return ((p.poly | p.init | p.xorout | p.check | p.residue) & ~mask_of(p.width)) == 0;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// Calls visit(name) for the name and each alias.
template <typename Visit>
void for_each_name(const FrameCheckParameters& parameters, Visit&& visit) {
  visit(parameters.name);
  std::string_view rest = parameters.aliases;
  while (!rest.empty()) {
    const std::size_t comma = rest.find(", ");
    visit(rest.substr(0, comma));
    rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 2);
  }
}

}  // namespace

const FrameCheckParameters* find_frame_check(std::string_view name) {
  const std::string wanted = lower_case(name);
  for (const FrameCheckParameters& parameters : frame_check_catalogue()) {
    bool found = false;
    for_each_name(parameters, [&](std::string_view known) { found = found || lower_case(known) == wanted; });
    if (found) return &parameters;
  }
  return nullptr;
}

const FrameCheckParameters& frame_check_named(std::string_view name) {
  const FrameCheckParameters* const found = find_frame_check(name);
  FIELDPROOF_CHECK(found != nullptr, "the catalogue has a frame check of that name");
  return *found;
}

std::vector<std::string_view> frame_check_names() {
  std::vector<std::string_view> names;
  for (const FrameCheckParameters& parameters : frame_check_catalogue()) {
    for_each_name(parameters, [&](std::string_view name) { names.push_back(name); });
  }
  return names;
}

FrameCheck::FrameCheck(const FrameCheckParameters& parameters) : parameters_(parameters) {
  FIELDPROOF_CHECK(are_possible(parameters), "frame check " + std::string(parameters.name) +
                                                 " has a width, polynomial or value that cannot be");
  start_ = to_line_order(parameters.init, false);
  residue_ = to_line_order(parameters.residue, parameters.refout);
  build_tables();
}

void FrameCheck::build_tables() {
  if (is_wide()) wide_table_.resize(kOctets);
  tables_.resize(is_wide() ? 0 : kSlices * kOctets);
  for (unsigned octet = 0; octet < kOctets; ++octet) {
    State state{};
    for (unsigned bit = 0; bit < 8; ++bit) {
      state = update_bit(state, ((octet >> (parameters_.refin ? bit : 7 - bit)) & 1) != 0);
    }
    if (is_wide()) {
      wide_table_[octet] = state.bits;
    } else {
      tables_[octet] = static_cast<std::uint64_t>(state.bits);
    }
  }
  for (std::size_t entry = kOctets; entry < tables_.size(); ++entry) {
    const std::uint64_t before = tables_[entry - kOctets];
    tables_[entry] = (before >> 8) ^ tables_[before & 0xFF];
  }
}

FrameCheck::State FrameCheck::update(State state, std::span<const std::uint8_t> octets) const {
  const std::uint8_t* at = octets.data();
  std::size_t left = octets.size();
  if (!is_wide()) {
    const std::uint64_t* const table = tables_.data();
    auto bits = static_cast<std::uint64_t>(state.bits);
    for (; left >= kSlices; left -= kSlices, at += kSlices) {
      const std::uint64_t x = bits ^ little_endian(at);
      bits = 0;
      for (unsigned k = 0; k < kSlices; ++k) {
        bits ^= table[(kSlices - 1 - k) * kOctets + ((x >> (8 * k)) & 0xFF)];
      }
    }
    state.bits = bits;
  }
  for (; left > 0; --left) state = update_octet(state, *at++);
  return state;
}

FrameCheck::State FrameCheck::update_bit(State state, bool bit) const {
  const FrameCheckValue in = bit ? 1 : 0;
  if (parameters_.refin) {
    const bool leaves = ((state.bits ^ in) & 1) != 0;
    return {(state.bits >> 1) ^ (leaves ? reflect(parameters_.poly, parameters_.width) : 0)};
  }
  const FrameCheckValue value = to_value(state);
  const bool leaves = (((value >> (parameters_.width - 1)) ^ in) & 1) != 0;
  const FrameCheckValue shifted = (value << 1) & mask_of(parameters_.width);
  return to_line_order(shifted ^ (leaves ? parameters_.poly : 0), false);
}

// `value` has the orientation of the polynomial, or is reflected against it.
FrameCheck::State FrameCheck::to_line_order(FrameCheckValue value, bool reflected) const {
  const unsigned width = parameters_.width;
  if (parameters_.refin) return {reflected ? value : reflect(value, width)};
  if (reflected) value = reflect(value, width);
  if (is_wide()) return {swap_octets(value << (128 - width))};
  return {swap_octets(static_cast<std::uint64_t>(value) << (64 - width))};
}

// The register in the orientation of the polynomial.
FrameCheckValue FrameCheck::to_value(State state) const {
  const unsigned width = parameters_.width;
  if (parameters_.refin) return reflect(state.bits, width);
  if (is_wide()) return swap_octets(state.bits) >> (128 - width);
  return swap_octets(static_cast<std::uint64_t>(state.bits)) >> (64 - width);
}

FrameCheckValue FrameCheck::finish(State state) const {
  const FrameCheckValue value = to_value(state);
  return (parameters_.refout ? reflect(value, parameters_.width) : value) ^ parameters_.xorout;
}

bool FrameCheck::check_bit(State state, unsigned k) const {
  const FrameCheckValue value = finish(state);
  return ((value >> (parameters_.refout ? k : parameters_.width - 1 - k)) & 1) != 0;
}

void FrameCheck::append_check(std::vector<std::uint8_t>& message) const {
  const unsigned width = parameters_.width;
  FIELDPROOF_CHECK(width % 8 == 0, "only a check of whole octets can be appended to octets");
  const FrameCheckValue check = finish(update(start_, message));
  for (unsigned octet = 0; octet < width / 8; ++octet) {
    unsigned value = 0;
    for (unsigned bit = 0; bit < 8; ++bit) {
      const unsigned k = 8 * octet + bit;  // as check_bit has it
      const auto in = static_cast<unsigned>(check >> (parameters_.refout ? k : width - 1 - k) & 1);
      value |= in << (parameters_.refin ? bit : 7 - bit);
    }
    message.push_back(static_cast<std::uint8_t>(value));
  }
}

}  // namespace fieldproof::line
