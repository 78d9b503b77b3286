#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// Where an end delimiter and the blanking after it end, to the symbol.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::memory;
using token_sources::own;
using token_sources::standard;

constexpr unsigned kAfterwards = 60;  // symbols, longer than any blanking

std::string begin_of(TranslatorScene& scene) {
  const std::string frame = frame_text(scene.octets);
  return frame.substr(0, frame.size() - end_delimiter_text().size());
}
std::string many_ones() {
  return std::string(kAfterwards, '1');
}
std::string after_blanking(TranslatorScene& scene, std::string what) {
  std::string seen = std::move(what);
  seen.replace(0, scene.bench.configuration().rules.blanking_symbols,
               std::string(scene.bench.configuration().rules.blanking_symbols, 'S'));
  return seen;
}

// ---- end delimiters ----

// I = 0 and E in turn, alone, after five others, or without an octet; then ones without a pause.
void receive_last_frame(TranslatorScene& scene) {
  const std::string last = scene.round % 2 == 0 ? "NN1NN100" : "NN1NN101";
  std::string more;
  for (unsigned n = 0; n < 5 && scene.round / 2 % 3 == 1; ++n) more += frame_text(scene.octets, true);
  const std::string begin =
      scene.round / 2 % 3 == 2 ? std::string(16, '1') + start_delimiter_text() : begin_of(scene);
  const std::string frame = indicated_as(more + begin) + last;
  scene.exchange("", side_bits_of(encoded(frame + many_ones())));
  scene.expect_from_delimiter(frame + after_blanking(scene, many_ones()), "blanking_wrong");
}

// The same while it is the translator's own frame that comes back.
void receive_own_frame(TranslatorScene& scene) {
  const std::string frame = frame_text(scene.octets);
  scene.exchange(frame, side_bits_of(encoded(frame + many_ones())));
  scene.expect_from_delimiter(frame + after_blanking(scene, many_ones()), "blanking_wrong");
}

// One symbol of an end delimiter is another one; silence in the middle of it is one symbol.
constexpr std::array<std::string_view, 13> kNoEnds{
    "11NN100",  "1BNN100",  "NN0NN100", "NN1NN110", "NN1NN111",  "NN101100", "NN1BB100",
    "NN1NN000", "NN1NN1B0", "NN1NN1NN", "0NN100",   "NNSNN1100", "NN1SNN100"};

void receive_no_end(TranslatorScene& scene) {
  const std::string text = begin_of(scene) + std::string(kNoEnds.at(scene.round % kNoEnds.size()));
  scene.exchange("", side_bits_of(encoded(text + many_ones())));
  scene.expect_from_delimiter(text + many_ones(), "blanked_without_an_end");
}

// ---- within the blanking ----

struct Within {
  std::string symbols;  // from the end delimiter on
  std::size_t error_from = 0;
  std::size_t error_until = 0;
  std::string_view managed{};  // by this so many symbols after it
};
const std::vector<Within>& withins() {
  static const std::vector<Within> rows{{"1111BBBB" + many_ones()},     {many_ones(), 4, 20},
                                        {"SSSS" + many_ones()},         {many_ones(), 0, 0, "i"},
                                        {many_ones(), 0, 0, "ld"},      {"SSSSNN0NN000" + many_ones()},
                                        {many_ones() + "000000" + "11"}};
  return rows;
}

void receive_within(TranslatorScene& scene) {
  const Within& row = withins().at(scene.round % withins().size());
  const std::string frame = frame_text(scene.octets);
  SideBits bits = side_bits_of(encoded(frame + row.symbols));
  for (std::size_t n = row.error_from; n < row.error_until; ++n)
    bits.at(2 * frame.size() + n).has_error = true;
  const std::string script = row.managed.empty() ? "" : std::string(frame.size() + 2, 'S');
  scene.exchange(script + std::string(row.managed), bits);
  scene.expect_from_delimiter(frame + after_blanking(scene, row.symbols), "blanking_wrong");
}

// The phase is found while nothing is indicated.
void receive_other_phase_within(TranslatorScene& scene) {
  const std::string frame = frame_text(scene.octets);
  scene.exchange(
      "", side_bits_of(encoded(frame) + "II" + (scene.round % 2 == 0 ? "0" : "I") + encoded(many_ones())));
  std::string seen = scene.content();
  seen.erase(0, frame.size() - frame.find('N'));
  scene.judge.expect(seen.find_first_not_of("S1") == std::string::npos && seen.ends_with("1111"),
                     "phase_lost_in_blanking", "silence, and ones", seen);
}

}  // namespace

