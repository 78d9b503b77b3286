#include <fmt/format.h>

#include <array>

#include "conformance/valve_bus/characters_item.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_expect.hpp"

// What is a response, and what the PC is told of it.
namespace fieldproof::conformance {
namespace {

using valve_bus::CharacterProfile;
using valve_bus::Response;
using ResponseOctets = std::array<std::uint8_t, valve_bus::kResponseOctets>;

constexpr unsigned kResponseBits = 8 * valve_bus::kResponseOctets;

ResponseOctets random_response(HostBench& bench) {
  return octets_of(Response{bench.random_octet(), bench.random_octet()});
}

void invert(ResponseOctets& octets, unsigned bit) {
  octets[bit / 8] = static_cast<std::uint8_t>(octets[bit / 8] ^ (1U << (bit % 8)));
}

// In which a response that began at an ordinary time has been told, if it is.
kernel::Duration telling_time(const HostBench& bench) {
  return bench.characters(14) + kernel::kMillisecond;
}

// What answered `request` is none: nothing is told, the host polls again, and takes a right response.
void expect_refused_response(HostBench& bench, CaseJudge& judge, const HostFrame& request,
                             std::string_view told_reason, std::string_view why_not) {
  expect_nothing_told(bench, judge, telling_time(bench), told_reason, why_not);
  expect_retry(bench, judge, request);
  const Response right{bench.random_octet(), bench.random_octet()};
  bench.answer(right);
  expect_response(bench, judge, request.command().id, right);
}

// A read whose response is these octets is told with the data in them.
void expect_taken(HostBench& bench, CaseJudge& judge, std::uint8_t id, const ResponseOctets& octets,
                  std::string_view refused_reason) {
  const auto told = bench.next_told(telling_time(bench));
  judge.expect(told.has_value(), refused_reason, [&] {
    return Mismatch{{fmt::format("the PC gets the data of {:02X}: {:02X} {:02X}", id, octets[0], octets[1])},
                    "nothing"};
  });
  const auto* response = std::get_if<valve_bus::HostResponse>(&told->what);
  judge.expect(response != nullptr && *response == valve_bus::HostResponse{id, octets[0], octets[1]},
               "response_wrong", [&] {
                 return Mismatch{
                     {fmt::format("the PC gets the data of {:02X}: {:02X} {:02X}", id, octets[0], octets[1])},
                     text_of(*told)};
               });
}

void a_response_is_told_once(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(10, 500); ++n) {
    expect_read_served(bench, judge, bench.random_id());
    expect_nothing_told(bench, judge, 2 * kernel::kMillisecond, "told_twice", "one read, one response");
  }
}

void each_wrong_bit_is_refused(HostBench& bench, CaseJudge& judge) {
  for (unsigned bit = 0; bit < kResponseBits; ++bit) {
    const HostFrame request = order_read(bench, judge, bench.random_id());
    ResponseOctets octets = random_response(bench);
    invert(octets, bit);
    bench.answer(octets, bench.turnaround_time());
    expect_refused_response(bench, judge, request, "wrong_response_told",
                            fmt::format("bit {} of the response is wrong", bit));
  }
}

// The exclusive or cannot see two wrong bits in one column. A host that refuses such a response has another
// check; one that takes any other double error has none.
void answer_with_two_wrong_bits(HostBench& bench, CaseJudge& judge, unsigned first, unsigned second) {
  const HostFrame request = order_read(bench, judge, bench.random_id());
  ResponseOctets octets = random_response(bench);
  invert(octets, first);
  invert(octets, second);
  bench.answer(octets, bench.turnaround_time());
  if (first % 8 == second % 8) {
    expect_taken(bench, judge, request.command().id, octets, "right_check_refused");
  } else {
    expect_refused_response(bench, judge, request, "wrong_response_told",
                            fmt::format("bits {} and {} of the response are wrong", first, second));
  }
}

void two_wrong_bits_of_a_column_are_taken(HostBench& bench, CaseJudge& judge) {
  // Two equal octets have a check of 0, as an idle memory has.
  for (const unsigned octet : {0x00U, 0x55U, 0xFFU}) {
    const HostFrame request = order_read(bench, judge, bench.random_id());
    const auto data = static_cast<std::uint8_t>(octet);
    const ResponseOctets octets = octets_of(Response{data, data});
    bench.answer(octets, bench.turnaround_time());
    expect_taken(bench, judge, request.command().id, octets, "right_check_refused");
  }
  for (unsigned first = 0; first < kResponseBits; ++first) {
    for (unsigned second = first + 8; second < kResponseBits; second += 8) {
      answer_with_two_wrong_bits(bench, judge, first, second);
    }
  }
  const unsigned step = bench.volume(6U, 1U);
  unsigned pair = 0;
  for (unsigned first = 0; first < kResponseBits; ++first) {
    for (unsigned second = first + 1; second < kResponseBits; ++second) {
      if ((second - first) % 8 == 0 || ++pair % step != 0) continue;
      answer_with_two_wrong_bits(bench, judge, first, second);
    }
  }
}

void early_responses_are_refused(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 50); ++n) {
    for (const int bits : {2, 5, 10}) {
      const HostFrame request = order_read(bench, judge, bench.random_id());
      bench.answer(random_response(bench), bench.bits(bits));
      expect_refused_response(bench, judge, request, "early_response_told",
                              fmt::format("a response {} bits after the request", bits));
    }
  }
}

