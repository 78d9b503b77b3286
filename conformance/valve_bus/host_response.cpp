#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <vector>

#include "conformance/valve_bus/bit_pairs.hpp"
#include "conformance/valve_bus/blind_check.hpp"
#include "conformance/valve_bus/host_scene.hpp"

// What is a response, and what the PC is told of it.
namespace fieldproof::conformance {
namespace {

using valve_bus::CharacterProfile;
using Octets = std::vector<std::uint8_t>;

constexpr unsigned kResponseBits = 8 * valve_bus::kResponseOctets;

// At last all bits of the check.
Octets wrong_bit(HostScene& scene) {
  Octets octets = host_chart::right_octets(scene);
  const unsigned which = scene.round % (kResponseBits + 1);
  if (which < kResponseBits) {
    invert(octets, which);
  } else {
    octets.back() = static_cast<std::uint8_t>(~octets.back());
  }
  return octets;
}

// Two equal octets have a check of 0, as an idle memory has.
constexpr std::array<std::uint8_t, 3> kEqual{0x00, 0x55, 0xFF};
constexpr unsigned kColumnPairs = 24;
constexpr unsigned kOtherPairs = 252;
constexpr Rounds kPairRounds{kEqual.size() + kColumnPairs + kOtherPairs / 6,
                             kEqual.size() + kColumnPairs + kOtherPairs};

// After the last round: that the host reported each of them, its round has shown.
void warn_of_reported_pairs(HostScene& scene) {
  if (scene.round + 1 != scene.bench.volume(kPairRounds.quick, kPairRounds.full)) return;
  warn_of_blind_check(scene.judge, kColumnPairs, kColumnPairs,
                      "responses with two wrong bits in a column were reported");
}

// The exclusive or cannot see two wrong bits in one column. A host that refuses such a response has another
// check; one that takes any other double error has none.
Octets equal_octets_or_two_wrong_bits(HostScene& scene) {
  static const auto pairs = bit_pairs(valve_bus::kResponseOctets);
  if (scene.round < kEqual.size()) return {kEqual[scene.round], kEqual[scene.round], 0};
  Octets octets = host_chart::right_octets(scene);
  const auto& [first, second] = pairs.at(scene.round - kEqual.size());
  invert(octets, first);
  invert(octets, second);
  return octets;
}

constexpr std::array kEarlyBits{2, 5, 10};

constexpr std::array<std::size_t, 5> kMore{1, 2, 3, 5, 12};

// The first octet or two; zeros in front of a response, and after one.
Octets of_other_length(HostScene& scene) {
  Octets octets = host_chart::right_octets(scene);
  const bool is_in_front = scene.round % 2 == 0;
  if (scene.round < 2) {
    octets.resize(is_in_front ? 1 : 2);
  } else {
    octets.insert(is_in_front ? octets.begin() : octets.end(), kMore.at(scene.round / 2 - 1),
                  std::uint8_t{0});
  }
  return octets;
}

constexpr std::array kResponseGaps{0.5, 1.0, 1.4, 1.6, 2.0, 3.0, 3.4};

double gap_of(const HostScene& scene) {
  return kResponseGaps.at(scene.round % kResponseGaps.size());
}

void answer_with_a_gap(HostScene& scene) {
  const HostBench& bench = scene.bench;
  const std::size_t at = 1 + scene.round / kResponseGaps.size();
  const auto begin = static_cast<double>(at) + gap_of(scene);
  scene.octets = host_chart::right_octets(scene);
  const std::span<const std::uint8_t> all(scene.octets);
  scene.bench.answer(all.first(at), bench.turnaround_time());
  scene.bench.answer(all.subspan(at), bench.turnaround_time() + bench.characters(begin));
}

// What the line makes of two drivers: where they differ, either of both.
Octets mixture(HostScene& scene) {
  Octets mixed;
  do {
    mixed = host_chart::right_octets(scene);
    for (std::uint8_t& octet : mixed) {
      const unsigned different = octet ^ scene.bench.random_octet();
      octet = static_cast<std::uint8_t>(octet ^ (different & scene.bench.random_octet()));
    }
  } while (valve_bus::block_check(mixed) == 0);
  return mixed;
}

line::Levels without_a_ninth_bit(HostScene& scene) {
  line::Levels levels = scene.levels(scene.bench.rules().characters);
  levels.flip(scene.round * levels.size() / scene.octets.size() + 9);
  return levels;
}

judge::Reference silence_ends_a_frame() {
  return valve_sources::own("silence of 3.5 characters ends a frame");
}

std::vector<HostCase> cases_of_octets() {
  using namespace host_chart;
  return {
      on_chart({.id = "valve_bus/host/response/is_told_once_with_its_id",
                .purpose = "RH-02",
                .requirement = "The response to a read is reported to the PC once, with the ID of the node "
                               "that it read.",
                .reference = valve_sources::paper("frame of the node"),
                .details = {{valve_sources::own("the ID is that of the read"), {"told_twice"}}},
                .tags = {"must"},
                .catches = {{"told_twice", "told_twice"},
                            {"told_of_node_before", "response_wrong"},
                            {"response_exchanged", "response_wrong"}}},
               {{10, 500},
                {read(), response(), reported(),
                 nothing_reported(2 * kernel::kMillisecond, "told_twice", "one read, one response")}}),
      on_chart(
          {.id = "valve_bus/host/response/each_wrong_bit_is_refused",
           .purpose = "RH-06",
           .requirement = "A response whose block check does not fit is refused, and the node is "
                          "polled again.",
           .reference = valve_sources::paper("host on a wrong block check"),
           .tags = {"must"},
           .catches = {{"response_not_checked", "wrong_response_told"},
                       {"inverted_check_taken", "wrong_response_told"},
                       {"bad_response_not_repeated", "no_retry"}}},
          {{kResponseBits + 1, kResponseBits + 1},
           {read(),
            answer("the node answers with one of the 24 bits wrong, each in turn, then with all of the check",
                   wrong_bit),
            refused("wrong_response_told", "its check does not fit")}}),
      on_chart({.id = "valve_bus/host/response/two_wrong_bits_of_a_column_are_taken",
                .purpose = "RH-07",
                .requirement = "The block check of a response is the exclusive or of DATA0 and DATA1: it "
                               "fits whenever each of its eight columns has an even number of wrong bits, "
                               "and only then.",
                .reference = valve_sources::calculated("24 double errors in one column, 252 others"),
                .tags = {"must"},
                .catches = {{"id_in_response_check", "right_check_refused"},
                            {"response_check_too_strict", "right_check_refused"},
                            {"response_check_is_parity", "wrong_response_told"}}},
               {kPairRounds,
                {read(),
                 answer("the node answers with two equal octets, then with two wrong bits: all 24 pairs in "
                        "one column, and the 252 others",
                        equal_octets_or_two_wrong_bits),
                 taken_if(
                     "of equal octets and of one column",
                     [](const HostScene& scene) { return scene.round < kEqual.size() + kColumnPairs; },
                     "right_check_refused", "wrong_response_told", "its check does not fit"),
                 stimulus("", warn_of_reported_pairs)}}),
      on_chart({.id = "valve_bus/host/response/early_response_is_refused",
                .purpose = "RH-10",
                .requirement = "What begins within 10 bits of the request belongs to its frame and is no "
                               "response.",
                .reference = silence_ends_a_frame(),
                .tags = {"must", "timing"},
                .catches = {{"takes_early_response", "early_response_told"}},
                .not_applicable = for_item("takes_early_responses", false, declared_host(),
                                           "the host takes responses that come at once")},
               {{6, 150},
                {read(),
                 answer("the node answers rightly 2, 5 or 10 bits after the request", right_octets,
                        [](HostScene& scene) { return scene.bench.bits(kEarlyBits.at(scene.round % 3)); }),
                 refused("early_response_told", "it belongs to the frame of the request")}}),
      on_chart({.id = "valve_bus/host/response/early_response_is_taken",
                .purpose = "RH-10",
                .requirement = "A response that begins 2 characters after the request is one.",
                .reference = silence_ends_a_frame(),
                .tags = {"must", "timing"},
                .catches = {{"wants_a_delimiter_before_responses", "response_not_told"}}},
               {{2, 50},
                {read(),
                 answer("the node answers rightly 2 characters after the request", right_octets,
                        [](HostScene& scene) { return scene.bench.characters(2); }),
                 reported()}}),
      on_chart({.id = "valve_bus/host/response/other_lengths_are_refused",
                .purpose = "RH-11",
                .requirement = "A response has three octets, no more and no less, also when three of "
                               "more are a valid one.",
                .reference = valve_sources::paper("frame of the node"),
                .tags = {"must"},
                .catches = {{"takes_two_octets", "wrong_length_told"},
                            {"takes_first_three_octets", "wrong_length_told"},
                            {"takes_last_three_octets", "wrong_length_told"}}},
               {{2 + 2 * kMore.size(), 2 + 2 * kMore.size()},
                {read(),
                 answer("the node answers with one or two octets of a response, or with a response that has "
                        "1, 2, 3, 5 or 12 octets of zeros in front or after it",
                        of_other_length),
                 refused("wrong_length_told", "a response has three octets")}}),
  };
}

HostCase gaps_case(const std::string& name, std::vector<MustCatch> catches, Applicability not_applicable,
                   HostNeeds needs) {
  using namespace host_chart;
  return on_chart({.id = "valve_bus/host/response/" + name,
                   .purpose = "RH-12",
                   .requirement = "Inside a response up to 1.5 characters of silence are allowed; more "
                                  "spoil it.",
                   .reference = silence_ends_a_frame(),
                   .tags = {"must", "timing"},
                   .catches = std::move(catches),
                   .not_applicable = std::move(not_applicable)},
                  {{2 * kResponseGaps.size(), 2 * kResponseGaps.size()},
                   {read(),
                    stimulus("the node answers with a gap of 0.5 to 3.4 characters in front of the "
                             "second or the third octet",
                             answer_with_a_gap),
                    taken_if(
                        "up to 1.4 characters", [](const HostScene& scene) { return gap_of(scene) < 1.5; },
                        "short_gap_refused", "long_gap_taken", "1.6 characters or more are too many")}},
                  std::move(needs));
}

std::vector<HostCase> cases_of_characters() {
  using namespace host_chart;
  return {
      gaps_case("gaps_inside_a_response",
                {{"response_gaps_of_three_characters", "long_gap_taken"},
                 {"response_gaps_of_one_character", "short_gap_refused"}},
                {}, {}),
      gaps_case("gaps_between_characters_of_ten_bits",
                {{"response_gaps_of_three_characters", "long_gap_taken"}}, for_characters("P2"),
                {.characters = CharacterProfile::eight_bits}),
      on_chart(
          {.id = "valve_bus/host/response/two_nodes_at_once_are_refused",
           .purpose = "RH-29",
           .requirement = "When two nodes answer at once, what the line makes of them is refused by "
                          "its check, unless they say the same.",
           .reference = valve_sources::derived("nodes in parallel on one pair"),
           .tags = {"must"},
           .catches = {{"response_not_checked", "mixture_told"}}},
          {{8, 200},
           {read(), answer("two nodes answer at once: a mixture whose check does not fit", mixture),
            refused("mixture_told", "two nodes answered at once"), read(),
            answer("two nodes give equal answers at once", right_octets), taken("equal_responses_refused")}}),
      on_chart({.id = "valve_bus/host/response/of_another_node_is_taken",
                .purpose = "RH-34",
                .requirement = "A response of the wrong node in time is reported as that of the node that "
                               "was read: nothing in it says whose it is. No host of this bus can do "
                               "otherwise; one that does has another frame.",
                .reference = valve_sources::paper("frame of the node: no ID in it"),
                .tags = {"must", "hazard"},
                .catches = {{"id_in_response_check", "right_check_refused"}}},
               {{5, 100},
                {read(), answer("a node with a wrong address answers", right_octets),
                 taken("right_check_refused")}}),
      on_chart({.id = "valve_bus/host/response/characters_of_other_formats_are_refused",
                .purpose = "RH-35",
                .requirement = "With parity, responses in another character format are wrong, not data.",
                .reference = valve_sources::own("character format P1"),
                .tags = {"must"},
                .catches = {{"parity_not_looked_at", "foreign_format_told"}},
                .not_applicable = for_characters("P1")},
               {{10, 200},
                {read(),
                 answer_levels("the node answers in characters P0 or P2",
                               [](HostScene& scene) {
                                 return scene.levels(scene.round % 2 == 0 ? CharacterProfile::ninth_bit_one
                                                                          : CharacterProfile::eight_bits);
                               }),
                 refused("foreign_format_told", "the characters have another format")}},
               {.characters = CharacterProfile::even_parity}),
      on_chart({.id = "valve_bus/host/response/ninth_bit_is_not_looked_at",
                .purpose = "RH-35",
                .requirement = "With nine bits, the host does not look at the ninth of a response.",
                .reference = valve_sources::own("character format P0"),
                .tags = {"must"},
                .catches = {{"wants_ninth_bit", "ninth_bit_looked_at"}},
                .not_applicable = for_characters("P0")},
               {{valve_bus::kResponseOctets, valve_bus::kResponseOctets},
                {read(),
                 answer_levels("the node answers with the ninth bit of one character 0, each in turn",
                               without_a_ninth_bit),
                 taken("ninth_bit_looked_at")}},
               {.characters = CharacterProfile::ninth_bit_one}),
  };
}

}  // namespace

std::vector<HostCase> host_response_cases() {
  std::vector<HostCase> cases = cases_of_octets();
  std::ranges::move(cases_of_characters(), std::back_inserter(cases));
  return cases;
}

}  // namespace fieldproof::conformance
