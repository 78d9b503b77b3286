#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// Which signal errors are the test of a transceiver, to the bit: from the end of an own transmission on, as
// long as the setting says.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_bus::TranslatorConfiguration;
using token_sources::own;

// What is requested, and the span of errors on the line, from the end of the transmission, which is at symbol
// kLast of the request and may go out later by the delay.
struct MaskRow {
  std::string_view text;
  std::string script;
  bool is_from_the_middle;
  std::size_t every = 1;  // bits from one error to the next
  std::size_t first = 0;  // bits that come before the first one
};
constexpr std::size_t kLast = 40;
constexpr std::size_t kLead = 16;  // symbols, the preamble and start delimiter of what is received

std::string sent(std::size_t symbols) {
  return std::string(symbols, 'P');
}
const std::vector<MaskRow>& mask_rows() {
  static const std::vector<MaskRow> rows{
      {"after it", sent(kLast), false},
      {"from its middle on", sent(kLast), true},
      {"after it, where a command has cut it", sent(kLast) + "iPP", false},
      {"after it, with a command in the mask", sent(kLast) + "SSi", false},
      {"throughout two transmissions, the second of which begins in the mask of the first",
       sent(kLast) + "SSSSS" + sent(kLast), true},
      {"after a transmission of one symbol", std::string(kLast - 1, 'S') + "P", false},
      {"in the first bit of each symbol after it", sent(kLast), false, 2},
      {"in the second bit of each symbol after it", sent(kLast), false, 2, 1},
      {"after it, where a command ends it", sent(kLast) + "i", false}};
  return rows;
}

std::string lead() {
  return "PPPPPPPP" + start_delimiter_text();
}

// Ones, and errors in them.
SideBits with_errors(TranslatorScene& scene, const MaskRow& row) {
  const TranslatorConfiguration& one = scene.bench.configuration();
  const std::size_t begin = row.is_from_the_middle ? kLast / 2 : kLast + one.delay_symbols;
  const std::size_t end = row.script.size() + one.delay_symbols + one.error_mask_symbols + kLead;
  SideBits bits = side_bits_of(encoded(lead() + std::string(end - kLead, '1')));
  for (std::size_t n = 2 * begin + row.first; n < bits.size() - 2 * std::size_t{4}; n += row.every)
    bits[n].has_error = true;
  return bits;
}

// Whether an own transmission has ended so lately, and none is under way: 'S', 'B', or '?' at a border.
char error_at(const TranslatorScene& scene, kernel::Time at) {
  const kernel::Duration bit = scene.bench.symbols(1) / 2;
  const kernel::Duration mask = scene.bench.symbols(scene.bench.configuration().error_mask_symbols);
  const SideLog& sent = scene.bench.sent();
  const auto seen_at = [&](kernel::Time time) {
    if (sent.was_driven(time - bit + 2 * kernel::kNanosecond, time + 2 * kernel::kNanosecond)) return 'B';
    return sent.was_driven(time - bit - mask + 2 * kernel::kNanosecond, time) ? 'S' : 'B';
  };
  const char first = seen_at(at);
  const bool is_sure = first == seen_at(at + bit / 2) && first == seen_at(at - bit / 2);
  // A translator whose transmissions lie on the grid of the line leaves nothing open.
  const bool is_aligned = !sent.empty() && (sent.begin() - scene.begin) % bit < 2 * kernel::kNanosecond;
  return is_sure || is_aligned || sent.empty() ? first : '?';
}

void expect_masked(TranslatorScene& scene, const SideBits& bits, std::string_view reason) {
  std::string right = indicated_as(lead());
  const kernel::Duration bit = scene.bench.symbols(1) / 2;
  for (std::size_t symbol = right.size(); 2 * symbol < bits.size(); ++symbol) {
    char indicated = '1';
    for (std::size_t n = 2 * symbol; n < 2 * symbol + 2; ++n) {
      if (!bits[n].has_error) continue;
      const char error = error_at(scene, scene.begin + bit * static_cast<std::int64_t>(n));
      if (error != 'S' && indicated != 'B') indicated = error;
    }
    right += indicated;
  }
  right = right.substr(right.find('N'));
  std::string seen = scene.without_answers(scene.content(), right, 8);
  for (std::size_t n = 0; n < std::min(seen.size(), right.size()); ++n)
    if (right[n] == '?') seen[n] = right[n];
  scene.judge.expect(seen == right, reason, [&] { return difference(right, seen); });
}

void receive_errors(TranslatorScene& scene) {
  const MaskRow& row = mask_rows().at(scene.round % mask_rows().size());
  const SideBits bits = with_errors(scene, row);
  scene.exchange(row.script, bits);
  scene.judge.expect(!scene.sent().empty(), "nothing_sent", "a preamble", "nothing");
  expect_masked(scene, bits, "mask_wrong");
}

