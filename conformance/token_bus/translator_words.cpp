#include "conformance/token_bus/translator_words.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "conformance/sequence_settings.hpp"
#include "conformance/token_bus/driven_frames.hpp"
#include "conformance/token_bus/judgeable_rules.hpp"
#include "protocols/token_bus/translator_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr unsigned kFrameBits = 240;
constexpr std::size_t kPreambleSymbols = 32;
constexpr std::size_t kAfterFrame = 60;  // symbols, longer than any blanking
constexpr std::string_view kCommandLetters = "rltid";
constexpr std::int64_t kNoCommand = 5;
constexpr std::array<std::int64_t, 5> kRowsOfOne{1, 2, 3, 64, 70};
constexpr std::array<std::int64_t, 6> kCommandLengths{1, 2, 4, 24, 64, 300};
constexpr std::array<std::string_view, 9> kCodes{"P", "p", "1", "0", "NN", "nN", "S", "s", "NS"};
constexpr std::int64_t kRows = static_cast<std::int64_t>(TranslatorRow::command_in_a_frame);
constexpr std::int64_t kJabbers = 4;
constexpr std::int64_t kMaskRows = 10;
constexpr std::int64_t kHuntingRows = 19;
constexpr std::int64_t kPhaseRows = 55;

// ---- the vocabulary ----

std::vector<SequenceWord> first_words_of_a_translator() {
  const SequenceNumber content{"content", 0, 255, 0x42};
  const SequenceNumber more{"more", 0, 1, 0};
  const SequenceNumber lost{"lost", 0, 15, 0};
  return {{.word = "request",
           .meaning = "the MAC requests a frame, with I = 1 or not",
           .numbers = {content, more},
           .weight = 6},
          {.word = "request_cut",
           .meaning = "the MAC requests the first so many symbols of a frame",
           .numbers = {content, {"symbols", 1, 119, 40}},
           .weight = 3},
          {.word = "command",
           .meaning = "the MAC gives a command: RESET, DISABLE LOOPBACK, ENABLE TRANSMITTER, none, data",
           .numbers = {{"which", 0, 4, 0}},
           .weight = 4},
          {.word = "on_line", .meaning = "the MAC brings the translator on line", .weight = 6},
          {.word = "receive",
           .meaning = "a frame comes from the line, its first so many bits lost",
           .numbers = {content, lost, more},
           .units = kFrameBits,
           .weight = 10},
          {.word = "receive_cut",
           .meaning = "so many bits of a frame, one more where they are odd, come from the line",
           .numbers = {content, {"bits", 1, 239, 100}},
           .units = kFrameBits,
           .weight = 4},
          {.word = "collide",
           .meaning = "a frame is requested while the same comes from the line",
           .numbers = {content},
           .units = kFrameBits,
           .weight = 3},
          {.word = "receive_managed",
           .meaning = "a frame comes from the line in management mode",
           .numbers = {content},
           .units = kFrameBits,
           .weight = 2},
          {.word = "wait", .meaning = "silence of so many symbols", .numbers = {{"symbols", 1, 200, 50}}},
          {.word = "power", .meaning = "the supply is switched off and on", .is_loss = true}};
}

SequenceNumber command_number(std::string_view name, std::int64_t simple) {
  return {name, 0, kNoCommand, simple};
}

