#include "conformance/token_bus/station_words.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "conformance/sequence_settings.hpp"
#include "conformance/token_bus/judgeable_rules.hpp"
#include "harness/line/frame_check.hpp"
#include "protocols/token_bus/station_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 4> kTokenWaits{1, 3, 5, 9};
constexpr std::array<std::int64_t, 4> kTokenSizes{0, 1, 20, 300};
constexpr std::array<std::int64_t, 4> kTimesOff{0, 2, 9, 40};
constexpr std::array<std::int64_t, 6> kPreambles{4, 5, 16, 17, 31, 32};
constexpr std::array<std::int64_t, 4> kBitsLost{0, 1, 14, 15};
constexpr std::array<std::int64_t, 7> kAfterOctets{8, 3, 4, 20, 30, 60, 100};
constexpr std::array<std::int64_t, 5> kReplyTimes{1, 2, 3, 10, 20};
constexpr std::array<std::int64_t, 8> kSymbolsBetween{64, 26, 27, 30, 34, 160, 300, 700};
constexpr std::array<std::int64_t, 6> kSpikes{2, 8, 16, 24, 30, 40};
constexpr std::array<std::int64_t, 9> kTimes{2, 3, 6, 10, 17, 20, 90, 260, 310};
constexpr std::array<std::int64_t, 5> kTalk{100, 2'100, 21'000, 45'000, 70'000};
constexpr std::array<std::int64_t, 9> kSizesAsked{1, 0, 20, 300, 1'000, 8'174, 8'175, 8'182, 8'183};
constexpr std::array<std::int64_t, 5> kSilences{12, 20, 40, 70, 200};

// Their addresses are those of the tester's frames.
constexpr std::array<std::string_view, 1> kFixedOfStation{"address"};

constexpr unsigned kLevelsOfOctet = 32;
constexpr std::int64_t kMostAddresses = 11;
constexpr std::int64_t kMostControl = 16;
constexpr std::int64_t kMostAbout = 7;

// In the order of TokenWord.
std::vector<SequenceWord> first_words() {
  return {{.word = "token", .meaning = "000E passes the token to the station", .units = 11, .weight = 7},
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
           .weight = 2}};
}

SequenceNumber address_number(std::string_view name, std::int64_t simple) {
  return {name, 0, kMostAddresses, simple};
}

