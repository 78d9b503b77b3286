#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// Each symbol after each: what is received in a transmission whose phase is sure.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::derived;
using token_sources::own;

std::string locked() {
  return "PPPPPPPPPPPPPPPP" + start_delimiter_text();
}

// ---- pairs of non_data ----

// A first non_data, a pair in the place of the second, and CD0,CD0 after it.
struct AfterPair {
  std::string_view pair;
  char due;
};
constexpr std::array<AfterPair, 8> kAfterPairs{
    {{"10", 'B'}, {"01", 'B'}, {"11", 'B'}, {"00", 'N'}, {"II", 'S'}, {"I1", 'S'}, {"1I", 'B'}, {"0I", 'B'}}};

void receive_after_pair(TranslatorScene& scene) {
  const AfterPair& row = kAfterPairs.at(scene.round / 3 % kAfterPairs.size());
  const unsigned error = scene.round % 3;  // in the first or second bit of the pair
  const std::string begin = locked() + "0110N";
  SideBits bits = side_bits_of(encoded(begin));
  for (unsigned n = 0; n < 2; ++n) bits.push_back({row.pair[n], true, error == n + 1});
  const std::string rest = "BB11NN0110";
  for (const SideBit& one : side_bits_of(encoded(rest))) bits.push_back(one);
  scene.exchange("", bits);
  scene.expect_from_delimiter(begin + std::string(1, error != 0 ? 'B' : row.due) + rest, "cell_wrong");
}

void lose_carrier_within_pair(TranslatorScene& scene) {
  const std::string begin = locked() + "0110";
  SideBits bits = side_bits_of(encoded(begin));
  const std::string pair = encoded(scene.round % 3 == 0 ? "0" : scene.round % 3 == 1 ? "1" : "N");
  bits.push_back({pair[0], true, false});
  bits.push_back({pair[1], false, false});
  scene.exchange("", bits);
  const std::string seen = scene.content();
  const std::string right = begin.substr(begin.find('N'));
  scene.judge.expect(seen == right || seen == right + "B", "carrier_not_looked_at",
                     [&] { return difference(right, seen); });
}

// Each four of them; bad_signal after each four, so that none of them is an end delimiter.
std::string every_four_words() {
  constexpr std::array<std::string_view, 5> kWords{"0", "1", "NN", "B", "NNNN"};
  std::string symbols;
  for (unsigned n = 0; n < 625; ++n) {
    for (unsigned word = 0, left = n; word < 4; ++word, left /= 5) symbols += kWords.at(left % 5);
    symbols += "BB";
  }
  return symbols;
}

void receive_every_four(TranslatorScene& scene) {
  const std::string text = locked() + every_four_words();
  scene.exchange("", side_bits_of(encoded(text)));
  scene.expect_from_delimiter(text, "symbols_wrong");
}

// One to three bits, and half a pair, after an end delimiter with I = 1.
void receive_half_after_more(TranslatorScene& scene) {
  const std::string frame = frame_text(scene.octets, true) + std::string(scene.round / 2 % 3, '1');
  scene.exchange("", side_bits_of(encoded(frame) + (scene.round % 2 == 0 ? "1I" : "0I")));
  scene.expect_from_delimiter(frame + "B", "cell_wrong");
}

}  // namespace

std::vector<TranslatorCase> translator_pair_cases() {
  return {
      on_chart(
          translator_must("decoding/each_symbol_after_each", "",
                          "What a pair of bits is does not depend on what was in front of it, but for half a "
                          "pair of non_data.",
                          derived("code of the symbols"), {{"third_pair_is_bad_signal", "symbols_wrong"}}),
          {{1, 2},
           {{"each four of zero, one, bad_signal, and one and two pairs of non_data", "each of them",
             receive_every_four},
            pause()},
           {on_line()}}),
      on_chart(
          translator_must(
              "decoding/half_a_pair_after_more", "PST-05",
              "After an end delimiter with I = 1 a pair whose second bit is missing is bad_signal.",
              own("table of decoding"), {{"cut_pair_is_silence", "cell_wrong"}}),
          {{6, 30},
           {{"a frame with I = 1, up to two ones, and one bit", "bad_signal for it", receive_half_after_more},
            pause()},
           {on_line()}}),
      on_chart(translator_must("decoding/a_pair_of_non_data_is_two_symbols", "PST-07",
                               "The second non_data is due in the symbol after the first, and in no other, "
                               "whatever comes in its place.",
                               derived("non_data in pairs"), {{"due_until_it_comes", "cell_wrong"}}),
               {{24, 72},
                {{"one non_data, each pair of bits, without and with a signal error, and CD0,CD0",
                  "its symbol, and bad_signal", receive_after_pair},
                 pause()},
                {on_line()}}),
      on_chart(
          translator_must("decoding/a_carrier_lost_within_a_pair", "PST-09",
                          "A pair whose second bit has no carrier is silence or bad_signal, and no data.",
                          own("table of decoding"), {{"carrier_ignored", "carrier_not_looked_at"}}),
          {{3, 30},
           {{"a frame that ends with half a symbol, and the other half without carrier", "no symbol of it",
             lose_carrier_within_pair},
            pause()},
           {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
