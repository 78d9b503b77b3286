#include "conformance/token_bus/station_tester.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kHalfBitsOfOctet = 32;
constexpr std::size_t kHalfBitsOfSymbol = 4;
constexpr std::uint64_t kZeroSymbol = 0b1001;
constexpr std::size_t kHalfBitsOfDelimiter = 8 * kHalfBitsOfSymbol;
constexpr std::size_t kCheck = 4;
constexpr std::int64_t kReactionOctets = 8;
constexpr std::uint64_t kJoins = 0x0006;

std::optional<TokenCue> cue_of(const DrivenFrame& one) {
  constexpr unsigned kActionBits = 0x1F;
  constexpr unsigned kRequestAction = 0x12;  // 01 001
  if (one.is(TokenControl::token)) return TokenCue::token;
  if (one.is(TokenControl::solicit_1) || one.is(TokenControl::solicit_2)) return TokenCue::solicitation;
  if (one.is(TokenControl::who_follows)) return TokenCue::who_follows;
  if (one.is(TokenControl::resolve)) return TokenCue::contest;
  if (one.is(TokenControl::claim)) return TokenCue::claim;
  if (one.is(TokenControl::set_successor)) return TokenCue::successor;
  if (!one.is_data()) return std::nullopt;
  return (one.control() & kActionBits) == kRequestAction ? TokenCue::request : TokenCue::data;
}

Octets with_wrong_check(std::span<const std::uint8_t> octets) {
  Octets all = with_crc_32(octets);
  all.back() ^= 0x10;
  return all;
}

bool is_long(TokenEnding ending) {
  return ending == TokenEnding::longest || ending == TokenEnding::too_long ||
         ending == TokenEnding::too_long_and_wrong || ending == TokenEnding::long_and_wrong;
}

// Control frames have a data unit of their kind alone.
void make_long(Octets& octets, TokenEnding ending, const token_bus::Rules& rules) {
  constexpr std::size_t kLong = 2'100;
  const bool is_data = (octets[0] & 0x03U) == 0x02 || (octets[0] & 0x03U) == 0x01;
  if (!is_data) return;
  std::size_t size = rules.most_octets - kCheck;
  if (ending == TokenEnding::long_and_wrong) size = std::min(size, kLong);
  if (ending == TokenEnding::too_long || ending == TokenEnding::too_long_and_wrong) ++size;
  octets.resize(std::max(octets.size(), size), 0x5A);
}

// With its check, or what stands there.
Octets ended(const Octets& octets, TokenEnding ending) {
  switch (ending) {
    case TokenEnding::both_errors:
    case TokenEnding::wrong_check:
    case TokenEnding::too_long_and_wrong:
    case TokenEnding::long_and_wrong:
      return with_wrong_check(octets);
    case TokenEnding::check_reversed: {
      Octets checked = with_crc_32(octets);
      std::reverse(checked.end() - static_cast<std::ptrdiff_t>(kCheck), checked.end());
      return checked;
    }
    case TokenEnding::abort:
      return {};
    default:
      return with_crc_32(octets);
  }
}

// Three bits in front of the end delimiter.
line::Levels with_bits_too_many(const line::Levels& levels) {
  const std::size_t content = levels.size() - kHalfBitsOfDelimiter;
  line::Levels more = levels.slice(0, content);
  for (unsigned n = 0; n < 3; ++n) more.append(kZeroSymbol, kHalfBitsOfSymbol);
  more.append(levels, content, kHalfBitsOfDelimiter);
  return more;
}

}  // namespace

void TokenTester::take_form(std::span<const std::int64_t> numbers) {
  form_ = {static_cast<unsigned>(numbers[0]), static_cast<unsigned>(numbers[1]),
           static_cast<TokenEnding>(numbers[2])};
}

line::Levels TokenTester::data_around(bool is_damaged, FrameForm form) {
  const Octets data =
      bench_.data_frame(kDataOfSix, bench_.address(), TokenBench::kAbove, bench_.numbered_data(3));
  return half_bits_around(is_damaged ? with_wrong_check(data) : with_crc_32(data), form);
}

// What comes in front of it in the same transmission.
line::Levels TokenTester::before(TokenEnding ending) {
  line::Levels levels;
  const bool is_damaged = ending == TokenEnding::damaged_before;
  const bool are_two = ending == TokenEnding::two_before;
  if (is_damaged || are_two || ending == TokenEnding::data_before)
    levels = data_around(is_damaged, {.more_follows = true});
  if (are_two) levels.append(data_around(false, {.more_follows = true}));
  return levels;
}

