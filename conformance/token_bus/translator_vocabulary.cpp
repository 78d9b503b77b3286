#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// Every code that may be requested, in every place, by any clock, and whatever is received meanwhile.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::derived;
using token_sources::memory;
using token_sources::own;
using token_sources::paper;

// Symbols in both codes. What follows half a pair of non_data is silence: of a zero the page says nothing.
constexpr std::array<std::string_view, 12> kRequestWords{"0",  "1",  "P", "p", "NN", "Nn",
                                                         "nN", "nn", "S", "s", "NS", "ns"};

std::string every_three_words() {
  std::string symbols;
  for (const std::string_view one : kRequestWords) {
    for (const std::string_view two : kRequestWords) {
      for (const std::string_view three : kRequestWords) {
        symbols += one;
        symbols += two;
        symbols += three;
      }
    }
  }
  return symbols;
}

TranslatorStep requested_text(std::string text, std::function<std::string(TranslatorScene&)> symbols) {
  return does(std::move(text),
              [symbols = std::move(symbols)](TranslatorScene& scene) { scene.exchange(symbols(scene)); });
}

TranslatorStep goes_out(std::string reason) {
  return requires_that("exactly its bits go out, the first and the last of them in time",
                       [reason = std::move(reason)](TranslatorScene& scene) {
                         scene.expect_sent(encoded(scene.requested), reason);
                       });
}

// Long rows of the same, for whatever counts them.
std::vector<std::uint8_t> monotonous(unsigned round) {
  constexpr std::array<std::uint8_t, 4> kOctets{0x00, 0xFF, 0x55, 0x0F};
  constexpr std::size_t kLong = 1'000;
  return std::vector<std::uint8_t>(kLong, kOctets.at(round % kOctets.size()));
}

// 100 ppm slow, right, 100 ppm fast.
std::int64_t clock_of(unsigned round) {
  return 100 * (static_cast<int>(round % 3) - 1);
}

// A command in the middle of what is requested, and no silence around it.
std::string cut_by_command(TranslatorScene& scene) {
  constexpr std::string_view kLetters = "itld";
  constexpr std::array<std::string_view, 4> kBefore{"PPPPN", "PPPPNNN", "PPPP01", "PPPPNN"};
  const unsigned turn = scene.round;
  return std::string(kBefore.at(turn / 4 % 4)) + std::string(1 + turn % 3, kLetters[turn % 4]) +
         start_delimiter_text() + "0110";
}

}  // namespace

std::vector<TranslatorCase> translator_vocabulary_cases() {
  return {
      on_chart(translator_must("encoding/each_code_after_each", "",
                               "A symbol is two bits whatever stands in front of it and after it, a single "
                               "silence too, and whatever its third circuit is where that may be anything.",
                               paper("table 3, code of the symbols"),
                               {{"pad_idle_by_one_code", "bits_wrong"},
                                {"non_data_by_one_code", "bits_wrong"},
                                {"silence_by_one_code", "bits_wrong"},
                                {"single_silence_filled", "bits_wrong"}},
                               {{memory("codes of the symbols"), {"bits_wrong"}}}),
               {{1, 2},
                {requested_text("each three of all symbols, in both of their codes",
                                [](TranslatorScene&) { return every_three_words(); }),
                 goes_out("bits_wrong"), pause()},
                {on_line()}}),
      on_chart(translator_must("encoding/rows_of_the_same_go_out", "",
                               "Nothing is added to thousands of zeros or of ones: the code has an edge in "
                               "each bit.",
                               derived("code of the symbols"), {{"stuffs_after_64_zeros", "bits_wrong"}}),
               {{4, 12},
                {requested_text("a frame of 1000 equal octets",
                                [](TranslatorScene& scene) { return frame_text(monotonous(scene.round)); }),
                 goes_out("bits_wrong"), pause()},
                {on_line()}}),
      on_chart(translator_must("encoding/a_command_is_silence", "",
                               "A command ends what is sent: the half of a pair of non_data is forgotten, "
                               "and what is requested directly after it goes out from its first symbol on.",
                               own("nothing goes out in management mode"),
                               {{"non_data_pair_over_silence", "bits_wrong"},
                                {"first_symbol_after_a_command_lost", "bits_wrong"},
                                {"commands_are_sent", "bits_wrong"}}),
               {{16, 48},
                {requested_text("symbols, a command of one to three symbols, and a start delimiter",
                                cut_by_command),
                 goes_out("bits_wrong"), pause()},
                {on_line()}}),
      on_chart(translator_must("encoding/the_clock_of_the_mac_may_differ", "PST-18",
                               "A clock of the MAC 100 ppm away costs no symbol of the longest frame, and "
                               "its last one is as late as its first.",
                               memory("clock tolerance of IEEE 802.3"),
                               {{"sends_by_its_own_clock", "sent_too_late"}}),
               {{3, 9},
                {does("a frame of 8191 octets from a clock that is 100 ppm slow, right, 100 ppm fast",
                      [](TranslatorScene& scene) {
                        scene.bench.set_mac_clock(clock_of(scene.round));
                        scene.exchange(frame_text(scene.bench.random_octets(kLongestFrame)));
                      }),
                 goes_out("bits_wrong"), pause()},
                {on_line()}}),
      on_chart(translator_must("encoding/sends_whatever_it_receives", "",
                               "What is requested goes out while something is received, and what is received "
                               "is indicated while something goes out.",
                               paper("MACTX and MACRX"), {{"deaf_while_it_sends", "frame_lost"}}),
               {{4, 20},
                {does("a frame is requested while another one comes from the line",
                      [](TranslatorScene& scene) {
                        scene.exchange(std::string(7 * scene.round, 'S') + frame_text(scene.octets),
                                       side_bits_of(encoded(frame_text(monotonous(scene.round)))));
                      }),
                 goes_out("bits_wrong"),
                 requires_that("the other one is indicated",
                               [](TranslatorScene& scene) {
                                 const std::string frame = frame_text(monotonous(scene.round));
                                 scene.expect_content(frame.substr(frame.find('N')), "frame_lost");
                               }),
                 pause()},
                {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