std::vector<SequenceWord> later_words_of_a_translator() {
  const auto code = [](std::string_view name) {
    return SequenceNumber{name, 0, static_cast<std::int64_t>(kCodes.size()) - 1, 0};
  };
  const std::vector<SequenceNumber> three{command_number("first", 0),
                                          command_number("second", 1),
                                          command_number("third", 2),
                                          {"symbols", 1, 300, 4, kCommandLengths}};
  return {
      {.word = "codes",
       .meaning = "the MAC requests symbols by any of their codes, the first one so often",
       .numbers = {code("first"),
                   code("second"),
                   code("third"),
                   {"times", 1, 70, 1, kRowsOfOne, true},
                   {"bare", 0, 1, 0}},
       .weight = 4},
      {.word = "answers",
       .meaning = "up to three commands directly after each other, of so many symbols each",
       .numbers = three,
       .weight = 3},
      {.word = "commands",
       .meaning = "the same, and symbols are requested directly after them",
       .numbers = three,
       .weight = 3},
      {.word = "row",
       .meaning = "after a frame more comes from the line at once",
       .numbers = {{"which", 0, kRows, 0}},
       .weight = 4},
      {.word = "heartbeat",
       .meaning = "a preamble is requested, and the test of a transceiver follows it, with carrier or not",
       .numbers = {{"carrier", 0, 1, 0}},
       .weight = 1},
      {.word = "jabber",
       .meaning = "as many symbols as may be are requested, one more, or twice 40000",
       .numbers = {{"kind", 0, kJabbers, 0}},
       .weight = 0},
      {.word = "clocks",
       .meaning = "the longest frame is requested or comes, its clock so many times 100 ppm away",
       .numbers = {{"side", 0, 1, 0}, {"away", -1, 1, 0}},
       .weight = 0},
      {.word = "mask",
       .meaning = "signal errors follow what is requested, and what is not sent",
       .numbers = {{"row", 0, kMaskRows, 0}},
       .weight = 1},
      {.word = "anew",
       .meaning = "RESET, or a failure of the supply, within the blanking",
       .numbers = {{"supply", 0, 1, 0}},
       .weight = 1},
      {.word = "phase",
       .meaning = "what moves the phase, or holds it, or is left of it after silence comes before a frame",
       .numbers = {{"silence", 0, 1, 0}, {"row", 0, kPhaseRows, 0}},
       .weight = 1}};
}

std::vector<std::vector<NamedCommand>> states_of_a_translator() {
  const NamedCommand on_line{"on_line"};
  return {{on_line},
          {on_line, {"request"}},
          {on_line, {"receive", {{"more", 1}}}},
          {on_line, {"collide"}},
          {on_line, {"command"}},
          {on_line, {"power"}}};
}

// ---- situations ----

NamedCommand one_number(std::string_view word, std::string_view name, std::int64_t value) {
  return {word, {{name, value}}};
}
NamedCommand three_commands(std::string_view word, std::int64_t first, std::int64_t second,
                            std::int64_t third, std::int64_t symbols) {
  return {word, {{"first", first}, {"second", second}, {"third", third}, {"symbols", symbols}}};
}

