#include "conformance/interbus/master_sequence.hpp"

#include <algorithm>
#include <array>

#include "conformance/commands_text.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/master_reasons.hpp"
#include "conformance/interbus/master_side.hpp"
#include "conformance/interbus/master_side_notes.hpp"
#include "conformance/interbus/master_vocabulary.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "protocols/interbus/master.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kStatesOfMaster = 8;  // that walks look for: it acts by itself

constexpr std::size_t kCost = 3;  // a ring is recognised in each sequence

constexpr std::array kStatesOfOrders{interbus::MasterState::ready, interbus::MasterState::identification,
                                     interbus::MasterState::locating, interbus::MasterState::bus_stop};

constexpr EventKind kCycles{"cycles", "no_data_cycle", "cycle_unasked", "cycle_wrong", master_cycle_text};
constexpr EventKind kInputs{"verdicts", "no_data_cycle", "cycle_unasked", "inputs_wrong", master_inputs_text};
constexpr EventKind kReports{"reports", "no_data_cycle", "cycle_unasked", "report_wrong", master_report_text};
constexpr EventKind kStates{"states", "state_missing", "state_unasked", "state_wrong", master_state_text};

class MasterSequenceRun {
 public:
  MasterSequenceRun(MasterBench& bench, CaseJudge& judge, const field::Settings& settings,
                    void (*change_rules)(interbus::Rules&))
      : judge_(judge),
        twin_(NoNeeds{},
              {.make_device = std::make_unique<interbus::Master, const interbus::MasterConfiguration&>,
               .volume = Volume::quick,
               .settings = settings}),
        sides_{MasterSide(bench, &judge), MasterSide(twin_, nullptr)} {
    judge.use_decode([&bench](kernel::Time) { return bench.ring().describe_last(6); });
    for (MasterSide& side : sides_) {
      side.bench().configuration() = configuration_of_sequence(settings);
      side.bench().rules() = side.bench().configuration().rules;
      if (change_rules != nullptr) change_rules(side.bench().rules());
    }
  }

  void run(const Sequence& sequence) {
    power({.ring = ring_of(0)});
    CommandsText done;
    for (const SequenceCommand& command : sequence.commands) {
      done.add(command_lines({.commands = {command}}, master_sequence_role().vocabulary).front());
      judge_.begin_step(done.text());
      align(static_cast<MasterWord>(command.word));
      for (MasterSide& side : sides_) execute(side, command);
      compare();
    }
    for (MasterSide& side : sides_) side.cycle();
    compare();
  }

 private:
  void power(const MasterScene& scene) {
    for (MasterSide& side : sides_) side.power(scene);
    compare();
  }

  // When a cycle is judged is the master's choice, so an order at its end may come when the next one has
  // begun. Then it comes to both in the next one.
  void align(MasterWord word) {
    const bool is_order = word == MasterWord::outputs || word == MasterWord::output ||
                          word == MasterWord::identify || word == MasterWord::stop;
    const bool is_late = std::ranges::any_of(sides_, &MasterSide::has_begun);
    for (MasterSide& side : sides_) {
      if (!is_order) side.finish_begun();
      if (is_order && is_late) side.await_begin();
    }
  }