line::Levels TokenTester::shaped(Octets octets, const Form& form) {
  if (is_long(form.ending)) make_long(octets, form.ending, bench_.rules());
  line::Levels levels = before(form.ending);
  levels.append(half_bits_around(
      ended(octets, form.ending),
      {.preamble_octets = form.preamble,
       .more_follows = form.ending == TokenEnding::data_after || form.ending == TokenEnding::nothing_after,
       .has_error = form.ending == TokenEnding::error_bit || form.ending == TokenEnding::both_errors}));
  if (form.ending == TokenEnding::no_end) return levels.slice(0, levels.size() - kHalfBitsOfDelimiter);
  if (form.ending == TokenEnding::bits_too_many) return with_bits_too_many(levels);
  if (form.ending == TokenEnding::data_after) levels.append(data_around(false, {}));
  return levels;
}

void TokenTester::send(Octets octets, const std::vector<SequenceFault>& faults) {
  const Form form = std::exchange(form_, {});
  line::Levels levels = shaped(std::move(octets), form);
  for (const SequenceFault& fault : faults) {
    // Where frames follow each other it is not said what is left of the next one.
    if (form.ending != TokenEnding::right) break;
    const std::size_t first = (form.preamble + fault.unit) * kHalfBitsOfOctet;
    if (first + kHalfBitsOfOctet > levels.size()) continue;
    if (fault.kind == SequenceFaultKind::drop) levels.fill(first, first + kHalfBitsOfOctet, true);
    if (fault.kind == SequenceFaultKind::flip && fault.value < kHalfBitsOfOctet)
      levels.flip(first + fault.value);
  }
  const std::size_t lost = 2 * std::size_t{form.bits_lost};
  if (lost > 0) levels = levels.slice(lost, levels.size() - lost);
  bench_.send_half_bits(std::move(levels));
}

void TokenTester::send_noise(std::size_t symbols) {
  line::Levels levels;
  for (std::size_t n = 0; n < symbols; ++n) levels.append(kZeroSymbol, kHalfBitsOfSymbol);
  bench_.send_half_bits(std::move(levels));
}

void TokenTester::send_faulty(TokenSeries what) {
  constexpr std::size_t kNoiseSymbols = 64;
  const auto ending = [&] {
    switch (what) {
      case TokenSeries::fragments:
        return TokenEnding::no_end;
      case TokenSeries::wrong_checks:
        return TokenEnding::wrong_check;
      case TokenSeries::error_bits:
        return TokenEnding::error_bit;
      default:
        return TokenEnding::too_long;
    }
  };
  if (what == TokenSeries::noise) {
    send_noise(kNoiseSymbols);
  } else {
    const Octets data = bench_.data_frame(kDataOfSix, bench_.address(), TokenBench::kAbove, {1, 2});
    bench_.send_half_bits(shaped(data, {.ending = ending()}));
  }
  bench_.wait(bench_.octets(kReactionOctets));
}

// In frames as long as they may be, but not longer than a receiver may wait for their end.
void TokenTester::talk(std::int64_t octets) {
  constexpr std::int64_t kMost = 4'000;
  constexpr std::int64_t kAround = 40;
  const std::int64_t longest = std::min<std::int64_t>(kMost, bench_.rules().most_octets) - kAround;
  for (std::int64_t left = octets; left > 0; left -= longest) {
    const auto size = static_cast<std::size_t>(std::min(left, longest));
    bench_.send(bench_.data_frame(kDataOfSix, TokenBench::kBelow, TokenBench::kStranger, Octets(size, 0x33)));
    bench_.wait(bench_.octets(kReactionOctets));
  }
}

// ---- replies ----

void TokenTester::take_reply(std::span<const std::int64_t> numbers) {
  replies_.at(static_cast<std::size_t>(numbers[0])) = {static_cast<TokenReply>(numbers[1]), numbers[2],
                                                       numbers[3]};
}

