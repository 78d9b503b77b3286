#include "conformance/interbus/slave_sequence.hpp"

#include <algorithm>
#include <array>

#include "conformance/interbus/declarations.hpp"
#include "conformance/interbus/slave_arrivals.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"
#include "conformance/sequence_settings.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/slave_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 5> kLikelyWords{0x0000, 0xFFFF, 0x0001, 0x8000, 0xA55A};
// Of a data telegram: after start level and header, in front of the stop level.
constexpr unsigned kFirstDataLevel = line::kDataTelegramLevels - 9;
constexpr unsigned kDataLevels = 8;

SequenceNumber word(std::string_view name) {
  return {name, 0, 0xFFFF, 0, kLikelyWords};
}

enum class SlaveWord : std::uint8_t { data, id, status, inputs };

// The bits of a word each have a place of their own.
constexpr std::array<std::string_view, 3> kFixedOfSlave{"status_*", "control_*", "message_*"};

// A network within its limits, on which no tester is silent for too long.
void expect_judgeable_slave(const field::Settings& settings) {
  SlaveSetting setting;
  setting.settings = settings;
  const interbus::NetworkDescription network = slave_network({}, setting);
  if (const auto violation = interbus::check(network))
    throw kernel::Error(kernel::ErrorKind::configuration, violation->sentence);
  expect_time_for_silences(network.rules);
}

SequenceVocabulary slave_vocabulary() {
  const interbus::SlaveConfiguration as_made =
      SlaveBench(SlaveNeeds{}, SlaveSetting{}).ring().configuration(1);
  // In the order of SlaveWord. Telegrams of a cycle: loopback word, register, check and status word.
  return {.words = {{.word = "data",
                     .meaning = "a data cycle",
                     .numbers = {word("word0"), word("word1")},
                     .units = 10,
                     .weight = 6},
                    {.word = "id", .meaning = "an ID cycle", .units = 8, .weight = 2},
                    {.word = "status",
                     .meaning = "so many status telegrams",
                     .numbers = {{"count", 1, 100, 1}},
                     .weight = 1},
                    {.word = "inputs",
                     .meaning = "the inputs stand like this",
                     .numbers = {word("word0"), word("word1")},
                     .weight = 1}},
          .unit = "telegram",
          .levels_per_unit = line::kDataTelegramLevels,
          .settings = sequence_settings(interbus::kSlaveTable, &as_made, kFixedOfSlave),
          .objection = objection_of(expect_judgeable_slave)};
}

class SlaveSequenceRun {
 public:
  SlaveSequenceRun(SlaveBench& bench, CaseJudge& judge) : bench_(bench), judge_(judge), arrivals_(bench) {}

  void run(const Sequence& sequence) {
    bench_.bring_up();
    for (const SequenceCommand& command : sequence.commands) execute(command);
  }

 private:
  void execute(const SequenceCommand& command) {
    switch (static_cast<SlaveWord>(command.word)) {
      case SlaveWord::data:
        data_cycle(command);
        break;
      case SlaveWord::id:
        bench_.begin();
        bench_.append_id_cycle(bench_.interfaces_off());
        pass(command);
        break;
      case SlaveWord::status:
        bench_.begin();
        bench_.train().status(static_cast<std::size_t>(command.numbers[0]));
        pass(command);
        break;
      case SlaveWord::inputs:
        bench_.set_inputs(words_of(command));
        break;
    }
  }

  // As many as the slave has, the two of the command in turn.
  std::vector<std::uint16_t> words_of(const SequenceCommand& command) const {
    std::vector<std::uint16_t> words;
    for (unsigned n = 0; n < bench_.words(); ++n) {
      words.push_back(static_cast<std::uint16_t>(command.numbers[n % 2]));
    }
    return words;
  }

  void data_cycle(const SequenceCommand& command) {
    const std::vector<std::uint16_t> words = words_of(command);
    const bool must_be_taken = command.faults.empty() && cycles_to_wait_ == 0;
    bench_.begin();
    bench_.append_data_cycle(words);
    pass(command);
    if (!must_be_taken) return;
    expect_outputs(bench_, judge_, words, "valid_cycle_rejected");
    expect_answer(bench_, judge_, 0, bench_.data_load());
  }

  // The train that has been written, with the faults of the command. What is at the outputs then has arrived.
  void pass(const SequenceCommand& command) {
    const std::vector<std::uint16_t> before = bench_.outputs();
    disturb(command);
    bench_.send();
    const bool may_change = arrivals_.take();
    remember(command);
    if (std::ranges::equal(bench_.outputs(), before)) return;
    const bool has_arrived = may_change && std::ranges::equal(bench_.outputs(), arrivals_.words());
    judge_.expect(has_arrived, "wrong_value_latched", [&] {
      Mismatch sighting{{"outputs " + text_of(before) + ": those before the cycle"},
                        "outputs " + text_of(bench_.outputs())};
      if (may_change) sighting.expected.push_back("outputs " + text_of(arrivals_.words()) + ": what arrived");
      return sighting;
    });
  }

  void disturb(const SequenceCommand& command) {
    fault::ScriptedChannel& channel = bench_.channel();
    channel.on_next();
    for (const SequenceFault& fault : command.faults) {
      if (fault.kind == SequenceFaultKind::flip) {
        channel.flip_in_telegram(fault.unit, fault.value);
      } else if (fault.kind == SequenceFaultKind::drop) {
        channel.drop_telegram(fault.unit);
      }
    }
  }

  // How many cycles may be lost from here on.
  void remember(const SequenceCommand& command) {
    const bool is_data_cycle = static_cast<SlaveWord>(command.word) == SlaveWord::data;
    const bool keeps_telegrams =
        is_data_cycle && std::ranges::all_of(command.faults, [](const SequenceFault& fault) {
          return fault.kind == SequenceFaultKind::flip && fault.value >= kFirstDataLevel &&
                 fault.value < kFirstDataLevel + kDataLevels;
        });
    if (!command.faults.empty() && !keeps_telegrams) {
      cycles_to_wait_ = bench_.rules().published_recovery_cycles;
    } else if (command.faults.empty() && is_data_cycle && cycles_to_wait_ > 0) {
      --cycles_to_wait_;
    }
  }

  SlaveBench& bench_;
  CaseJudge& judge_;
  SlaveArrivals arrivals_;
  unsigned cycles_to_wait_ = 0;
};

}  // namespace

const SequenceRole& slave_sequence_role() {
  static const SequenceRole role{
      {.id = "interbus/slave/check/follows_the_model",
       .purpose = "check",
       .requirement = "Whatever cycles come in whatever order, outputs show the words of cycles that arrived "
                      "with a right check, and what nothing disturbs is taken over and answered.",
       .reference = sources::from_memory("what a slave does with a cycle, and with a rejected one"),
       .details = details::answer(),
       .stimulus = "Cycles at random, with flipped levels and lost telegrams.",
       .expected = "What a model of the rules says.",
       .tags = {},
       .catches = {}},
      slave_vocabulary(),
      {{DerivedKind::values, {"sends_check_of_received_bits", "check_wrong"}},
       {DerivedKind::faults, {"id_register_in_data_cycle", "register_content_wrong"}},
       {DerivedKind::words, {"output_octets_swapped", "wrong_value_latched"}},
       {DerivedKind::repetitions, {"latches_5_ms_late", "valid_cycle_rejected"}},
       {DerivedKind::settings, {"input_bit_stuck", "register_content_wrong"}}}};
  return role;
}

void run_slave_sequence(const Sequence& sequence, SlaveBench& bench, CaseJudge& judge) {
  SlaveSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