  static void execute(MasterSide& side, const SequenceCommand& command) {
    const auto& numbers = command.numbers;
    const auto word = [&](std::size_t n) { return static_cast<std::uint16_t>(numbers.at(n)); };
    const interbus::Rules& rules = side.bench().rules();
    switch (static_cast<MasterWord>(command.word)) {
      case MasterWord::cycles:
      case MasterWord::lost:
      case MasterWord::bad:
        return cycles(side, command, numbers[0]);
      case MasterWord::inputs:
        return side.offer(word(0), word(1));
      case MasterWord::outputs:
        return side.write_all(word(0), word(1));
      case MasterWord::output:
        return side.write(word(0), word(1));
      case MasterWord::identify:
        return side.request_id_cycle();
      case MasterWord::messages: {
        const unsigned bits = ((numbers[1] & 1) != 0 ? rules.message_peripheral_fault : 0U) |
                              ((numbers[1] & 2) != 0 ? rules.message_reconfiguration : 0U);
        return side.set_messages(word(0), static_cast<std::uint16_t>(bits));
      }
      case MasterWord::cut:
        return side.cut_before(word(0));
      case MasterWord::ring:
        return side.replace_ring(changed_ring(side.bench().ring().stations(), numbers[0], numbers[1]));
      case MasterWord::stop:
        return side.stop(numbers[0] != 0);
      case MasterWord::start:
        return side.start(word(0));
      case MasterWord::power:
        return side.power(scene_of(command));
      case MasterWord::early_order:
        return side.order_in(kStatesOfOrders.at(word(0)), static_cast<EarlyOrder>(numbers[1]));
      case MasterWord::wait:
        return side.wait(numbers[0] * kernel::kMillisecond);
      default:
        return cycles(side, command, 1);
    }
  }

  static void cycles(MasterSide& side, const SequenceCommand& command, std::int64_t count) {
    const auto faults = faults_of(command, side.bench().ring().stations().size());
    for (std::int64_t n = 0; n < count; ++n) side.cycle(faults);
  }

  void compare() {
    MasterSide& iut = sides_[0];
    MasterSide& twin = sides_[1];
    compare_events(kStates, iut.states(), std::span(&twin.states(), 1), true, judge_);
    compare_events(kCycles, iut.cycles(), std::span(&twin.cycles(), 1), true, judge_);
    compare_events(kInputs, iut.inputs(), std::span(&twin.inputs(), 1), true, judge_);
    compare_events(kReports, iut.reports(), std::span(&twin.reports(), 1), true, judge_);
    compare_cycle_time();
    for (MasterSide& side : sides_) side.clear_observations();
  }

  // The delay of the ring is measured, to some bits.
  void compare_cycle_time() {
    if (!sides_[0].is_running() || !sides_[1].is_running()) return;
    const kernel::Duration seen = sides_[0].bench().status().cycle_time;
    const kernel::Duration right = twin_.status().cycle_time;
    const kernel::Duration tolerance = kernel::levels_duration(4, twin_.rules().bit_rate);
    judge_.expect(right - tolerance <= seen && seen <= right + tolerance, "cycle_time_wrong",
                  kernel::describe(right), kernel::describe(seen));
  }

  CaseJudge& judge_;
  MasterBench twin_;  // with the reference
  std::array<MasterSide, 2> sides_;
};

}  // namespace

const SequenceRole& master_sequence_role() {
  static const SequenceRole role{
      {.id = "interbus/master/check/follows_the_reference",
       .purpose = "check",
       .requirement =
           "Whatever comes back and is ordered in whatever order, a master accepts right cycles and no "
           "others, shows their inputs, sends the outputs of its application, and reports what it finds.",
       .reference = sources::from_memory("what a master does with a cycle, with its ring and its orders"),
       .rules = master_reasons(),
       .stimulus = "Answers, orders and rings at random, with flipped levels and lost telegrams.",
       .expected = "What the reference sends and reports when it is answered and ordered the same.",
       .tags = {},
       .catches = {}},
      master_vocabulary(),
      {{DerivedKind::values, {"implausible_inputs_rejected", "right_cycle_rejected"}},
       {DerivedKind::faults, {"stop_bit_ignored", "wrong_cycle_accepted"}},
       {DerivedKind::words, {"wrong_segment", "report_wrong"}},
       {DerivedKind::states, {"copied_one_cycle_late", "report_wrong"}},
       {DerivedKind::walks, {"inputs_zeroed_on_error", "inputs_not_held"}},
       {DerivedKind::repetitions, {"stop_one_late", "cycle_unasked"}}},
      kCost,
      kStatesOfMaster};
  return role;
}

void run_master_sequence(const Sequence& sequence, MasterBench& bench, CaseJudge& judge,
                         void (*change_rules)(interbus::Rules&)) {
  MasterSequenceRun(bench, judge, sequence.settings, change_rules).run(sequence);
}

}  // namespace fieldproof::conformance
