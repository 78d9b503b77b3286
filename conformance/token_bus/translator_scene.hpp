#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "conformance/chart.hpp"
#include "conformance/token_bus/translator_cases.hpp"

// The words of charts for a translator.
namespace fieldproof::conformance {

// What the steps of one round share.
struct TranslatorScene : Scene<TranslatorBench> {
  TranslatorScene(TranslatorBench& bench_, CaseJudge& judge_, unsigned round_);

  std::vector<std::uint8_t> octets;  // random, of the round's frame
  unsigned turn = 0;                 // of steps that are repeated
  std::string requested{};           // that was requested last
  kernel::Time begin{};              // of what was requested or received last

  void request(std::string symbols);
  void receive(std::string_view bits) { receive(side_bits_of(bits)); }
  void receive(const SideBits& bits);
  // Symbols and commands of the MAC, and bits of the line, both from now on, until all of it has come out. It
  // takes whole symbols, so that what comes next is in the same phase.
  void exchange(std::string script, SideBits bits = {});
  // What a command is answered with while it stands, its idle before that left out: "a", "ian".
  std::string answers_to(SideCommand command);
  // On line, as the MAC brings it there: `answer_wrong`; without an answer `precondition_not_met`.
  void bring_up();
  // So long a silence that no transmission has to do with the next one.
  void rest();

  // Exactly these bits, idle ones around them left out, and when they begin and end.
  void expect_sent(const std::string& bits, std::string_view reason);
  void expect_nothing_sent(std::string_view reason, std::string_view why);
  // From the first non_data on; in front of it zeros, ones and silence. Silence at the end is nothing.
  void expect_content(const std::string& symbols, std::string_view reason);
  void expect_nothing_indicated(std::string_view reason, std::string_view why);
  // What was indicated from the first non_data on.
  std::string content() const;
  // What was sent, and what was indicated, idle bits and silence around it left out.
  std::string sent() const;
  std::string indicated() const;
  // The same with the symbols of `right`, which begins with symbol `first` of what was exchanged, where a
  // command or its answer may hide them.
  std::string without_answers(std::string seen, const std::string& right, std::size_t first) const;
  // From the first non_data of `right` on, which begins with the first symbol that was exchanged.
  void expect_from_delimiter(const std::string& right, std::string_view reason);
  // One of these, silence around it left out.
  void expect_indicated(const std::vector<std::string>& right, std::string_view reason);
};

using TranslatorStep = ChartStep<TranslatorScene>;
// g++ 12 fails at a step in braces where it has not looked before at how one is made.
static_assert(std::is_default_constructible_v<TranslatorStep>);

inline TranslatorCase on_chart(TestCase test_case, Chart<TranslatorScene> chart, TranslatorNeeds needs = {}) {
  return charted<TranslatorCase>(std::move(test_case), std::move(chart), needs);
}

TestCase translator_must(const std::string& id, std::string purpose, std::string requirement,
                         judge::Reference reference, std::vector<MustCatch> catches,
                         std::vector<PartialSource> details = {});

namespace translator_chart {

// A jabber that is over soon, and longer than a counter of 16 bits.
inline constexpr unsigned kJabberSymbols = 66'000;
TranslatorNeeds with_short_jabber();

// RESET, DISABLE LOOPBACK, ENABLE TRANSMITTER, END PHYSICAL.
TranslatorStep on_line();
TranslatorStep pause();
// What one chart alone does, or requires.
TranslatorStep does(std::string text, std::function<void(TranslatorScene&)> run);
TranslatorStep requires_that(std::string text, std::function<void(TranslatorScene&)> run);
// A frame of random octets arrives and is indicated: `does_not_recover`.
TranslatorStep receives();

// One round of a walk, on line: signal errors after what is requested, and after what is not sent;
// RESET, or a failure of the supply, within the blanking; what moves the phase, or is left over silence.
void receives_errors(TranslatorScene& scene);
void begins_anew_within_blanking(TranslatorScene& scene);
void receives_in_a_phase(TranslatorScene& scene, bool is_over_silence);

}  // namespace translator_chart
}  // namespace fieldproof::conformance
