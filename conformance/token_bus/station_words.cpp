#include "conformance/token_bus/station_words.hpp"

#include <algorithm>
#include <array>

#include "conformance/sequence_settings.hpp"
#include "conformance/token_bus/judgeable_rules.hpp"
#include "protocols/token_bus/station_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 4> kTokenWaits{1, 3, 5, 9};
constexpr std::array<std::int64_t, 4> kTokenSizes{0, 1, 20, 300};

constexpr std::int64_t kFrameFlaws = 6;
constexpr std::int64_t kAddressForms = 12;

// Control as it is stored: those of the list of frames, of data each action and a priority, and what is on no
// list.
constexpr std::array<std::int64_t, 17> kControls{0x10, 0x00, 0x80, 0x40, 0xC0, 0x20, 0x30, 0x62, 0x02,
                                                 0x12, 0x72, 0x0A, 0x6A, 0x63, 0x50, 0x11, 0xE2};
constexpr std::array<std::int64_t, 8> kDataSizes{0, 1, 2, 3, 4, 6, 12, 40};
constexpr std::array<std::int64_t, 4> kSuppliesOff{1, 10, 100, 1000};

// Other stations of the tester lie above and below it.
constexpr std::array<std::string_view, 1> kFixedOfStation{"address"};

// Own, of its neighbours and of strangers, of groups, and all that differ from its own in little.
std::uint64_t address_form(std::int64_t form, const TokenBench& bench) {
  const std::uint64_t own = bench.address();
  const unsigned bits = 8 * token_bus::address_octets(bench.rules());
  const std::array<std::uint64_t, kAddressForms> forms{own,
                                                       TokenBench::kAbove,
                                                       TokenBench::kBelow,
                                                       TokenBench::kStranger,
                                                       own | 1U,
                                                       (std::uint64_t{1} << bits) - 1,
                                                       0,
                                                       0x0002,
                                                       own ^ 2U,
                                                       own ^ 0x0100U,
                                                       own ^ std::uint64_t{1} << (bits - 2),
                                                       own ^ std::uint64_t{1} << (bits - 1)};
  return forms.at(static_cast<std::size_t>(form));
}

// Data: an address where there is room for one, else its first octets, or numbered ones after it.
Octets any_frame(const std::vector<std::int64_t>& numbers, TokenBench& bench) {
  const Octets address =
      token_bus::octets_of(token_bus::Address{address_form(numbers[4], bench)}, bench.rules());
  Octets data = bench.numbered_data(static_cast<std::size_t>(numbers[3]));
  std::copy_n(address.begin(), std::min(address.size(), data.size()), data.begin());
  return bench.data_frame(static_cast<std::uint8_t>(numbers[0]), address_form(numbers[1], bench),
                          address_form(numbers[2], bench), data);
}

Octets solicitation(std::int64_t whom, const TokenBench& bench) {
  const std::uint64_t own = bench.address();
  switch (whom) {
    case 0:
      return bench.frame(TokenControl::solicit_1, TokenBench::kBelow, TokenBench::kAbove);
    case 1:
      return bench.frame(TokenControl::solicit_1, own, TokenBench::kAbove);
    case 2:
      return bench.frame(TokenControl::solicit_2, 0x0008, TokenBench::kBelow);
    default:
      return bench.frame(TokenControl::solicit_2, TokenBench::kAbove, TokenBench::kAbove);
  }
}

}  // namespace

