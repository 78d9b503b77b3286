#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// The phase, symbol by symbol: how many zeros move it, what holds it, and what a silence leaves of it.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::derived;
using token_sources::own;
using token_sources::paper;

// What comes from the line, and what is indicated of it up to the start delimiter that follows at once.
struct PhaseRow {
  std::string_view text;
  std::string bits;
  std::string indicated;
};

std::string preamble_bits(unsigned symbols) {
  return encoded(std::string(symbols, 'P'));
}
std::string ones(unsigned symbols) {
  return std::string(symbols, '1');
}
std::string alternating(unsigned times) {
  std::string symbols;
  for (unsigned n = 0; n < times; ++n) symbols += "01";
  return symbols;
}

// "0" is 01, "1" is 10; one bit more in front of a preamble is what a slip drops.
const std::vector<PhaseRow>& hunting_rows() {
  static const std::string slipped = "0" + preamble_bits(16);
  static const std::vector<PhaseRow> rows{
      {"two ones, and six zeros", encoded("11000000"), "11000000"},
      {"a one, two zeros, and a bit", encoded("100") + slipped, "100" + ones(16)},
      {"bad_signal, two zeros, and a bit", encoded("B00") + slipped, "B00" + ones(16)},
      {"two bad_signals, two zeros, and a bit", encoded("BB00") + slipped, "BB00" + ones(16)},
      {"a signal error, two zeros, and a bit", "x0" + encoded("00") + slipped, "B00" + ones(16)},
      {"a zero, a signal error, two zeros, and a bit", encoded("0") + "x0" + encoded("00") + slipped,
       "0B00" + ones(16)},
      {"a one, bad_signal, a one, two zeros, and a bit", encoded("1B100") + slipped, "1B100" + ones(16)},
      {"one zero", encoded("0") + preamble_bits(16), "0" + ones(16)},
      {"a zero, a bad_signal and a zero", encoded("0B01") + preamble_bits(4), "0B01" + ones(4)},
      {"zeros and ones in turn", encoded(alternating(4)) + preamble_bits(4), alternating(4) + ones(4)},
      {"zeros and ones in turn for a long time", encoded(alternating(40)) + encoded("00") + slipped,
       alternating(40) + "00" + ones(16)},
      {"two zeros and a bit, twice", encoded("00") + "0" + encoded("00") + slipped, "0000" + ones(16)},
      {"two zeros and a bit, seven times",
       encoded("00") + "0" + encoded("00") + "0" + encoded("00") + "0" + encoded("00") + "0" + encoded("00") +
           "0" + encoded("00") + "0" + encoded("00") + slipped,
       "00000000000000" + ones(16)},
      {"two zeros, a bit, and another zero", encoded("00") + "0" + encoded("0") + preamble_bits(4),
       "000" + ones(4)},
      {"two non_data, and six zeros", encoded("NN000000"), "NN000000"},
      {"one non_data, and zeros", encoded("N00000"), "NB0000"},
      {"two zeros, a bit, two ones, and six zeros", encoded("00") + "0" + encoded("11000000"), "0011000000"},
      {"an end delimiter with I = 1, and six zeros", encoded("11" + end_delimiter_text(true) + "000000"),
       "11" + end_delimiter_text(true) + "000000"},
      {"a bad_signal within data, and six zeros", encoded("11NN0B000000"), "11NN0B000000"},
  };
  return rows;
}

constexpr std::array<unsigned, 4> kSilences{1, 2, 4, 20};  // symbols