void other_lengths_are_refused(HostBench& bench, CaseJudge& judge) {
  for (const std::size_t more : {0U, 1U, 2U, 3U, 5U, 12U}) {
    for (const bool is_in_front : {false, true}) {
      const HostFrame request = order_read(bench, judge, bench.random_id());
      const ResponseOctets whole = random_response(bench);
      std::vector<std::uint8_t> octets(whole.begin(), whole.end());
      // Without more: the first two octets, or the first one.
      if (more == 0) octets.resize(is_in_front ? 1 : 2);
      octets.insert(is_in_front ? octets.begin() : octets.end(), more, std::uint8_t{0});
      bench.answer(octets, bench.turnaround_time());
      bench.wait(bench.characters(static_cast<double>(octets.size())));
      expect_refused_response(bench, judge, request, "wrong_length_told",
                              fmt::format("{} octets are no response", octets.size()));
    }
  }
}

void gaps_inside_a_response(HostBench& bench, CaseJudge& judge) {
  for (const std::size_t at : {1U, 2U}) {
    for (const double gap : {0.5, 1.0, 1.4, 1.6, 2.0, 3.0, 3.4}) {
      const HostFrame request = order_read(bench, judge, bench.random_id());
      const ResponseOctets octets = random_response(bench);
      const std::span<const std::uint8_t> all(octets);
      bench.answer(all.first(at), bench.turnaround_time());
      bench.answer(all.subspan(at),
                   bench.turnaround_time() + bench.characters(static_cast<double>(at) + gap));
      if (gap < 1.5) {
        expect_taken(bench, judge, request.command().id, octets, "short_gap_refused");
      } else {
        expect_refused_response(bench, judge, request, "long_gap_taken",
                                fmt::format("{} characters of silence in the response", gap));
      }
    }
  }
}

// What the line makes of two drivers: where they differ, either of both.
ResponseOctets mixed(HostBench& bench, const ResponseOctets& one, const ResponseOctets& other) {
  ResponseOctets mixture = one;
  do {
    for (std::size_t n = 0; n < one.size(); ++n) {
      const unsigned different = one[n] ^ other[n];
      mixture[n] = static_cast<std::uint8_t>(one[n] ^ (different & bench.random_octet()));
    }
  } while (valve_bus::block_check(mixture) == 0);
  return mixture;
}

void two_nodes_at_once_are_refused(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(8, 200); ++n) {
    const ResponseOctets one = random_response(bench);
    const auto data0 = static_cast<std::uint8_t>(one[0] ^ (1 + bench.random().below(255)));
    const ResponseOctets other = octets_of(Response{data0, bench.random_octet()});
    const HostFrame request = order_read(bench, judge, bench.random_id());
    bench.answer(mixed(bench, one, other), bench.turnaround_time());
    expect_refused_response(bench, judge, request, "mixture_told", "two nodes answered at once");
    const HostFrame again = order_read(bench, judge, request.command().id);
    bench.answer(one, bench.turnaround_time());
    expect_taken(bench, judge, again.command().id, one, "equal_responses_refused");
  }
}

// Nothing in a response says whose it is.
void a_response_of_another_node_is_taken(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(5, 100); ++n) {
    const HostFrame request = order_read(bench, judge, bench.random_id());
    const ResponseOctets of_another = random_response(bench);
    bench.answer(of_another, bench.turnaround_time());
    expect_taken(bench, judge, request.command().id, of_another, "right_check_refused");
  }
}