// A frame of someone else, or nothing but a request with the transmitter off, in front of the errors.
void receive_errors_without_own(TranslatorScene& scene) {
  scene.exchange(scene.round % 2 == 0 ? "rrrrllllSSSS" : "rrrrllllttttSSSS");
  scene.rest();
  const SideBits bits = with_errors(scene, mask_rows().front());
  scene.exchange(scene.round % 2 == 0 ? sent(kLast) : "", bits);
  expect_masked(scene, bits, "masked_without_transmission");
  scene.rest();
  // In silence after a fragment.
  SideBits after = side_bits_of(encoded(lead()) + "IIII");
  after.insert(after.end(), 8, SideBit{'I', true, true});
  scene.exchange("", after);
  const std::string seen = scene.content();
  scene.judge.expect(seen.starts_with(start_delimiter_text() + "S") && seen.find("BBB") != std::string::npos,
                     "masked_without_transmission", "the fragment, silence, and bad_signal", seen);
  scene.bring_up();
}

}  // namespace

namespace translator_chart {

void receives_errors(TranslatorScene& scene) {
  const auto rows = static_cast<unsigned>(mask_rows().size());
  scene.round < rows ? receive_errors(scene) : receive_errors_without_own(scene);
}

}  // namespace translator_chart

namespace {

template <unsigned symbols>
TranslatorNeeds with_mask() {
  return {.adjust = [](TranslatorConfiguration& one) { one.error_mask_symbols = symbols; }};
}

TranslatorCase to_the_bit(const std::string& id, const std::string& setting, std::vector<MustCatch> catches,
                          TranslatorNeeds needs = {}) {
  const auto rows = static_cast<unsigned>(mask_rows().size());
  return on_chart(
      translator_must(
          "blanking/" + id, "PST-15",
          fmt::format("A signal error that begins within error_mask_symbols{} of the end of an own "
                      "transmission is none, and its bit is what it is; one that begins later, or within a "
                      "transmission, is bad_signal.",
                      setting),
          own("signal errors are masked for 4 us"), std::move(catches)),
      {{rows, 3 * rows},
       {{"a preamble is requested, and ones come from the line, with signal errors after it: at once, from "
         "its "
         "middle on, after a command",
         "ones where an error is masked, bad_signal where none is", receive_errors},
        pause()},
       {on_line()}},
      needs);
}

}  // namespace

std::vector<TranslatorCase> translator_mask_cases() {
  return {
      to_the_bit("the_mask_lasts_its_symbols", "",
                 {{"mask_of_one_symbol_less", "mask_wrong"},
                  {"mask_of_one_symbol_more", "mask_wrong"},
                  {"mask_has_its_end", "mask_wrong"},
                  {"masked_for_ever", "mask_wrong"},
                  {"mask_from_the_request", "mask_wrong"},
                  {"errors_masked_while_it_sends", "mask_wrong"}}),
      to_the_bit("no_mask_at_all", " = 0", {{"mask_of_20_symbols_at_least", "mask_wrong"}}, with_mask<0>()),
      to_the_bit("the_longest_mask", " = 64", {{"mask_of_63_symbols_at_most", "mask_wrong"}},
                 with_mask<64>()),
      on_chart(translator_must("blanking/an_error_without_carrier_is_silence", "PST-15",
                               "Without carrier everything is silence, signal errors too.",
                               own("without carrier everything is silence"),
                               {{"error_without_carrier", "error_indicated"}}),
               {{2, 4},
                {on_line(),
                 does("long after a transmission, bits with signal errors and without carrier",
                      [](TranslatorScene& scene) {
                        scene.exchange(sent(kLast));
                        scene.rest();
                        const char bit = scene.round % 2 == 0 ? 'I' : '1';
                        scene.exchange("", SideBits(14, {bit, false, true}));
                      }),
                 requires_that("silence",
                               [](TranslatorScene& scene) {
                                 scene.expect_nothing_indicated("error_indicated", "there is no carrier");
                               }),
                 receives()}}),
      on_chart(
          translator_must("blanking/no_mask_without_transmission", "PST-15",
                          "A signal error after a transmission of someone else, or after a request that the "
                          "transmitter was off for, is bad_signal.",
                          own("errors are masked after a transmission only"),
                          {{"mask_without_transmitter", "masked_without_transmission"}}),
          {{2, 20},
           {{"with the transmitter off, or no request, ones with signal errors; and errors after a fragment",
             "bad_signal for each of them", receive_errors_without_own},
            pause()},
           {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
