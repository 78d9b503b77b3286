#include "conformance/token_bus/translator_sequence.hpp"

#include <algorithm>

#include "conformance/token_bus/sides_sequence.hpp"
#include "conformance/token_bus/translator_cases.hpp"
#include "conformance/token_bus/translator_comparison.hpp"
#include "conformance/token_bus/translator_reasons.hpp"
#include "conformance/token_bus/translator_scene.hpp"
#include "conformance/token_bus/translator_words.hpp"
#include "protocols/token_bus/translator.hpp"
#include "protocols/token_bus/translator_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kCommandSymbols = 64;
// Symbols. Whether an end delimiter without its E is one is left open.
constexpr std::size_t kMostOfACut = 118;
constexpr std::int64_t kRest = 200;  // symbols, longer than any blanking
constexpr std::size_t kCost = 3;     // frames and jabbers of thousands of symbols, on three benches

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

void bring_on_line(TranslatorBench& bench) {
  bench.request("rrrrllllttttSSSS");
  bench.settle();
  bench.wait(bench.symbols(kRest));
}

void exchange_long(TranslatorBench& bench, bool is_received, std::int64_t away) {
  constexpr std::int64_t kPartsPerMillion = 100;
  const std::string frame = frame_text(std::vector<std::uint8_t>(kLongestFrame, 0xB1));
  if (is_received) {
    bench.set_line_clock(kPartsPerMillion * away);
    bench.carry(encoded(frame));
    bench.set_line_clock(0);
    return;
  }
  bench.set_mac_clock(kPartsPerMillion * away);
  bench.request(frame);
  bench.set_mac_clock(0);
}

// What IEEE 802.3 has a transceiver do shortly after a transmission, where a mask is long enough for it.
void receive_test(TranslatorBench& bench, bool has_carrier) {
  constexpr unsigned kTestSymbols = 11;
  const auto& one = bench.configuration();
  if (one.error_mask_symbols < one.delay_symbols + kTestSymbols) return;
  bench.request(std::string(24, 'P'));
  bench.wait(bench.delay());
  SideBits test(8, {'I', false, false});
  test.insert(test.end(), 14, {'I', has_carrier, true});
  bench.carry(test);
}

void execute_later(const SequenceCommand& command, TranslatorBench& bench) {
  const auto& numbers = command.numbers;
  switch (static_cast<TranslatorWord>(command.word)) {
    case TranslatorWord::codes:
      return bench.request(script_of_codes(numbers));
    case TranslatorWord::answers: {
      const std::string script = script_of_commands(numbers);
      if (!script.empty()) bench.request(script + "SSSS");
      return bench.wait(bench.symbols(bench.configuration().answer_symbols));
    }
    case TranslatorWord::commands: {
      const std::string silence(bench.configuration().answer_symbols + 1, 'S');
      return bench.request(script_of_commands(numbers) + requested_after_commands() + silence +
                           requested_after_commands());
    }
    case TranslatorWord::row: {
      const auto row = static_cast<TranslatorRow>(numbers[0]);
      return bench.request_and_receive(script_of_row(row), bits_of_row(row));
    }
    case TranslatorWord::heartbeat:
      return receive_test(bench, numbers[0] == 1);
    case TranslatorWord::jabber: {
      const std::string script = script_of_jabber(numbers[0], bench.configuration());
      if (!script.empty()) bench.request(script);
      return;
    }
    case TranslatorWord::clocks:
      return exchange_long(bench, numbers[0] == 1, numbers[1]);
    default:
      return bring_on_line(bench);
  }
}

