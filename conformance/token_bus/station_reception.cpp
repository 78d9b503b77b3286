#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/token_bus/station_listening.hpp"
#include "harness/line/frame_check.hpp"

// What is a frame for a station, what is not, and which error it counts.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::memory;
using token_sources::mib;
using token_sources::paper;
using token_sources::standard;

// Two values of which one is the check.
line::Levels with_other_check(TokenScene& scene) {
  Octets octets = with_crc_32(right_token(scene));
  const std::size_t at = octets.size() - 4;
  switch (scene.turn % 4) {
    case 0:
      std::reverse(octets.begin() + static_cast<std::ptrdiff_t>(at), octets.end());
      break;
    case 1:
      for (std::size_t n = at; n < octets.size(); ++n)
        octets[n] = static_cast<std::uint8_t>(line::reflect(octets[n], 8));
      break;
    case 2:
      for (std::size_t n = at; n < octets.size(); ++n) octets[n] = static_cast<std::uint8_t>(~octets[n]);
      break;
    default:
      octets.back() ^= 0x10;
      break;
  }
  return half_bits_around(octets);
}

line::Levels with_wrong_bit(TokenScene& scene) {
  Octets octets = with_crc_32(right_token(scene));
  octets[scene.turn / 8] = static_cast<std::uint8_t>(octets[scene.turn / 8] ^ (1U << scene.turn % 8));
  return half_bits_around(octets);
}

line::Levels with_bits_too_many(TokenScene& scene) {
  constexpr std::size_t kSymbol = 4;
  const line::Levels right = half_bits_around(with_crc_32(right_token(scene)));
  const std::size_t content = right.size() - 8 * kSymbol;
  line::Levels levels = right.slice(0, content);
  for (unsigned n = 0; n <= scene.turn; ++n) levels.append(0b1001, kSymbol);
  levels.append(right, content, 8 * kSymbol);
  return levels;
}

Octets of_unknown_control(TokenScene& scene) {
  constexpr std::array<std::uint8_t, 6> kUnknown{0xA0, 0x60, 0x90, 0x03, 0xC3, 0x08};
  Octets octets = right_token(scene);
  octets[0] = kUnknown.at(scene.turn % kUnknown.size());
  return octets;
}

Octets data_of(TokenScene& scene, std::size_t octets_between_delimiters) {
  constexpr std::size_t kAround = 9;  // control, addresses, check
  scene.data = scene.bench.numbered_data(octets_between_delimiters - kAround);
  return scene.bench.data_frame(0x62, scene.bench.address(), TokenBench::kAbove, scene.data);
}

TokenStep data_to(std::string whom, std::uint64_t destination) {
  return send("000E sends data to " + whom, [destination](TokenScene& scene) {
    scene.data = scene.bench.numbered_data(6);
    return scene.bench.data_frame(0x62, destination, TokenBench::kAbove, scene.data);
  });
}

// Data and the token in one transmission: I = 1 in the first end delimiter.
line::Levels data_and_token(TokenScene& scene) {
  scene.data = scene.bench.numbered_data(6);
  line::Levels levels = half_bits_around(
      with_crc_32(scene.bench.data_frame(0x62, scene.bench.address(), TokenBench::kAbove, scene.data)),
      {.more_follows = true});
  levels.append(half_bits_around(with_crc_32(right_token(scene))));
  return levels;
}

constexpr std::uint8_t kRequestOfFour = 0x32;   // 01 001 100
constexpr std::uint8_t kResponseOfFour = 0x2A;  // 01 010 100

}  // namespace