line::Levels levels_of_all(const HostBench& bench, const ResponseOctets& octets, CharacterProfile profile) {
  line::Levels all;
  for (const std::uint8_t octet : octets) all.append(bench.levels_of(octet, profile));
  return all;
}

void characters_of_other_formats_are_refused(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(5, 100); ++n) {
    for (const auto profile : {CharacterProfile::ninth_bit_one, CharacterProfile::eight_bits}) {
      const HostFrame request = order_read(bench, judge, bench.random_id());
      bench.answer_levels(levels_of_all(bench, random_response(bench), profile), bench.turnaround_time());
      expect_refused_response(bench, judge, request, "foreign_format_told",
                              fmt::format("a response in characters {}", text_of(profile)));
    }
  }
}

void the_ninth_bit_of_a_response_is_not_looked_at(HostBench& bench, CaseJudge& judge) {
  for (std::size_t at = 0; at < valve_bus::kResponseOctets; ++at) {
    const HostFrame request = order_read(bench, judge, bench.random_id());
    const ResponseOctets octets = random_response(bench);
    line::Levels levels;
    for (std::size_t n = 0; n < octets.size(); ++n) {
      line::Levels character = bench.levels_of(octets[n]);
      if (n == at) character.flip(9);
      levels.append(character);
    }
    bench.answer_levels(levels, bench.turnaround_time());
    expect_taken(bench, judge, request.command().id, octets, "ninth_bit_looked_at");
  }
}

judge::Reference silence_ends_a_frame() {
  return valve_sources::own("silence of 3.5 characters ends a frame");
}

void add_cases_of_octets(std::vector<HostCase>& cases) {
  cases.push_back(
      {{.id = "valve_bus/host/response/is_told_once_with_its_id",
        .purpose = "RH-02",
        .requirement = "The response to a read is reported to the PC once, with the ID of the node "
                       "that it read.",
        .reference = valve_sources::paper("frame of the node"),
        .details = {{valve_sources::own("the ID is that of the read"), {"told_twice"}}},
        .stimulus = "Reads of many nodes with random responses.",
        .expected = "Each is reported once, with its ID and data.",
        .tags = {"must"},
        .catches = {{"told_twice", "told_twice"},
                    {"told_of_node_before", "response_wrong"},
                    {"response_exchanged", "response_wrong"}}},
       a_response_is_told_once});
  cases.push_back(
      {{.id = "valve_bus/host/response/each_wrong_bit_is_refused",
        .purpose = "RH-06",
        .requirement = "A response whose block check does not fit is refused, and the node is "
                       "polled again.",
        .reference = valve_sources::paper("host on a wrong block check"),
        .stimulus = "Responses with each of their 24 bits wrong in turn.",
        .expected = "Nothing is reported; the next poll is answered rightly, and that is reported.",
        .tags = {"must"},
        .catches = {{"response_not_checked", "wrong_response_told"},
                    {"bad_response_not_repeated", "no_retry"}}},
       each_wrong_bit_is_refused});
  cases.push_back(
      {{.id = "valve_bus/host/response/two_wrong_bits_of_a_column_are_taken",
        .purpose = "RH-07",
        .requirement = "The block check of a response is the exclusive or of DATA0 and DATA1: it fits "
                       "whenever each of its eight columns has an even number of wrong bits, and only then.",
        .reference = valve_sources::calculated("24 double errors in one column, 252 others"),
        .stimulus =
            "Responses of two equal octets; responses with two wrong bits: all 24 pairs in one column, "
            "and the 252 others.",
        .expected = "The 24 and the equal ones are reported as they arrive, the others are refused.",
        .tags = {"must"},
        .catches = {{"id_in_response_check", "right_check_refused"},
                    {"response_check_too_strict", "right_check_refused"},
                    {"response_check_is_parity", "wrong_response_told"}}},
       two_wrong_bits_of_a_column_are_taken});
  cases.push_back({{.id = "valve_bus/host/response/early_response_is_refused",
                    .purpose = "RH-10",
                    .requirement = "What begins within 10 bits of the request belongs to its frame and is no "
                                   "response.",
                    .reference = silence_ends_a_frame(),
                    .stimulus = "Responses that begin 2, 5 and 10 bits after the request.",
                    .expected = "Nothing is reported; the node is polled again and served.",
                    .tags = {"must", "timing"},
                    .catches = {{"takes_early_response", "early_response_told"}},
                    .not_applicable = for_host_without("takes_early_responses",
                                                       "the host takes responses that come at once")},
                   early_responses_are_refused});
  cases.push_back({{.id = "valve_bus/host/response/other_lengths_are_refused",
                    .purpose = "RH-11",
                    .requirement = "A response has three octets, no more and no less, also when three of "
                                   "more are a valid one.",
                    .reference = valve_sources::paper("frame of the node"),
                    .stimulus = "One and two octets of a response; responses with 1 to 12 octets of zeros "
                                "after and in front.",
                    .expected = "Nothing is reported; the node is polled again and served.",
                    .tags = {"must"},
                    .catches = {{"takes_two_octets", "wrong_length_told"},
                                {"takes_first_three_octets", "wrong_length_told"},
                                {"takes_last_three_octets", "wrong_length_told"}}},
                   other_lengths_are_refused});
}