std::vector<SequenceWord> later_words() {
  return {{.word = "power",
           .meaning = "the supply is off for so many slot times and comes again",
           .numbers = {{"slots", 0, 40, 2, kTimesOff}},
           .weight = 3,
           .is_loss = true},
          {.word = "frame",
           .meaning = "any frame from anybody to anybody, about somebody",
           .numbers = {{"control", 0, kMostControl, 7},
                       address_number("to", 0),
                       address_number("from", 4),
                       {"about", 0, kMostAbout, 0}},
           .units = 13,
           .weight = 16},
          {.word = "form",
           .meaning = "the next frame has such a preamble, of which so many bits are lost, and such an end",
           .numbers = {{"preamble", 4, 32, 4, kPreambles, true},
                       {"lost", 0, 15, 0, kBitsLost, true},
                       {"ending", 0, static_cast<std::int64_t>(TokenEnding::long_and_wrong), 0}},
           .weight = 5,
           .is_no_frame = true},
          {.word = "reply",
           .meaning = "what comes after a frame of the station, so many octet durations after it, so often",
           .numbers = {{"to", 0, kTokenCues - 1, 0},
                       {"with", 0, kMostTokenReply, 0},
                       {"after", 3, 300, 8, kAfterOctets},
                       {"times", 1, 20, 1, kReplyTimes, true}},
           .weight = 8,
           .is_no_frame = true},
          {.word = "soon",
           .meaning = "what comes after the next command comes so many MAC symbols after it",
           .numbers = {{"symbols", 26, 2'000, 64, kSymbolsBetween}},
           .weight = 4,
           .is_no_frame = true},
          {.word = "spike",
           .meaning = "signal without a start delimiter, of so many MAC symbols",
           .numbers = {{"symbols", 1, 40, 16, kSpikes}},
           .weight = 1,
           .is_no_frame = true},
          {.word = "many",
           .meaning = "rounds of the token, without data or with, noise, or faulty frames, so often",
           .numbers = {{"what", 0, static_cast<std::int64_t>(TokenSeries::too_long), 0},
                       {"times", 2, 1'010, 2, kTimes, true}},
           .weight = 5,
           .is_no_frame = true},
          {.word = "others",
           .meaning = "others talk for so many octet durations",
           .numbers = {{"octets", 100, 1'200'000, 100, kTalk, true}},
           .weight = 2,
           .is_no_frame = true},
          {.word = "ask",
           .meaning = "the user submits anything to anybody",
           .numbers = {{"action", 0, 1, 0},
                       {"priority", 0, 9, 6},
                       address_number("to", 3),
                       {"size", 0, 8'183, 1, kSizesAsked, true}},
           .weight = 6},
          {.word = "silence",
           .meaning = "silence of so many slot times",
           .numbers = {{"slots", 10, 200, 12, kSilences}},
           .weight = 3,
           .is_no_frame = true}};
}

// What brings a station into the ring of the tester, and what it then has to do.
std::vector<std::vector<NamedCommand>> states_of_a_station() {
  const NamedCommand offered{"solicit"};
  const NamedCommand passed{"token"};
  const NamedCommand urgent{"submit", {{"size", 20}}};
  const NamedCommand bulk{"submit", {{"priority", 0}, {"size", 300}}};
  const NamedCommand long_one{"ask", {{"size", 1'000}}};
  // Who has solicited passes it the token when it has answered, or resolves contention before.
  const NamedCommand taken_in{"reply", {{"to", 6}, {"with", 1}}};
  const NamedCommand contended{"reply", {{"to", 6}, {"with", 13}, {"times", 3}}};
  const NamedCommand silent{"peer", {{"does", 0}}};
  const NamedCommand noise_follows{"reply", {{"with", 2}, {"times", 2}}};
  const NamedCommand asks{"submit_request"};
  return {{offered, passed},                                           // a member whose offer is forgotten
          {urgent, bulk, offered, passed},                             // that has had data of several classes
          {{"respond", {{"size", 10}}}, offered, passed},              // with a response
          {offered, passed, silent, urgent},                           // among others that are silent
          {taken_in, offered},                                         // between two others
          {taken_in, offered, {"in_ring", {{"desired", 0}}}, passed},  // that has left
          {taken_in, offered, silent, noise_follows, passed},
          {taken_in, offered, {"many", {{"times", 17}}}},  // that opens its window soon
          {taken_in, offered, long_one, long_one, long_one, long_one, bulk, urgent, passed},
          {taken_in, offered, asks, {"reply", {{"to", 1}, {"with", 10}}}, passed},
          {contended, offered},
          {{"silence"}}};  // alone
}

// Stored inputs name settings by their place: those of later come last.
std::vector<SequenceSetting> settings_of_a_station(const token_bus::StationConfiguration& as_made) {
  constexpr std::array<std::string_view, 3> kLater{"demand_wait_slots", "bus_idle_slots",
                                                   "lowest_bus_idle_slots"};
  auto all = sequence_settings(token_bus::kStationTable, &as_made, kFixedOfStation);
  std::ranges::stable_partition(
      all, [&](const SequenceSetting& one) { return std::ranges::find(kLater, one.name) == kLater.end(); });
  for (SequenceSetting& one :
       settings_of_elements(token_bus::kStationTable, &as_made, "target_rotation_octets"))
    all.push_back(std::move(one));
  return all;
}

}  // namespace

SequenceVocabulary token_station_vocabulary() {
  const token_bus::StationConfiguration as_made;
  SequenceVocabulary vocabulary{
      .words = first_words(),
      .unit = "octet",
      .levels_per_unit = kLevelsOfOctet,
      .settings = settings_of_a_station(as_made),
      .objection = objection_of(
          token_bus::kStationTable, as_made,
          +[](const token_bus::StationConfiguration& one) { expect_possible(one.rules); })};
  for (auto* make : {later_words, words_of_many})
    for (SequenceWord& word : make()) vocabulary.words.push_back(std::move(word));
  return with_situations(with_beginnings(std::move(vocabulary), states_of_a_station()),
                         situations_of_a_station());
}

std::uint64_t address_meant(std::int64_t number, const TokenBench& bench) {
  const std::uint64_t own = bench.address();
  const std::array<std::uint64_t, kMostAddresses + 1> all{own,
                                                          token_bus::broadcast(bench.rules()),
                                                          0x0011,
                                                          TokenBench::kBelow,
                                                          TokenBench::kAbove,
                                                          TokenBench::kStranger,
                                                          own | 0x0100,
                                                          own | std::uint64_t{1} << 16,
                                                          own | std::uint64_t{1} << 32,
                                                          TokenBench::kBelow | std::uint64_t{1} << 40,
                                                          0x0006,
                                                          0xFFFF};
  return all.at(static_cast<std::size_t>(number)) & token_bus::broadcast(bench.rules());
}

namespace {

constexpr std::uint64_t kNextOfMany = 0x0008;

// 01 MMM PPP, the highest bits of the action and of the priority first.
std::uint8_t data_control(unsigned action, unsigned priority) {
  return static_cast<std::uint8_t>(0x02U | line::reflect(action, 3) << 2 | line::reflect(priority, 3) << 5);
}

Octets solicitation(std::int64_t whom, const TokenBench& bench) {
  const std::uint64_t own = bench.address();
  switch (whom) {
    case 0:
      return bench.frame(TokenControl::solicit_1, TokenBench::kBelow, TokenBench::kAbove);
    case 1:
      return bench.frame(TokenControl::solicit_1, own, TokenBench::kAbove);
    case 2:
      return bench.frame(TokenControl::solicit_2, kNextOfMany, TokenBench::kBelow);
    default:
      return bench.frame(TokenControl::solicit_2, TokenBench::kAbove, TokenBench::kAbove);
  }
}

// Who or what its data unit names; for data it says how many octets they are.
Octets any_frame(const std::vector<std::int64_t>& numbers, TokenBench& bench) {
  constexpr std::array<std::uint8_t, kMostControl + 1> kControls{
      0x10, 0x80, 0x40, 0xC0, 0x20, 0x30, 0x00, 0x62, 0x72, 0x6A, 0x22, 0x03, 0xA0, 0x60, 0x90, 0x08, 0x2A};
  const std::uint8_t control = kControls.at(static_cast<std::size_t>(numbers[0]));
  const std::uint64_t to = address_meant(numbers[1], bench);
  const std::uint64_t from = address_meant(numbers[2], bench);
  const auto about = static_cast<std::size_t>(numbers[3]);
  const bool is_data = (control & 0x03U) == 0x02 || (control & 0x03U) == 0x01;
  if (is_data && about == 7) return bench.data_frame(control, to, from, {1, 2, 3});
  if (is_data) return bench.data_frame(control, to, from, bench.numbered_data(2 + 5 * about));
  if (about == 7) return bench.data_frame(control, to, from, {0});
  const std::array<std::optional<std::uint64_t>, kMostAbout> named{std::nullopt,
                                                                   bench.address(),
                                                                   TokenBench::kAbove,
                                                                   TokenBench::kBelow,
                                                                   TokenBench::kStranger,
                                                                   address_meant(9, bench),
                                                                   0x0011};
  return bench.frame(TokenControl{control}, to, from, named.at(about));
}

}  // namespace

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
    case TokenWord::request:
      return bench.data_frame(data_control(1, static_cast<unsigned>(numbers[0])), own, kAbove,
                              bench.numbered_data(2));
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

}  // namespace fieldproof::conformance