std::vector<TokenCase> token_reception_cases() {
  return {
      on_chart(
          token_must("reception/single_bit_errors_are_seen", "TB-31",
                     "A frame whose check does not fit is ignored and counted.", mib("FCS errors"),
                     {{"check_not_looked_at", "acts_on_wrong_check"}}),
          {{},
           {joined(),
            repeat({72, 72}, {drive("a token for the station with one wrong bit, each of its 72 in its turn",
                                    with_wrong_bit),
                              ignored("acts_on_wrong_check", "its check does not fit")}),
            counted("FCS errors", kFcsError, 72), serves()}}),
      on_chart(
          token_must("reception/other_checks_are_refused", "TB-31",
                     "The check is CRC-32, complemented, the octet with the highest powers first.",
                     standard("frame check sequence"),
                     {{"check_in_other_order_taken", "acts_on_other_check"}}),
          {{},
           {joined(),
            repeat({4, 40}, {drive("a token for the station whose check has its octets, or its bits, in the "
                                   "other order, is not complemented, or has a wrong bit, in turn",
                                   with_other_check),
                             ignored("acts_on_other_check", "its check is another")}),
            serves()}}),
      on_chart(token_must("reception/frames_with_the_error_bit_are_left", "TB-31",
                          "A frame whose end delimiter has E = 1 is ignored and counted.",
                          mib("E bit errors"), {{"error_bit_ignored", "acts_on_error_bit"}}),
               {{},
                {joined(), send("a token for the station with E = 1", right_token, {.has_error = true}),
                 ignored("acts_on_error_bit", "a repeater has seen an error"),
                 counted("E bit errors", kEBitError, 1), counted("FCS errors", kFcsError, 0), serves()}}),
      on_chart(
          token_must("reception/fragments_are_left", "TB-31",
                     "An abort sequence, and a frame with a part of an octet, are ignored and counted as "
                     "fragments.",
                     mib("frame fragments"), {{"part_of_an_octet_taken", "acts_on_fragment"}}),
          {{},
           {joined(),
            drive("a start delimiter and at once an end delimiter",
                  [](TokenScene&) { return half_bits_around({}); }),
            ignored("acts_on_fragment", "it was aborted"), counted("fragments", kFragment, 1),
            repeat({7, 7},
                   {drive("a token for the station with one to seven bits after its last octet, in turn",
                          with_bits_too_many),
                    ignored("acts_on_fragment", "it has a part of an octet")}),
            counted("fragments", kFragment, 8), serves()}}),
      on_chart(
          token_must("reception/the_longest_frame_is_received", "TB-31",
                     "A frame has 8191 octets between its delimiters at most; a longer one is ignored and "
                     "counted.",
                     paper("8191 octets between SD and ED"),
                     {{"takes_8192_octets", "delivered_unasked"}, {"takes_8190_octets", "not_delivered"}},
                     {{mib("frames too long"), {"counter_wrong"}}}),
          {{},
           {joined(),
            send("data for the station, 8191 octets between the delimiters",
                 [](TokenScene& scene) { return data_of(scene, 8'191); }),
            delivered("it is delivered", 1), wait(10),
            send("data for the station, 8192 octets",
                 [](TokenScene& scene) { return data_of(scene, 8'192); }),
            delivered("it is not delivered", 0), counted("frames too long", kTooLong, 1), wait(10),
            serves()}}),
      on_chart(
          token_must("reception/noise_is_counted", "TB-32", "Signal without a start delimiter is counted.",
                     mib("non-silence"), {{"noise_not_counted", "counter_wrong"}}),
          {{},
           {joined(), repeat({3, 3}, {noise(8), wait(10)}), counted("non-silence", kNonSilence, 3),
            counted("fragments", kFragment, 0), serves()}}),
      on_chart(token_must("reception/other_controls_are_left", "TB-33",
                          "A frame with an unknown control code is ignored.", memory("frame control"),
                          {{"unknown_control_is_a_token", "acts_on_unknown"}}),
               {{},
                {joined(),
                 repeat({6, 6}, {send("a frame for the station with another control code, six in turn",
                                      of_unknown_control),
                                 ignored("acts_on_unknown", "its control code is none")}),
                 serves()}}),
      on_chart(token_must("reception/sources_are_individual", "TB-33",
                          "A frame whose source is a group is ignored.", standard("addresses"),
                          {{"group_source_taken", "acts_on_group_source"}}),
               {{},
                {joined(),
                 send("a token for the station from 000F",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::token, scene.bench.address(), 0x000F);
                      }),
                 ignored("acts_on_group_source", "a source is individual"), serves()}}),
      on_chart(token_must("reception/addresses_of_another_length_are_left", "TB-33",
                          "In a network with addresses of 16 bits a token with those of 48 is ignored.",
                          standard("addresses"), {{"longer_tokens_taken", "acts_on_other_length"}}),
               {{},
                {joined(),
                 send("a token for 00000000000A from 00000000000E",
                      [](TokenScene&) { return Octets{0x10, 0x0A, 0, 0, 0, 0, 0, 0x0E, 0, 0, 0, 0, 0}; }),
                 ignored("acts_on_other_length", "its addresses have another length"), serves()}}),
      on_chart(
          token_must("reception/frames_follow_each_other", "TB-34",
                     "After an end delimiter with I = 1 another frame may follow in the same transmission.",
                     standard("end delimiter"), {{"first_frame_only", "token_missing"}}),
          {{},
           {joined(), drive("data for the station, and in the same transmission the token", data_and_token),
            delivered("the data are delivered", 1), passes_on()}}),
      on_chart(token_must("reception/data_reach_those_they_are_for", "TB-33",
                          "Data for the station, or for a group, are reported to its user; others are not.",
                          standard("addresses"),
                          {{"data_for_others_delivered", "delivered_unasked"},
                           {"broadcast_not_delivered", "not_delivered"},
                           {"delivers_as_if_to_itself", "not_delivered"},
                           {"delivers_from_another", "not_delivered"},
                           {"delivers_with_another_priority", "not_delivered"}}),
               {{5, 50},
                {data_to("the station", kOwnAddress), delivered("they are delivered", 1), wait(10),
                 data_to("everybody", 0xFFFF), delivered("they are delivered", 1), wait(10),
                 data_to("0004", TokenBench::kBelow), delivered("they are not delivered", 0), wait(10)},
                {joined()}}),
      on_chart(
          token_must("reception/requests_are_answered", "TB-27",
                     "A request with response is answered by a response of its priority, to who has sent it.",
                     standard("response"), {{"responds_with_highest_priority", "response_wrong"}},
                     {{token_sources::controller("two slot times for the responder"), {"begins_too_late"}}}),
          {{},
           {joined(),
            stimulus<TokenScene>("the user has a response ready",
                                 [](TokenScene& scene) {
                                   scene.data = scene.bench.numbered_data(5);
                                   scene.bench.set_response(scene.data);
                                 }),
            send("000E sends a request of priority 4 for the station",
                 [](TokenScene& scene) {
                   return scene.bench.data_frame(kRequestOfFour, kOwnAddress, TokenBench::kAbove, {7});
                 }),
            expected<TokenScene>("the response, to 000E",
                                 [](TokenScene& scene) {
                                   scene.expect_frame({TokenControl{kResponseOfFour}, TokenBench::kAbove},
                                                      {scene.bench.gap(), scene.bench.slots(2)},
                                                      "a response of priority 4 to 000E", "response_missing",
                                                      "response_wrong");
                                   scene.judge.expect(scene.answer.data() == scene.data, "response_wrong",
                                                      "the response of the user", scene.answer.text());
                                 })}}),
  };
}

}  // namespace fieldproof::conformance