SequenceVocabulary token_station_vocabulary() {
  const token_bus::StationConfiguration as_made;
  // In the order of TokenWord.
  return {
      .words =
          {{.word = "token", .meaning = "000E passes the token to the station", .units = 11, .weight = 7},
           {.word = "token_elsewhere", .meaning = "000E passes the token to 0004", .units = 11, .weight = 2},
           {.word = "data",
            .meaning = "data for the station, for all or for another",
            .numbers = {{"to", 0, 2, 0}, {"size", 2, 300, 2}},
            .units = 13,
            .weight = 3},
           {.word = "request",
            .meaning = "a request with response for the station",
            .numbers = {{"priority", 0, 7, 6}},
            .units = 13,
            .weight = 3},
           {.word = "solicit",
            .meaning = "successors are solicited: between 000E and 0004, between 000E and the "
                       "station, by the lowest, by who is alone",
            .numbers = {{"whom", 0, 3, 0}},
            .units = 11,
            .weight = 6},
           {.word = "resolve", .meaning = "000E resolves contention", .units = 11, .weight = 3},
           {.word = "who_follows",
            .meaning = "0020 asks who follows 000E, the station, or 0004",
            .numbers = {{"whom", 0, 2, 0}},
            .units = 13,
            .weight = 2},
           {.word = "set_successor",
            .meaning = "0004 leaves: the successor of the station is 0002, or the station itself",
            .numbers = {{"alone", 0, 1, 0}},
            .units = 13,
            .weight = 1},
           {.word = "claim", .meaning = "0020 claims the token", .units = 11, .weight = 1},
           {.word = "noise",
            .meaning = "signal without a start delimiter, of so many octet durations",
            .numbers = {{"octets", 4, 60, 8}},
            .weight = 2},
           {.word = "wait",
            .meaning = "silence of so many slot times",
            .numbers = {{"slots", 1, 9, 1, kTokenWaits}},
            .weight = 2},
           {.word = "submit",
            .meaning = "the user submits data for 0004",
            .numbers = {{"priority", 0, 7, 6}, {"size", 0, 300, 1, kTokenSizes}},
            .weight = 5},
           {.word = "submit_request",
            .meaning = "the user submits a request with response for 0004",
            .numbers = {{"priority", 0, 7, 6}},
            .weight = 3},
           {.word = "in_ring",
            .meaning = "the user wants the station in the ring, or not",
            .numbers = {{"desired", 0, 1, 1}},
            .weight = 1},
           {.word = "respond",
            .meaning = "the user has a response ready",
            .numbers = {{"size", 0, 40, 2}},
            .weight = 2},
           {.word = "peer",
            .meaning = "who gets the token or a request does what is due, or is silent",
            .numbers = {{"does", 0, 1, 1}},
            .weight = 2},
           {.word = "frame",
            .meaning = "a frame of any control, to and from any address, of any length, as it should be or "
                       "with a flaw",
            .numbers = {{"control", 0, 255, 0x10, kControls},
                        {"to", 0, kAddressForms - 1, 0},
                        {"from", 0, kAddressForms - 1, 1},
                        {"size", 0, 300, 0, kDataSizes},
                        {"data", 0, kAddressForms - 1, 0},
                        {"flaw", 0, kFrameFlaws - 1, 0}},
            .units = 11,
            .weight = 6},
           {.word = "power",
            .meaning = "the supply of the station fails for so many octet durations",
            .numbers = {{"octets", 1, 1000, 10, kSuppliesOff}},
            .weight = 1}},
      .unit = "octet",
      .levels_per_unit = kHalfBitsOfOctet,
      .settings = sequence_settings(token_bus::kStationTable, &as_made, kFixedOfStation),
      .objection = objection_of(
          token_bus::kStationTable, as_made,
          +[](const token_bus::StationConfiguration& one) { expect_possible(one.rules); })};
}

Octets octets_of(TokenWord word, const std::vector<std::int64_t>& numbers, TokenBench& bench) {
  const std::uint64_t own = bench.address();
  constexpr std::uint64_t kAbove = TokenBench::kAbove;
  constexpr std::uint64_t kBelow = TokenBench::kBelow;
  constexpr std::uint64_t kStranger = TokenBench::kStranger;
  switch (word) {
    case TokenWord::token:
      return bench.frame(TokenControl::token, own, kAbove);
    case TokenWord::token_elsewhere:
      return bench.frame(TokenControl::token, kBelow, kAbove);
    case TokenWord::data: {
      const std::array<std::uint64_t, 3> to{own, 0xFFFF, kBelow};
      return bench.data_frame(0x62, to.at(static_cast<std::size_t>(numbers[0])), kAbove,
                              bench.numbered_data(static_cast<std::size_t>(numbers[1])));
    }
    case TokenWord::request: {
      // 01 001 PPP, its highest bit first.
      const auto priority = static_cast<unsigned>(numbers[0]);
      const unsigned reversed = (priority & 1) << 2 | (priority & 2) | priority >> 2;
      return bench.data_frame(static_cast<std::uint8_t>(0x12U | reversed << 5), own, kAbove,
                              bench.numbered_data(2));
    }
    case TokenWord::solicit:
      return solicitation(numbers[0], bench);
    case TokenWord::resolve:
      return bench.frame(TokenControl::resolve, kAbove, kAbove);
    case TokenWord::who_follows: {
      const std::array<std::uint64_t, 3> whom{kAbove, own, kBelow};
      const std::uint64_t lost = whom.at(static_cast<std::size_t>(numbers[0]));
      return bench.frame(TokenControl::who_follows, lost, kStranger, lost);
    }
    case TokenWord::set_successor:
      return bench.frame(TokenControl::set_successor, own, kBelow, numbers[0] == 0 ? 0x0002 : own);
    case TokenWord::frame:
      return any_frame(numbers, bench);
    default:
      return bench.frame(TokenControl::claim, 0, kStranger);
  }
}

FrameFlaw flaw_of(TokenWord word, const std::vector<std::int64_t>& numbers) {
  return word == TokenWord::frame ? static_cast<FrameFlaw>(numbers[5]) : FrameFlaw::none;
}

line::Levels half_bits_of(Octets octets, FrameFlaw flaw) {
  if (flaw == FrameFlaw::octet_less) octets.pop_back();
  octets = with_crc_32(octets);
  if (flaw == FrameFlaw::wrong_check) octets.back() ^= 0x01U;
  if (flaw == FrameFlaw::check_of_other_order)
    std::reverse(octets.end() - token_bus::kCheckOctets, octets.end());
  return half_bits_around(octets, {.preamble_octets = flaw == FrameFlaw::short_preamble ? 3U : 4U,
                                   .has_error = flaw == FrameFlaw::error_bit});
}

}  // namespace fieldproof::conformance
