#include "conformance/token_bus/translator_sequence.hpp"

#include "conformance/sequence_settings.hpp"
#include "conformance/token_bus/driven_frames.hpp"
#include "conformance/token_bus/judgeable_rules.hpp"
#include "conformance/token_bus/sides_sequence.hpp"
#include "conformance/token_bus/translator_cases.hpp"
#include "protocols/token_bus/translator.hpp"
#include "protocols/token_bus/translator_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr unsigned kFrameBits = 240;
constexpr std::size_t kCommandSymbols = 64;
constexpr std::int64_t kRest = 200;  // symbols, longer than any blanking

enum class TranslatorWord : std::uint8_t {
  request,
  request_cut,
  command,
  on_line,
  receive,
  receive_cut,
  collide,
  receive_managed,
  wait,
  power
};

std::vector<std::vector<NamedCommand>> states_of_a_translator() {
  const NamedCommand on_line{"on_line"};
  return {{on_line},
          {on_line, {"request"}},
          {on_line, {"receive", {{"more", 1}}}},
          {on_line, {"collide"}},
          {on_line, {"command"}},
          {on_line, {"power"}}};
}

SequenceVocabulary translator_vocabulary() {
  const token_bus::TranslatorConfiguration as_made;
  const SequenceNumber content{"content", 0, 255, 0x42};
  const SequenceNumber more{"more", 0, 1, 0};
  const SequenceNumber lost{"lost", 0, 15, 0};
  // In the order of TranslatorWord.
  return {
      .words =
          {{.word = "request",
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
           {.word = "power", .meaning = "the supply is switched off and on", .is_loss = true}},
      .unit = "bit",
      .levels_per_unit = 3,
      .settings = sequence_settings(token_bus::kTranslatorTable, &as_made),
      .objection = objection_of(
          token_bus::kTranslatorTable, as_made,
          +[](const token_bus::TranslatorConfiguration& one) { expect_whole_half_bits(one.rules); })};
}

std::string translated_frame(std::int64_t content, bool more_follows = false) {
  constexpr std::size_t kData = 5;
  return frame_text(with_crc_32(std::vector<std::uint8_t>(kData, static_cast<std::uint8_t>(content))),
                    more_follows);
}

// Of a bit, a fault inverts it, is a signal error, or takes its carrier; one that is dropped is idle.
SideBits with_bit_faults(const std::string& text, const std::vector<SequenceFault>& faults) {
  SideBits bits = side_bits_of(text);
  for (const SequenceFault& fault : faults) {
    if (fault.unit >= bits.size()) continue;
    SideBit& bit = bits[fault.unit];
    if (fault.kind == SequenceFaultKind::drop) bit.symbol = 'I';
    if (fault.kind != SequenceFaultKind::flip) continue;
    if (fault.value == 0) bit.symbol = bit.symbol == '1' ? '0' : '1';
    if (fault.value == 1) bit.has_error = true;
    if (fault.value == 2) bit.has_carrier = false;
  }
  return bits;
}

class TranslatorSequenceRun {
 public:
  TranslatorSequenceRun(TranslatorBench& bench, CaseJudge& judge)
      : bench_(bench),
        judge_(judge),
        slow_(twin_of(bench.configuration())),
        quick_(twin_of(quickest(bench.configuration()))) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) {
      for (TranslatorBench* one : {&bench_, &slow_, &quick_}) {
        one->clear();
        execute(command, *one);
        one->settle();
        // What follows is another transmission, for each delay.
        one->wait(one->symbols(kRest));
      }
      // How late it is decides what a signal error after its own transmission is: then nothing is certain.
      if (slow_.sent().text() != quick_.sent().text() || indications_of(slow_) != indications_of(quick_))
        return;
      compare_sides("sent", bench_.sent(), slow_.sent(), "sent_other", judge_);
      const std::string seen = indications_of(bench_);
      const std::string right = indications_of(slow_);
      judge_.expect(seen == right, "indication_other", [&] { return difference(right, seen); });
    }
  }

 private:
  static TranslatorBench twin_of(const token_bus::TranslatorConfiguration& configuration) {
    return reference_bench<TranslatorBench, TranslatorNeeds, TranslatorSetting, token_bus::Translator>(
        configuration, token_bus::kTranslatorTable);
  }
  static token_bus::TranslatorConfiguration quickest(token_bus::TranslatorConfiguration configuration) {
    constexpr unsigned kLeastDelay = 2;
    configuration.delay_symbols = kLeastDelay;
    return configuration;
  }
  static void execute(const SequenceCommand& command, TranslatorBench& bench) {
    using enum SideCommand;
    const auto& numbers = command.numbers;
    const std::string frame = numbers.empty() ? "" : translated_frame(numbers[0]);
    switch (static_cast<TranslatorWord>(command.word)) {
      case TranslatorWord::request:
        return bench.request(translated_frame(numbers[0], numbers[1] == 1));
      case TranslatorWord::request_cut:
        return bench.request(frame.substr(0, static_cast<std::size_t>(numbers[1])));
      case TranslatorWord::command:
        return bench.command(static_cast<SideCommand>(numbers[0]), kCommandSymbols);
      case TranslatorWord::on_line:
        for (const SideCommand one : {reset, disable_loopback, enable_transmitter})
          bench.command(one, kCommandSymbols);
        return;
      case TranslatorWord::receive:
        return bench.carry(with_bit_faults(encoded(translated_frame(numbers[0], numbers[2] == 1))
                                               .substr(static_cast<std::size_t>(numbers[1])),
                                           command.faults));
      case TranslatorWord::receive_cut: {
        // Whole pairs: what a single bit before the silence is the page says in two ways.
        const auto bits = static_cast<std::size_t>(numbers[1] + numbers[1] % 2);
        return bench.carry(with_bit_faults(encoded(frame).substr(0, bits), command.faults));
      }
      case TranslatorWord::collide:
        return bench.request_and_receive(frame, with_bit_faults(encoded(frame), command.faults));
      case TranslatorWord::receive_managed:
        return bench.command_and_receive(idle, 2 * kCommandSymbols,
                                         with_bit_faults(encoded(frame), command.faults));
      case TranslatorWord::wait:
        return bench.wait(bench.symbols(numbers[0]));
      case TranslatorWord::power:
        bench.set_power(false);
        bench.wait(bench.symbols(kRest));
        bench.set_power(true);
    }
  }

  // When an answer comes within its command is the translator's choice.
  static std::string indications_of(const TranslatorBench& bench) {
    std::string text;
    for (const char letter : bench.indicated().text()) {
      const bool is_answer = std::string_view("iane").find(letter) != std::string_view::npos;
      if (letter == 'S' || (is_answer && (letter == 'i' || text.ends_with(letter)))) continue;
      text += letter;
    }
    return text;
  }
  TranslatorBench& bench_;
  CaseJudge& judge_;
  TranslatorBench slow_;
  TranslatorBench quick_;
};

}  // namespace