// A jabber that is over soon: the setting as short as it may be.
NamedSituation with_jabbers(std::vector<NamedCommand> commands) {
  return {std::move(commands), {{"answer_symbols", {{"jabber_symbols", 66'000}}}}};
}

std::vector<NamedSituation> situations_of_a_translator() {
  const NamedCommand on_line{"on_line"};
  const NamedCommand too_long = one_number("jabber", "kind", 1);
  const NamedCommand asks = three_commands("answers", 3, 2, 3, 4);
  std::vector<NamedSituation> all{
      with_jabbers({on_line, one_number("jabber", "kind", 0), asks}),
      with_jabbers({on_line,
                    too_long,
                    asks,
                    three_commands("answers", 1, 3, 4, 24),
                    {"request"},
                    {"receive"},
                    on_line,
                    {"request"}}),
      with_jabbers(
          {on_line, too_long, three_commands("commands", 2, 3, 2, 24), {"receive"}, {"power"}, asks}),
      with_jabbers({on_line, too_long, three_commands("answers", 2, 2, 3, 24),
                    three_commands("answers", 3, 3, 4, 24), on_line, too_long, asks}),
      with_jabbers({on_line, one_number("jabber", "kind", 2), asks}),
      with_jabbers({on_line, one_number("jabber", "kind", 3), asks}),
      with_jabbers({three_commands("answers", 0, 1, 5, 4), one_number("jabber", "kind", 4), asks})};
  for (const std::int64_t side : {0, 1})
    for (const std::int64_t away : {-1, 1})
      all.push_back({{on_line, {"clocks", {{"side", side}, {"away", away}}}}});
  const std::vector<ShownSetting> times{
      {"delay_symbols"}, {"answer_symbols"}, {"blanking_symbols"}, {"phy_bit_rate"}};
  for (std::int64_t row = 0; row <= kRows; ++row)
    all.push_back({{on_line, one_number("row", "which", row), {"receive"}, {"request"}},
                   {times.at(static_cast<std::size_t>(row % 4))}});
  for (std::int64_t row = 0; row <= kMaskRows; ++row)
    all.push_back({{one_number("mask", "row", row), {"receive"}}, {{"error_mask_symbols"}}});
  for (std::int64_t row = 0; row < kHuntingRows; ++row) {
    const NamedCommand holds{"phase", {{"row", row}}};
    const NamedCommand is_left{"phase", {{"silence", 1}, {"row", 3 * row}}};
    all.push_back({.commands = {holds, is_left}});
  }
  all.push_back({{on_line,
                  one_number("request_cut", "symbols", 33),
                  {"codes", {{"first", 4}, {"second", 2}, {"third", 4}, {"bare", 1}}}}});
  for (const std::int64_t symbols : {1, 2, 64, 300})
    all.push_back({{three_commands("answers", 4, 3, 2, symbols), three_commands("commands", 0, 1, 2, 1),
                    three_commands("commands", 5, 0, 5, symbols)},
                   {times[1]}});
  return all;
}

}  // namespace

SequenceVocabulary translator_vocabulary() {
  const token_bus::TranslatorConfiguration as_made;
  // In the order of TranslatorWord.
  SequenceVocabulary vocabulary{
      .words = first_words_of_a_translator(),
      .unit = "bit",
      .levels_per_unit = 3,
      .settings = sequence_settings(token_bus::kTranslatorTable, &as_made),
      .objection = objection_of(
          token_bus::kTranslatorTable, as_made,
          +[](const token_bus::TranslatorConfiguration& one) { expect_whole_half_bits(one.rules); })};
  for (SequenceWord& word : later_words_of_a_translator()) vocabulary.words.push_back(std::move(word));
  return with_situations(with_beginnings(std::move(vocabulary), states_of_a_translator()),
                         situations_of_a_translator());
}

// ---- what is requested, and what comes ----

std::string translated_frame(std::int64_t content, bool more_follows) {
  constexpr std::size_t kData = 5;
  return frame_text(with_crc_32(std::vector<std::uint8_t>(kData, static_cast<std::uint8_t>(content))),
                    more_follows);
}

std::string script_of_codes(const std::vector<std::int64_t>& numbers) {
  const auto code = [&](std::size_t n) { return kCodes.at(static_cast<std::size_t>(numbers[n])); };
  const bool is_bare = numbers[4] == 1;
  std::string script(is_bare ? 0 : 16, 'P');
  for (std::int64_t n = 0; n < numbers[3]; ++n) script += code(0);
  script += code(1);
  script += code(2);
  return is_bare ? script : script + "10PP";
}

std::string script_of_commands(const std::vector<std::int64_t>& numbers) {
  std::string script;
  for (std::size_t n = 0; n < 3; ++n) {
    if (numbers[n] == kNoCommand) continue;
    script += std::string(static_cast<std::size_t>(numbers[3]),
                          kCommandLetters.at(static_cast<std::size_t>(numbers[n])));
  }
  return script;
}

std::string requested_after_commands() {
  return std::string(16, 'P') + start_delimiter_text() + "0110";
}

std::string script_of_jabber(std::int64_t kind, const token_bus::TranslatorConfiguration& configuration) {
  constexpr unsigned kMost = 70'000;
  const std::size_t limit = configuration.jabber_symbols;
  if (limit > kMost) return {};
  const std::string part(40'000, 'P');
  switch (kind) {
    case 2:
      return part + "S" + part;
    case 3:
      return part + "i" + part;
    case 4:
      return std::string(limit + 2'000, 'P');
    default:
      return std::string(limit + static_cast<std::size_t>(kind), 'P');
  }
}

std::string script_of_row(TranslatorRow row) {
  const std::string frame = translated_frame(0x42);
  switch (row) {
    case TranslatorRow::idle_command:
      return std::string(frame.size() + 2, 'S') + "i";
    case TranslatorRow::commands:
      return std::string(frame.size() + 2, 'S') + "ld";
    case TranslatorRow::command_in_a_frame:
      return std::string(frame.size() + 16, 'S') + "i";
    default:
      return {};
  }
}

SideBits bits_of_row(TranslatorRow row) {
  constexpr std::size_t kZeros = 300;  // longer than an answer may be late
  const std::string ones(kAfterFrame, '1');
  const std::string frame = translated_frame(0x42);
  switch (row) {
    case TranslatorRow::bad_signal:
      return side_bits_of(encoded(frame + "1111BBBB" + ones));
    case TranslatorRow::silence:
      return side_bits_of(encoded(frame + "SSSS" + ones));
    case TranslatorRow::delimiter:
      return side_bits_of(encoded(frame + "SSSSNN0NN000" + ones));
    case TranslatorRow::zeros:
      return side_bits_of(encoded(frame + ones + "00000011"));
    case TranslatorRow::carrier_alone:
      return side_bits_of(encoded(std::string(kPreambleSymbols, 'P') + start_delimiter_text() + "0110") +
                          std::string(16, 'I'));
    case TranslatorRow::error_without_carrier:
      return {14, SideBit{'1', false, true}};
    case TranslatorRow::command_in_a_frame:
      return side_bits_of(encoded(std::string(kPreambleSymbols, 'P') + start_delimiter_text() + "1001" +
                                  std::string(2 * kZeros, '0')));
    case TranslatorRow::errors: {
      SideBits bits = side_bits_of(encoded(frame + ones));
      for (std::size_t n = 4; n < 20; ++n) bits.at(2 * frame.size() + n).has_error = true;
      return bits;
    }
    default:
      return side_bits_of(encoded(frame + ones));
  }
}

// ---- what can be said ----

TranslatorLook look_of(const SequenceCommand& command) {
  switch (static_cast<TranslatorWord>(command.word)) {
    case TranslatorWord::receive:
    case TranslatorWord::receive_cut:
    case TranslatorWord::collide:
    case TranslatorWord::receive_managed: {
      const bool is_received = command.word == static_cast<std::size_t>(TranslatorWord::receive);
      const bool is_whole = command.faults.empty() && (!is_received || command.numbers[1] == 0);
      return is_whole ? TranslatorLook::all : TranslatorLook::content;
    }
    case TranslatorWord::clocks:
      return TranslatorLook::content;
    case TranslatorWord::row:
      return command.numbers[0] == kRows ? TranslatorLook::ends : TranslatorLook::content;
    case TranslatorWord::answers:
      return TranslatorLook::answers;
    case TranslatorWord::commands:
      return TranslatorLook::last;
    // Where a translator loops back, what begins with no preamble is in no phase: what is sent is looked at.
    case TranslatorWord::codes:
    case TranslatorWord::jabber:
      return TranslatorLook::sent_nearly;
    case TranslatorWord::mask:
    case TranslatorWord::anew:
    case TranslatorWord::phase:
      return TranslatorLook::by_rules;
    default:
      return TranslatorLook::all;
  }
}

std::size_t sure_symbols(const SequenceCommand& command) {
  constexpr std::uint32_t kNoCarrier = 2;
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  std::size_t sure = kAll;
  const bool is_received = command.word == static_cast<std::size_t>(TranslatorWord::receive);
  const auto lost = is_received ? static_cast<std::size_t>(command.numbers[1]) : 0;
  for (const SequenceFault& fault : command.faults) {
    const bool is_idle = fault.kind == SequenceFaultKind::drop || fault.value == kNoCarrier;
    if (!is_idle) continue;
    const std::size_t symbol = (fault.unit + lost) / 2;
    sure = std::min(sure, symbol > kPreambleSymbols ? symbol - kPreambleSymbols - 1 : 0);
  }
  // Others may make another symbol the first non_data.
  return sure == kAll || command.faults.size() == 1 ? sure : 0;
}

}  // namespace fieldproof::conformance
