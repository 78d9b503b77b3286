#include "conformance/token_bus/translator_scene.hpp"

// What is requested goes out as the table of the paper says.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::derived;
using token_sources::paper;

std::string repeated_bits(std::size_t times) {
  std::string bits;
  for (std::size_t n = 0; n < times; ++n) bits += "10";
  return bits;
}

// All five kinds, in any order; non_data comes in pairs.
std::string random_symbols(TranslatorScene& scene) {
  std::string symbols = "P";
  while (symbols.size() < 64) {
    const std::uint8_t kind = scene.bench.random_octet() % 5;
    symbols += kind == 0 ? "SS" : kind == 1 ? "PP" : kind == 2 ? "0" : kind == 3 ? "1" : "NN";
  }
  return symbols + "1";
}

TranslatorStep request_of(std::string text, std::function<std::string(TranslatorScene&)> symbols) {
  return does(std::move(text),
              [symbols = std::move(symbols)](TranslatorScene& scene) { scene.request(symbols(scene)); });
}

TranslatorStep is_encoded(std::string reason) {
  return requires_that("each symbol goes out as its two bits, and nothing else does",
                       [reason = std::move(reason)](TranslatorScene& scene) {
                         scene.expect_sent(encoded(scene.requested), reason);
                       });
}

void expect_first_bits(TranslatorScene& scene) {
  scene.bench.settle();
  const std::string sent = scene.sent();
  scene.judge.expect(sent.substr(0, 66) == repeated_bits(32) + "11", "preamble_is_no_sfd",
                     "32 times 10, and 11", sent.substr(0, 66));
}

}  // namespace

std::vector<TranslatorCase> translator_encoding_cases() {
  return {
      on_chart(translator_must("encoding/each_symbol_is_two_bits", "PST-01",
                               "silence is IDL,IDL, pad_idle and one are CD1,CD0, zero is CD0,CD1, and two "
                               "non_data are CD1,CD1 and CD0,CD0.",
                               paper("table 3, code of the symbols"),
                               {{"non_data_pair_swapped", "bits_wrong"},
                                {"zero_and_one_exchanged", "bits_wrong"},
                                {"non_data_without_edges", "bits_wrong"},
                                {"slow_transmitter", "sent_too_late"}}),
               {{10, 200},
                {request_of("symbols of all five kinds at random", random_symbols), is_encoded("bits_wrong"),
                 pause()},
                {on_line()}}),
      on_chart(translator_must("encoding/preamble_and_start_delimiter_are_an_sfd", "PST-02",
                               "Four octets of pad_idle and the first non_data are one spare pair, the "
                               "preamble of IEEE 802.3 and its start of frame delimiter.",
                               derived("preamble and SFD"),
                               {{"pad_idle_as_zero", "preamble_is_no_sfd"},
                                {"non_data_pair_swapped", "preamble_is_no_sfd"},
                                {"first_symbol_lost", "preamble_is_no_sfd"}}),
               {{3, 30},
                {request_of("a frame with four octets of preamble",
                            [](TranslatorScene& scene) { return frame_text(scene.octets); }),
                 requires_that("the first 66 bits are (10) x 32 and 11", expect_first_bits), pause()},
                {on_line()}}),
      on_chart(
          translator_must("encoding/a_frame_goes_out_whole", "",
                          "A token from 000A to 0004 is 240 bits: the sample of this project's notes.",
                          derived("code of the symbols, frame check"), {{"first_symbol_lost", "bits_wrong"}}),
          {{2, 10},
           {request_of("a token from 000A to 0004",
                       [](TranslatorScene&) {
                         return frame_text({0x10, 0x04, 0x00, 0x0A, 0x00, 0x42, 0x1F, 0x4F, 0xD3});
                       }),
            is_encoded("bits_wrong"), pause()},
           {on_line()}}),
      on_chart(
          translator_must("encoding/a_cut_transmission_leaves_nothing_behind", "",
                          "What was requested before silence changes nothing after it: also where the "
                          "second non_data of a pair was missing.",
                          derived("non_data in pairs"), {{"non_data_pair_over_silence", "bits_wrong"}}),
          {{3, 30},
           {request_of("pad_idle, and one non_data", [](TranslatorScene&) { return "PPPPPPPPN"; }), pause(),
            request_of("a start delimiter without a preamble",
                       [](TranslatorScene&) { return start_delimiter_text(); }),
            is_encoded("bits_wrong"), pause()},
           {on_line()}}),
      on_chart(translator_must("encoding/the_longest_frame_goes_out", "",
                               "A frame of 8191 octets goes out whole: no watchdog of the transmitter ends "
                               "it.",
                               paper("8191 octets between the delimiters at most"),
                               {{"jabber_of_10_ms", "bits_wrong"}}),
               {{1, 3},
                {request_of("a frame of 8191 octets",
                            [](TranslatorScene& scene) {
                              return frame_text(scene.bench.random_octets(kLongestFrame));
                            }),
                 is_encoded("bits_wrong"), pause()},
                {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