struct Remainder {
  std::string_view text;
  std::string_view before;  // symbols in front of the silence
  std::string bits;         // after it
  std::string indicated;
};
const std::vector<Remainder>& remainders() {
  static const std::string slips = encoded("00") + "0" + preamble_bits(16);
  static const std::vector<Remainder> rows{
      {"a zero; a zero", "0", encoded("0") + preamble_bits(16), "0" + ones(16)},
      {"a one; a one and two zeros", "1", encoded("100") + "0" + preamble_bits(16), "100" + ones(16)},
      {"ones; two zeros", "1111", slips, "00" + ones(16)},
      {"a start delimiter; two zeros", "11NN0NN000", slips, "00" + ones(16)},
      {"bad_signal; two zeros", "11NNB", slips, "00" + ones(16)},
      {"half a pair of non_data; its other half", "11N", encoded("B") + preamble_bits(4), "B" + ones(4)},
      {"half an end delimiter; its other half", "1111NN1", encoded("NN100") + preamble_bits(4),
       "NN100" + ones(4)},
  };
  return rows;
}

// A transmission may begin with its first bit, or with the second one of a pair: of three, two in the same
// phase and one in the other, a translator reads one or more from the first bit on.
void expect_once_of_three(TranslatorScene& scene, const SideBits& bits, const std::string& right,
                          std::string_view reason) {
  std::string seen;
  for (unsigned n = 0; n < 3; ++n) {
    SideBits later(n == 2 ? 1 : 2, SideBit{'I', false, false});
    later.insert(later.end(), bits.begin(), bits.end());
    scene.exchange("", later);
    seen = scene.indicated();
    if (seen == right) return;
    scene.rest();
  }
  scene.judge.expect(false, reason, [&] { return difference(right, seen); });
}

// A bit x is one with a signal error.
SideBits with_frame(const std::string& bits, TranslatorScene& scene) {
  SideBits made = side_bits_of(bits + encoded(frame_text(scene.octets, false, 0)));
  for (SideBit& one : made)
    if (one.symbol == 'x') one = {'1', true, true};
  return made;
}
std::string frame_after(const std::string& symbols, TranslatorScene& scene) {
  return symbols + frame_text(scene.octets, false, 0);
}

void receive_hunting(TranslatorScene& scene) {
  const PhaseRow& row = hunting_rows().at(scene.round % hunting_rows().size());
  expect_once_of_three(scene, with_frame(row.bits, scene), frame_after(row.indicated, scene), "phase_wrong");
}

void receive_remainder(TranslatorScene& scene) {
  const Remainder& row = remainders().at(scene.round / 2 / kSilences.size() % remainders().size());
  const unsigned silence = kSilences.at(scene.round / 2 % kSilences.size());
  SideBits bits = side_bits_of(encoded(row.before));
  bits.insert(bits.end(), 2 * std::size_t{silence}, SideBit{'I', scene.round % 2 == 1, false});
  const SideBits after = with_frame(row.bits, scene);
  bits.insert(bits.end(), after.begin(), after.end());
  expect_once_of_three(
      scene, bits, frame_after(std::string(row.before) + std::string(silence, 'S') + row.indicated, scene),
      "remembers_over_silence");
}

// A slip that is due when the line falls silent.
void receive_after_due_slip(TranslatorScene& scene) {
  std::string seen;
  for (unsigned n = 0; n < 2; ++n) {
    scene.exchange("", side_bits_of("0101"));
    scene.bench.wait(scene.bench.symbols(200) + scene.bench.symbols(1) / 2 * n);
    scene.exchange("", with_frame(preamble_bits(16), scene));
    seen = scene.indicated();
    if (seen == frame_after(ones(16), scene)) return;
    scene.bench.wait(scene.bench.symbols(200) - scene.bench.symbols(1) / 2 * n);
  }
  scene.judge.expect(false, "remembers_over_silence",
                     [&] { return difference(frame_after(ones(16), scene), seen); });
}

// In either phase the preamble arrives whole: ones, or two zeros, the bit that is dropped, and ones.
void expect_preamble(TranslatorScene& scene, unsigned symbols, bool has_lost_a_bit) {
  const std::string in_phase = ones(has_lost_a_bit ? symbols - 1 : symbols);
  scene.expect_indicated({frame_after(in_phase, scene), frame_after("00" + ones(symbols - 3), scene)},
                         "phase_wrong");
  const kernel::Time seen = scene.bench.indicated().time_of(scene.bench.indicated().text().find('N'));
  const kernel::Time due =
      scene.begin + scene.bench.symbols(2 * symbols - (has_lost_a_bit ? 1 : 0)) / 2 + scene.bench.delay();
  scene.judge.expect(seen <= due + kernel::kNanosecond, "indicated_too_late", kernel::describe(due),
                     kernel::describe(seen));
}