const SequenceRole& translator_sequence_role() {
  static const SequenceRole role{
      {.id = "token_bus/translator/check/follows_the_reference",
       .purpose = "check",
       .requirement =
           "Whatever is requested and comes from the line in whatever order, a translator sends and "
           "indicates what its tables say, and nothing else.",
       .reference = token_sources::own("table of decoding, management mode"),
       .details = {},
       .stimulus = "Commands at random, with bits that are inverted, missing or spoiled.",
       .expected =
           "What references do on benches of their own, as late as they may be and at once; where these "
           "disagree, the sequence ends.",
       .tags = {},
       .catches = {}},
      with_beginnings(translator_vocabulary(), states_of_a_translator()),
      // Of cut requests and spoilt bits the page leaves open what is right: for `check` only.
      {{DerivedKind::words, {"reset_enables_transmitter", "sent_other"}},
       {DerivedKind::repetitions, {"zero_and_one_exchanged", "indication_other"}},
       {DerivedKind::settings, {"transmitter_on_from_the_start", "sent_other"}},
       {DerivedKind::drawn, {"reset_enables_transmitter", "sent_other"}}}};
  return role;
}

void run_translator_sequence(const Sequence& sequence, TranslatorBench& bench, CaseJudge& judge) {
  TranslatorSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