void execute(const SequenceCommand& command, TranslatorBench& bench) {
  using enum SideCommand;
  const auto& numbers = command.numbers;
  const std::string frame = numbers.empty() ? "" : translated_frame(numbers[0]);
  switch (static_cast<TranslatorWord>(command.word)) {
    case TranslatorWord::request:
      return bench.request(translated_frame(numbers[0], numbers[1] == 1));
    case TranslatorWord::request_cut:
      return bench.request(frame.substr(0, std::min(kMostOfACut, static_cast<std::size_t>(numbers[1]))));
    case TranslatorWord::command:
      return bench.command(static_cast<SideCommand>(numbers[0]), kCommandSymbols);
    case TranslatorWord::on_line:
      for (const SideCommand one : {reset, disable_loopback, enable_transmitter})
        bench.command(one, kCommandSymbols);
      return;
    case TranslatorWord::receive:
      return bench.carry(with_bit_faults(
          encoded(translated_frame(numbers[0], numbers[2] == 1)).substr(static_cast<std::size_t>(numbers[1])),
          command.faults));
    case TranslatorWord::receive_cut: {
      // Whole pairs: what a single bit before the silence is the page says in two ways.
      const auto bits = std::min(2 * kMostOfACut, static_cast<std::size_t>(numbers[1] + numbers[1] % 2));
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
      return bench.set_power(true);
    default:
      return execute_later(command, bench);
  }
}

// What the commands have switched, by their table. Whether a translator that loops back also sends is open.
class LoopbackState {
 public:
  void note(const SequenceCommand& command) {
    switch (static_cast<TranslatorWord>(command.word)) {
      case TranslatorWord::command:
        return note(
            std::string(1, std::string_view("rltid").at(static_cast<std::size_t>(command.numbers[0]))));
      case TranslatorWord::on_line:
      case TranslatorWord::mask:
      case TranslatorWord::anew:
      case TranslatorWord::phase:
        return note("rlt");
      case TranslatorWord::answers:
      case TranslatorWord::commands:
        return note(script_of_commands(command.numbers));
      case TranslatorWord::row:
        return note(script_of_row(static_cast<TranslatorRow>(command.numbers[0])));
      case TranslatorWord::power:
        return note("r");
      default:
        return;
    }
  }
  bool is_unsaid() const { return is_looped_back_ && is_on_; }
  bool is_looped_back() const { return is_looped_back_; }

 private:
  void note(std::string_view script) {
    for (const char one : script) {
      if (one == 'r' || one == 'l') is_looped_back_ = one == 'r';
      if (one == 'r' || one == 't') is_on_ = one == 't';
    }
  }

  bool is_looped_back_ = true;
  bool is_on_ = false;
};

class TranslatorSequenceRun {
 public:
  TranslatorSequenceRun(TranslatorBench& bench, CaseJudge& judge)
      : bench_(bench),
        judge_(judge),
        slow_(twin_of(bench.configuration())),
        quick_(twin_of(quickest(bench.configuration()))) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) {
      const TranslatorLook look = look_of(command);
      for (BegunBench* one : {&seen_, &right_, &right_at_once_}) {
        one->bench->clear();
        one->begin = one->bench->now();
        execute(command, *one->bench);
        one->bench->settle();
        // What follows is another transmission, for each delay.
        one->bench->wait(one->bench->symbols(kRest));
      }
      state_.note(command);
      if (look == TranslatorLook::by_rules) {
        judge_by_rules(command);
      } else if (!compare(command, look)) {
        return;
      }
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

  // All three are on line by now, and so they are afterwards.
  void judge_by_rules(const SequenceCommand& command) {
    const auto word = static_cast<TranslatorWord>(command.word);
    const std::int64_t round = word == TranslatorWord::phase ? command.numbers[1] : command.numbers[0];
    TranslatorScene scene(bench_, judge_, static_cast<unsigned>(round));
    if (word == TranslatorWord::mask) translator_chart::receives_errors(scene);
    if (word == TranslatorWord::anew) translator_chart::begins_anew_within_blanking(scene);
    if (word == TranslatorWord::phase) translator_chart::receives_in_a_phase(scene, command.numbers[0] == 1);
    bring_on_line(bench_);
    bench_.clear();
  }

  // False: how late it is decides what a signal error after its own transmission is. Then nothing is certain.
  bool compare(const SequenceCommand& command, TranslatorLook look) {
    const std::size_t sure = sure_symbols(command);
    if (!state_.is_unsaid()) {
      const TimedText right = sent_of(right_, look);
      if (right.text != sent_of(right_at_once_, look).text) return false;
      expect_same("sent", sent_of(seen_, look), right, {"sent_other", "sent_too_late"}, times(), judge_);
    }
    const bool is_hidden = look == TranslatorLook::sent_nearly && state_.is_looped_back();
    if (is_hidden) return true;
    const TimedText right = indicated_of(right_, look, sure);
    if (right.text != indicated_of(right_at_once_, look, sure).text) return false;
    expect_same("indicated", indicated_of(seen_, look, sure), right,
                {"indication_other", "indicated_too_late"}, times(), judge_);
    return true;
  }
  // By which an implementation may be later than the reference is.
  LaterTimes times() const {
    const auto& one = bench_.configuration();
    const std::int64_t taken = std::min(one.delay_symbols, one.answer_symbols);
    return {bench_.symbols(one.delay_symbols - taken), bench_.symbols(one.answer_symbols - taken)};
  }

  TranslatorBench& bench_;
  CaseJudge& judge_;
  TranslatorBench slow_;
  TranslatorBench quick_;
  BegunBench seen_{&bench_};
  BegunBench right_{&slow_};
  BegunBench right_at_once_{&quick_};
  LoopbackState state_;
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
       .rules = translator_reasons(),
       .stimulus = "Commands at random, with bits that are inverted, missing or spoiled.",
       .expected =
           "What references do on benches of their own, as late as they may be and at once; where these "
           "disagree, the sequence ends.",
       .tags = {},
       .catches = {}},
      translator_vocabulary(),
      // Of cut requests and spoilt bits only that is looked at which the page says. Not what is drawn: of a
      // reception that was cut off and one that lost bits after it the page leaves open what is right.
      {{DerivedKind::values, {"answer_of_28_symbols_at_most", "indication_other"}},
       {DerivedKind::faults, {"error_loses_the_lock", "indication_other"}},
       {DerivedKind::words, {"reset_enables_transmitter", "sent_other"}},
       {DerivedKind::states, {"disable_toggles", "indication_other"}},
       {DerivedKind::walks, {"reset_enables_transmitter", "sent_other"}},
       {DerivedKind::repetitions, {"zero_and_one_exchanged", "sent_other"}},
       {DerivedKind::settings, {"transmitter_on_from_the_start", "sent_other"}}},
      kCost};
  return role;
}

void run_translator_sequence(const Sequence& sequence, TranslatorBench& bench, CaseJudge& judge) {
  TranslatorSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