bool TokenTester::reply_to(const DrivenFrame& one) {
  const auto cue = cue_of(one);
  if (!cue) return false;
  Reply& given = replies_.at(static_cast<std::size_t>(*cue));
  if (given.left == 0) {
    const bool is_due = *cue == TokenCue::token || *cue == TokenCue::request;
    if (!is_due || !does_peer_act_) return false;
    do_what_is_due(one, kReactionOctets);
    return true;
  }
  --given.left;
  if (given.with == TokenReply::nothing) return false;
  if (given.with == TokenReply::what_is_due) {
    do_what_is_due(one, given.after);
  } else {
    bench_.wait(bench_.octets(given.after));
    reply(one, given.with);
  }
  return true;
}

void TokenTester::do_what_is_due(const DrivenFrame& one, std::int64_t after) {
  bench_.wait(bench_.octets(after));
  const std::uint64_t own = bench_.address();
  switch (*cue_of(one)) {
    case TokenCue::token:
      bench_.send(bench_.frame(TokenControl::token, TokenBench::kAbove, one.destination()));
      break;
    case TokenCue::request:
      bench_.send(bench_.data_frame(kResponseOfSix, own, one.destination(), bench_.numbered_data(2)));
      break;
    case TokenCue::successor:
      // Who has solicited passes it the token.
      bench_.send(bench_.frame(TokenControl::token, own, one.destination()));
      break;
    default:
      bench_.send(bench_.frame(TokenControl::set_successor, own, kJoins, kJoins));
      break;
  }
}

void TokenTester::reply(const DrivenFrame& one, TokenReply with) {
  constexpr std::uint64_t kStranger = TokenBench::kStranger;
  constexpr std::uint64_t kAbove = TokenBench::kAbove;
  constexpr std::uint64_t kBelow = TokenBench::kBelow;
  constexpr std::uint64_t kGroup = 0x0011;
  constexpr std::size_t kNoise = 64;
  constexpr std::size_t kLongNoise = 400;
  const std::uint64_t own = bench_.address();
  const auto data = [&](std::uint8_t control, std::uint64_t to, std::uint64_t from) {
    bench_.send(bench_.data_frame(control, to, from, bench_.numbered_data(2)));
  };
  const auto control = [&](TokenControl what, std::uint64_t to, std::uint64_t from,
                           std::optional<std::uint64_t> about = std::nullopt) {
    bench_.send(bench_.frame(what, to, from, about));
  };
  switch (with) {
    case TokenReply::noise:
      return send_noise(kNoise);
    case TokenReply::long_noise:
      return send_noise(kLongNoise);
    case TokenReply::group_is_successor:
      return control(TokenControl::set_successor, own, kJoins, kGroup);
    case TokenReply::successor_of_another:
      return control(TokenControl::set_successor, kAbove, kJoins, kJoins);
    case TokenReply::station_is_successor:
      return control(TokenControl::set_successor, own, kBelow, own);
    case TokenReply::data:
      return data(kDataOfSix, own, kStranger);
    case TokenReply::data_for_all:
      return data(kDataOfSix, 0xFFFF, kStranger);
    case TokenReply::token:
      return control(TokenControl::token, own, kStranger);
    case TokenReply::wrong_check:
      bench_.send_half_bits(
          half_bits_around(with_wrong_check(bench_.frame(TokenControl::set_successor, own, kJoins, kJoins))));
      return;
    case TokenReply::own_source:
      return data(kDataOfSix, kBelow, own);
    case TokenReply::response_of_another:
      return data(kResponseOfSix, own, kStranger);
    case TokenReply::response_to_another:
      return data(kResponseOfSix, kAbove, one.destination());
    case TokenReply::solicitation:
      return control(TokenControl::solicit_1, kBelow, kAbove);
    case TokenReply::contest:
      return control(TokenControl::resolve, kAbove, kAbove);
    case TokenReply::claim:
      return control(TokenControl::claim, 0, kStranger);
    case TokenReply::request:
      return data(kRequestOfSix, own, kStranger);
    case TokenReply::who_follows:
      return control(TokenControl::who_follows, kAbove, kStranger, kAbove);
    case TokenReply::contest_then_noise:
      control(TokenControl::resolve, kAbove, kAbove);
      bench_.wait(bench_.slots(1) + bench_.octets(kReactionOctets));
      return send_noise(kNoise);
    case TokenReply::noise_then_token:
      send_noise(kNoise);
      bench_.wait(bench_.slots(1));
      return control(TokenControl::token, kAbove, one.destination());
    default:
      return;
  }
}

}  // namespace fieldproof::conformance