namespace translator_chart {

// RESET, or a failure of the supply, in the blanking; then ones, long before it would be over.
void begins_anew_within_blanking(TranslatorScene& scene) {
  constexpr unsigned kLongest = 8;
  if (scene.round % 2 == 1 && scene.bench.configuration().delay_symbols > kLongest) return;
  scene.exchange("rrrrllll");
  scene.rest();
  const std::string frame = frame_text(scene.octets);
  scene.bench.request_and_receive(
      scene.round % 2 == 0 ? std::string(frame.size() + 1, 'S') + "rlS" : std::string(frame.size() + 1, 'S'),
      side_bits_of(encoded(frame)));
  if (scene.round % 2 == 1) {
    // The supply fails when all of the frame has come out.
    scene.bench.wait(scene.bench.delay());
    scene.bench.set_power(false);
    scene.bench.wait(scene.bench.symbols(1));
    scene.bench.set_power(true);
    scene.bench.request("l");
  }
  scene.bench.clear();
  scene.exchange("", side_bits_of(encoded(std::string(kAfterwards, '1'))));
  // Of the other phase, and of answers that are still to come.
  constexpr std::size_t kMostHidden = 10;
  const std::string seen = scene.indicated();
  const auto shown = static_cast<std::size_t>(std::ranges::count(seen, '1'));
  scene.judge.expect(shown + kMostHidden >= kAfterwards, "still_blanked", fmt::format("{} ones", kAfterwards),
                     seen);
  scene.bring_up();
}

}  // namespace translator_chart

std::vector<TranslatorCase> translator_end_cases() {
  const auto within = static_cast<unsigned>(withins().size());
  constexpr auto kEnds = static_cast<unsigned>(kNoEnds.size());
  return {
      on_chart(
          translator_must("blanking/lasts_its_symbols", "PST-11",
                          "The symbols that begin within blanking_symbols of an end delimiter with I = 0 are "
                          "silence, those after them are indicated; whatever E is, whoever has sent it.",
                          memory("blanking follows the end of a transmission"),
                          {{"blanking_of_27_symbols", "blanking_wrong"},
                           {"blanking_of_29_symbols", "blanking_wrong"},
                           {"no_blanking_after_an_error", "blanking_wrong"},
                           {"blanks_while_carrier", "blanking_wrong"}}),
          {{6, 60},
           {{"a frame with E = 0 and 1 in turn, alone, after five others, and without an octet, and 60 ones "
             "at "
             "once",
             "blanking_symbols of silence, and ones", receive_last_frame},
            pause(),
            {"a frame that is requested comes from the line, and 60 ones at once",
             "blanking_symbols of silence, and ones", receive_own_frame},
            pause()},
           {on_line()}}),
      on_chart(translator_must("blanking/follows_nothing_but_an_end", "PST-12",
                               "Where one symbol of an end delimiter is another one, or silence is in it, "
                               "nothing is blanked.",
                               standard("end delimiter N N 1 N N 1 I E"),
                               {{"short_end_delimiter", "blanked_without_an_end"},
                                {"end_delimiter_over_silence", "blanked_without_an_end"},
                                {"blanks_after_every_frame", "blanked_without_an_end"}}),
               {{kEnds, 3 * kEnds},
                {{"a frame with an end delimiter that is none, and 60 ones", "all of it", receive_no_end},
                 pause()},
                {on_line()}}),
      on_chart(translator_must(
                   "blanking/nothing_ends_it_early", "PST-11",
                   "bad_signal, a signal error, a start delimiter, silence and commands other than "
                   "RESET change nothing in the blanking, and it changes nothing but what is indicated.",
                   own("blanking of indications"),
                   {{"bad_signal_within_blanking", "blanking_wrong"},
                    {"command_ends_blanking", "blanking_wrong"},
                    {"blanking_ends_with_silence", "phase_lost_in_blanking"}}),
               {{within, 3 * within},
                {{"a frame, and symbols of all kinds in the blanking", "silence, and what is left of them",
                  receive_within},
                 pause(),
                 {"a frame, and ones in the other phase in the blanking", "silence, and ones",
                  receive_other_phase_within},
                 pause()},
                {on_line()}}),
      on_chart(
          translator_must("blanking/ends_with_reset_and_supply", "PST-11",
                          "RESET clears the blanking, and so does a failure of the supply.",
                          own("what the commands do"), {{"blanking_outlives_reset", "still_blanked"}}),
          {{4, 20},
           {{"a frame, then in the blanking RESET or a failure of the supply, DISABLE LOOPBACK, and ones",
             "the ones", begins_anew_within_blanking},
            pause()},
           {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
