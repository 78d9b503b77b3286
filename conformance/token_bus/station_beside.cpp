#include "conformance/token_bus/station_words.hpp"

// Frames that are nearly for, from or about the station: an address that differs from the right one in one
// bit of one octet, or a control code that differs in its low bits.
namespace fieldproof::conformance {
namespace {

constexpr std::uint64_t kAbove = TokenBench::kAbove;
constexpr std::uint64_t kBelow = TokenBench::kBelow;
constexpr std::uint64_t kStranger = TokenBench::kStranger;
constexpr std::uint64_t kLowest = 0x0002;

// One for each octet.
std::vector<std::uint64_t> bits_beside(const TokenBench& bench) {
  std::vector<std::uint64_t> bits;
  for (unsigned octet = 0; octet < token_bus::address_octets(bench.rules()); ++octet)
    bits.push_back(std::uint64_t{0x10} << 8 * octet);
  return bits;
}

Octets frame_beside(TokenBeside kind, std::uint64_t bit, TokenBench& bench) {
  const std::uint64_t own = bench.address();
  switch (kind) {
    case TokenBeside::token_to:
      return bench.frame(TokenControl::token, own ^ bit, kAbove);
    case TokenBeside::data_to:
      return bench.data_frame(kDataOfSix, own ^ bit, kAbove, bench.numbered_data(3));
    case TokenBeside::data_from:
      return bench.data_frame(kDataOfSix, own, own ^ bit, bench.numbered_data(3));
    case TokenBeside::request_to:
      return bench.data_frame(kRequestOfSix, own ^ bit, kAbove, bench.numbered_data(3));
    case TokenBeside::successor_to:
      return bench.frame(TokenControl::set_successor, own ^ bit, kBelow, kLowest);
    case TokenBeside::solicited_below:
      return bench.frame(TokenControl::solicit_1, kBelow ^ bit, kAbove);
    case TokenBeside::solicited_above:
      return bench.frame(TokenControl::solicit_1, kBelow, kLowest ^ bit);
    case TokenBeside::follows_another:
      return bench.frame(TokenControl::who_follows, kAbove ^ bit, kStranger, kAbove ^ bit);
    default:
      return bench.frame(TokenControl::token, own, kAbove ^ bit);
  }
}

// Each control frame that a station acts on, with low bits that no control frame has.
std::vector<Octets> with_other_controls(TokenBench& bench) {
  constexpr unsigned kLow = 0x0C;
  const std::uint64_t own = bench.address();
  std::vector<Octets> all;
  const auto add = [&](Octets octets) {
    for (unsigned low = 4; low <= kLow; low += 4) {
      octets[0] = static_cast<std::uint8_t>((octets[0] & ~kLow) | low);
      all.push_back(octets);
    }
  };
  add(bench.frame(TokenControl::token, own, kAbove));
  add(bench.frame(TokenControl::solicit_1, kBelow, kAbove));
  add(bench.frame(TokenControl::solicit_2, kBelow, kAbove));
  add(bench.frame(TokenControl::set_successor, own, kBelow, kLowest));
  add(bench.frame(TokenControl::who_follows, kAbove, kStranger, kAbove));
  return all;
}

}  // namespace

std::vector<Octets> frames_beside(TokenBeside kind, TokenBench& bench) {
  if (kind == TokenBeside::controls) return with_other_controls(bench);
  std::vector<Octets> all;
  for (const std::uint64_t bit : bits_beside(bench)) all.push_back(frame_beside(kind, bit, bench));
  const bool is_to =
      kind == TokenBeside::token_to || kind == TokenBeside::successor_to || kind == TokenBeside::request_to;
  if (is_to) all.push_back(frame_beside(kind, 1, bench));  // a group
  return all;
}

}  // namespace fieldproof::conformance
