#include <fmt/format.h>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"

// What the line does to a transmission, and what a station must make of it: blanking, fronts that are lost,
// several frames in one transmission.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::memory;
using token_sources::mib;
using token_sources::own;
using token_sources::standard;

template <unsigned symbols>
void blanking_of(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.rules.blanking_symbols = symbols;
}

// A reflection of what was on the line last: signal without a start delimiter, between two instants after it.
TokenStep reflection(std::int64_t from, std::int64_t until) {
  return stimulus<TokenScene>(
      fmt::format("signal from {} to {} MAC symbols after the end of that", from, until),
      [from, until](TokenScene& scene) {
        constexpr std::uint64_t kZero = 0b1001;
        line::Levels levels;
        for (std::int64_t n = from; n < until; ++n) levels.append(kZero, 4);
        scene.bench.run_until(scene.since + token_bus::mac_symbols(scene.bench.rules(), from));
        scene.bench.send_half_bits(std::move(levels));
      });
}

TokenStep others_token() {
  return send("000E passes a token to 0004", [](TokenScene& scene) {
    return scene.bench.frame(TokenControl::token, TokenBench::kBelow, TokenBench::kAbove);
  });
}

// The bits of IEEE 802.3 in front of the frame that did not arrive.
line::Levels without_front(TokenScene& scene) {
  const line::Levels whole = half_bits_around(with_crc_32(right_token(scene)));
  const std::size_t lost = 2 * (std::size_t{scene.turn} + 1);
  return whole.slice(lost, whole.size() - lost);
}

constexpr unsigned kLostBits = 15;

Octets data_for(TokenScene& scene, std::uint64_t destination) {
  return with_crc_32(
      scene.bench.data_frame(0x62, destination, TokenBench::kAbove, scene.bench.numbered_data(5)));
}

// Data for the station, for another, for the station, and the token; the second may have a wrong check.
line::Levels train(TokenScene& scene, bool is_second_damaged) {
  line::Levels levels = half_bits_around(data_for(scene, kOwnAddress), {.more_follows = true});
  Octets second = data_for(scene, TokenBench::kBelow);
  if (is_second_damaged) second[6] ^= 0x10U;
  levels.append(half_bits_around(second, {.more_follows = true}));
  levels.append(half_bits_around(data_for(scene, kOwnAddress), {.more_follows = true}));
  levels.append(half_bits_around(with_crc_32(right_token(scene))));
  return levels;
}

TokenStep two_delivered() {
  return require(
      "both data for the station are delivered",
      [](TokenScene& scene) { return scene.bench.user().frames.size() == 2; }, "not_delivered");
}

line::Levels error_bit_and_wrong_check(TokenScene& scene) {
  Octets octets = with_crc_32(right_token(scene));
  octets.back() ^= 0x10U;
  return half_bits_around(octets, {.has_error = true});
}

std::vector<TokenCase> blanking() {
  return {
      on_chart(
          token_must("line/a_reflection_within_blanking_is_silence", "PST-11",
                     "What is on the line while the receiver is blanked, after a transmission of the station "
                     "or of another, is silence.",
                     memory("receiver blanking"), {{"blanking_of_24_symbols", "counter_wrong"}}),
          {{},
           {joined(), others_token(), reflection(8, 31), wait(20), counted("non-silence", kNonSilence, 0),
            token(), passes_below(at_once()), reflection(8, 31), passes_below(after_slots(1)), taken(),
            counted("non-silence", kNonSilence, 0)}},
          {.adjust = blanking_of<32>}),
      on_chart(token_must("line/what_comes_after_blanking_is_seen", "PST-11",
                          "What is on the line when blanking is over is received: noise after a token is "
                          "waited out, and counted.",
                          memory("receiver blanking"), {{"blanking_of_32_symbols", "counter_wrong"}}),
               {{},
                {joined(), others_token(), reflection(20, 27), wait(20),
                 counted("non-silence", kNonSilence, 1), token(), passes_below(at_once()), reflection(20, 27),
                 stimulus<TokenScene>("the line falls silent",
                                      [](TokenScene& scene) { scene.since = scene.bench.now(); }),
                 passes_below(after_slots(4)), counted("non-silence", kNonSilence, 2), taken(), serves()}},
               {.adjust = blanking_of<24>}),
  };
}

}  // namespace

std::vector<TokenCase> token_line_cases() {
  std::vector<TokenCase> all = blanking();
  const std::vector<TokenCase> others{
      on_chart(token_must("line/no_blanking_while_more_follows", "PST-12",
                          "After a frame with I = 1 the receiver is not blanked.",
                          memory("receiver blanking"), {{"blanks_always", "counter_wrong"}}),
               {{},
                {joined(),
                 send("data for the station with I = 1",
                      [](TokenScene& scene) {
                        return scene.bench.data_frame(0x62, kOwnAddress, TokenBench::kAbove, {1, 2});
                      },
                      {.more_follows = true}),
                 reflection(8, 20), wait(20), counted("non-silence", kNonSilence, 1), serves()}}),
      on_chart(
          token_must("line/a_lost_front_costs_no_frame", "PST-04",
                     "A frame whose preamble has lost its first 1 to 15 bits is received.",
                     own("decoding beyond the table"),
                     {{"whole_preamble_needed", "token_missing"}, {"odd_front_not_found", "token_missing"}}),
          {{},
           {joined(), repeat({kLostBits, kLostBits},
                             {drive("a token for the station that has lost one to fifteen bits of its "
                                    "preamble, in turn",
                                    without_front),
                              passes_on(), taken()})}},
          // No window is due meanwhile.
          {.adjust = [](token_bus::StationConfiguration& one,
                        kernel::Random&) { one.rules.max_inter_solicit_count = 255; }}),
      on_chart(token_must("line/four_frames_in_one_transmission", "TB-34",
                          "Each frame of a transmission is received; the last says that no other follows.",
                          standard("end delimiter"), {{"two_frames_only", "not_delivered"}}),
               {{},
                {joined(),
                 drive("data for the station, for 0004, for the station, and the token, in one transmission",
                       [](TokenScene& scene) { return train(scene, false); }),
                 two_delivered(), passes_on(), taken()}}),
      on_chart(
          token_must("line/frames_after_a_damaged_one_are_received", "TB-34",
                     "After a frame with a wrong check the next one of the same transmission is received.",
                     standard("end delimiter"), {{"stops_at_a_fault", "not_delivered"}}),
          {{},
           {joined(),
            drive("the same four frames, the second with a wrong check",
                  [](TokenScene& scene) { return train(scene, true); }),
            two_delivered(), counted("FCS errors", kFcsError, 1), passes_on(), taken()}}),
      on_chart(token_must("line/the_error_bit_is_counted_before_a_wrong_check", "TB-31",
                          "A frame with E = 1 counts as an E bit error, whatever its check is.",
                          mib("E bit errors"), {{"check_before_error_bit", "counter_wrong"}}),
               {{},
                {joined(),
                 drive("a token for the station with E = 1 and a wrong check", error_bit_and_wrong_check),
                 ignored("acts_on_error_bit", "a repeater has seen an error"),
                 counted("E bit errors", kEBitError, 1), counted("FCS errors", kFcsError, 0), serves()}}),
  };
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace fieldproof::conformance