void add_cases_of_characters(std::vector<HostCase>& cases) {
  cases.push_back(
      {{.id = "valve_bus/host/response/gaps_inside_a_response",
        .purpose = "RH-12",
        .requirement = "Inside a response up to 1.5 characters of silence are allowed; more "
                       "spoil it.",
        .reference = silence_ends_a_frame(),
        .stimulus =
            "Responses with a gap of 0.5 to 3.4 characters in front of the second or the third octet.",
        .expected = "Told up to 1.4 characters, refused from 1.6 on.",
        .tags = {"must", "timing"},
        .catches = {{"response_gaps_of_three_characters", "long_gap_taken"},
                    {"response_gaps_of_one_character", "short_gap_refused"}}},
       gaps_inside_a_response});
  cases.push_back(
      {{.id = "valve_bus/host/response/two_nodes_at_once_are_refused",
        .purpose = "RH-29",
        .requirement = "When two nodes answer at once, what the line makes of them is refused by "
                       "its check, unless they say the same.",
        .reference = valve_sources::derived("nodes in parallel on one pair"),
        .stimulus = "Mixtures of two responses whose check does not fit; two equal responses.",
        .expected = "The mixtures are not reported and the node is polled again; equal ones are reported.",
        .tags = {"must"},
        .catches = {{"response_not_checked", "mixture_told"}}},
       two_nodes_at_once_are_refused});
  cases.push_back(
      {{.id = "valve_bus/host/response/of_another_node_is_taken",
        .purpose = "RH-34",
        .requirement = "A response of the wrong node in time is reported as that of the node that "
                       "was read: nothing in it says whose it is. No host of this bus can do "
                       "otherwise; one that does has another frame.",
        .reference = valve_sources::paper("frame of the node: no ID in it"),
        .stimulus = "Reads that a node with a wrong address answers.",
        .expected = "The response is reported.",
        .tags = {"must", "hazard"},
        .catches = {{"id_in_response_check", "right_check_refused"}}},
       a_response_of_another_node_is_taken});
  cases.push_back({{.id = "valve_bus/host/response/characters_of_other_formats_are_refused",
                    .purpose = "RH-35",
                    .requirement = "With parity, responses in another character format are wrong, not data.",
                    .reference = valve_sources::own("character format P1"),
                    .stimulus = "Responses in characters P0 and P2.",
                    .expected = "Nothing is reported; the node is polled again and served.",
                    .tags = {"must"},
                    .catches = {{"parity_not_looked_at", "foreign_format_told"}},
                    .not_applicable = for_characters("P1")},
                   characters_of_other_formats_are_refused,
                   {.characters = CharacterProfile::even_parity}});
  cases.push_back({{.id = "valve_bus/host/response/ninth_bit_is_not_looked_at",
                    .purpose = "RH-35",
                    .requirement = "With nine bits, the host does not look at the ninth of a response.",
                    .reference = valve_sources::own("character format P0"),
                    .stimulus = "Responses with the ninth bit of each character 0 in turn.",
                    .expected = "They are reported.",
                    .tags = {"must"},
                    .catches = {{"wants_ninth_bit", "ninth_bit_looked_at"}},
                    .not_applicable = for_characters("P0")},
                   the_ninth_bit_of_a_response_is_not_looked_at,
                   {.characters = CharacterProfile::ninth_bit_one}});
}

}  // namespace

std::vector<HostCase> host_response_cases() {
  std::vector<HostCase> cases;
  add_cases_of_octets(cases);
  add_cases_of_characters(cases);
  return cases;
}

}  // namespace fieldproof::conformance