void receive_preamble(TranslatorScene& scene) {
  const unsigned symbols = 20 + scene.round / 2;
  const bool has_lost_a_bit = scene.round % 2 == 1;
  scene.exchange("", with_frame(preamble_bits(symbols).substr(has_lost_a_bit ? 1 : 0), scene));
  expect_preamble(scene, symbols, has_lost_a_bit);
}

}  // namespace

void translator_chart::receives_in_a_phase(TranslatorScene& scene, bool is_over_silence) {
  is_over_silence ? receive_remainder(scene) : receive_hunting(scene);
}

std::vector<TranslatorCase> translator_phase_cases() {
  const auto hunting = static_cast<unsigned>(hunting_rows().size());
  const auto remainder = static_cast<unsigned>(2 * kSilences.size() * remainders().size());
  return {
      on_chart(
          translator_must("locking/a_preamble_arrives_whole", "PST-03",
                          "In front of a start delimiter a preamble is ones; in the other phase two "
                          "zeros, a pause of one bit, and ones: as long as it was on the line, and in time.",
                          paper("the clock slips until the preamble reads as ones"),
                          {{"never_slips", "phase_wrong"},
                           {"slips_after_one_zero", "phase_wrong"},
                           {"slips_after_three_zeros", "phase_wrong"},
                           {"silent_until_it_is_locked", "phase_wrong"},
                           {"slow_receiver", "indicated_too_late"}},
                          {{own("two zeros are enough"), {"phase_wrong"}}}),
          {{8, 80},
           {{"a frame, and every other one without its first bit",
             "the whole preamble in one of the two phases, and the frame", receive_preamble},
            pause()},
           {on_line()}}),
      on_chart(translator_must("locking/what_moves_and_what_holds_the_phase", "PST-06",
                               "Two zeros in a row move it by one bit, again and again, until there are two "
                               "ones in a row or a non_data; then nothing does until the line is silent.",
                               own("two zeros are enough, two ones a lock"),
                               {{"slips_after_one_zero", "phase_wrong"},
                                {"slips_after_three_zeros", "phase_wrong"},
                                {"locked_by_one_one", "phase_wrong"},
                                {"ones_lock_nothing", "phase_wrong"},
                                {"non_data_lock_nothing", "phase_wrong"},
                                {"bad_signal_locks", "phase_wrong"},
                                {"zeros_need_not_be_in_a_row", "phase_wrong"},
                                {"slips_once_in_a_transmission", "phase_wrong"},
                                {"hunts_for_16_symbols", "phase_wrong"},
                                {"end_delimiter_unlocks", "phase_wrong"}}),
               {{hunting, 2 * hunting},
                {{"a transmission that begins otherwise than with a preamble, and a start delimiter",
                  "each symbol of it, and the frame", receive_hunting},
                 pause()},
                {on_line()}}),
      on_chart(
          translator_must(
              "locking/a_silence_leaves_nothing", "PST-06",
              "After one symbol of silence or more, with and without carrier, nothing is "
              "known of what was before it: no zero, no one, no lock, no half of a pair or of a delimiter.",
              derived("a transmission begins anew"),
              {{"zeros_outlive_silence", "remembers_over_silence"},
               {"ones_outlive_silence", "remembers_over_silence"},
               {"lock_outlives_short_silence", "remembers_over_silence"}}),
          {{remainder, 2 * remainder},
           {{"a fragment, silence of 1 to 20 symbols, and a frame after symbols that tell",
             "each symbol of the table", receive_remainder},
            {"two zeros, a long silence, and a frame", "all of it, from its first bit on",
             receive_after_due_slip},
            pause()},
           {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
