// Chapter immunity: what the application sees while the line is disturbed (IM-40).
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "conformance/interbus/master_scene.hpp"
#include "conformance/interbus/slave_model.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::conformance {

namespace {

using namespace master_chart;
using interbus::CycleFaults;
using judge::Standing;
using CycleInfo = interbus::RingEmulator::CycleInfo;

// Bursts of 1 to 6 cycles, in which every second cycle suffers some fault that no good receiver takes.
class RandomFaults {
 public:
  RandomFaults(kernel::Random random, std::uint64_t longest_pause)
      : random_(random), longest_pause_(longest_pause) {}

  void operator()(const CycleInfo& info, CycleFaults& faults) {
    if (pause_ > 0) {
      --pause_;
      return;
    }
    if (left_ == 0) left_ = 1 + static_cast<unsigned>(random_.below(6));
    if (--left_ == 0) pause_ = 6 + static_cast<unsigned>(random_.below(longest_pause_));
    if (random_.chance(0.5)) disturb(info, faults);
  }

 private:
  void disturb(const CycleInfo& info, CycleFaults& faults) {
    const std::size_t telegrams = info.octets + 6;
    const auto at = static_cast<int>(random_.below(telegrams - 1));
    switch (random_.below(12)) {
      case 0:
        faults.dropped = at;
        break;
      case 1:
        faults.inserted = at;
        break;
      case 2:
        faults.stop_missing = at;
        break;
      case 3:
        faults.flag_flipped = at;
        break;
      case 4:
        faults.header_flipped = at;
        break;
      case 5:
        faults.marked_by = 0;
        break;
      default:
        flip_bits(telegrams, faults);
    }
  }
  // One to three different bits: every such pattern is found, whatever the data.
  void flip_bits(std::size_t telegrams, CycleFaults& faults) {
    std::vector<std::uint64_t> bits;
    for (std::uint64_t n = 1 + random_.below(3); n > 0; --n) {
      const std::uint64_t bit = random_.below(8 * telegrams);
      if (std::ranges::find(bits, bit) == bits.end()) bits.push_back(bit);
    }
    for (const std::uint64_t bit : bits) {
      faults.flips.push_back(
          {static_cast<std::size_t>(bit / 8), static_cast<std::uint8_t>(1U << bit % 8), false});
    }
  }

  kernel::Random random_;
  std::uint64_t longest_pause_;
  unsigned left_ = 0;
  unsigned pause_ = 20;
};

// What a run through random faults came to.
class Ledger {
 public:
  void add(const MasterBench::FinishedCycle& cycle, bool is_faulted) {
    ++cycles_;
    if (!cycle.is_accepted) ++bad_;
    since_fault_ = is_faulted ? 0 : since_fault_ + 1;
    ++without_data_;
    // Counted up to the cycle that brings data, or up to now: a recovery that never ends is one, too.
    longest_recovery_ = std::max(longest_recovery_, std::min(since_fault_, without_data_));
    if (cycle.is_accepted && cycle.is_data) without_data_ = 0;
    longest_run_ = std::max(longest_run_, without_data_);
  }

  std::uint64_t cycles() const { return cycles_; }
  double share_of_bad() const { return static_cast<double>(bad_) / static_cast<double>(cycles_); }
  std::uint64_t longest_run() const { return longest_run_; }  // of cycles without new data
  std::uint64_t longest_recovery() const { return longest_recovery_; }
  // What follows is a new start, no recovery.
  void forget_recovery() { since_fault_ = without_data_ = 0; }

 private:
  std::uint64_t cycles_ = 0;
  std::uint64_t bad_ = 0;
  std::uint64_t since_fault_ = 0;
  std::uint64_t without_data_ = 0;
  std::uint64_t longest_run_ = 0;
  std::uint64_t longest_recovery_ = 0;
};

// A ring whose first word is another input in each cycle; its second comes back as it is. The application
// may see what was offered in the last accepted data cycle, and nothing else.
class WatchedInputs {
 public:
  explicit WatchedInputs(MasterBench& bench) : bench_(bench), inputs_(bench.random().split("inputs")) {
    offered_ = bench.master().input(0);
    bench.ring().set_signal([this](unsigned word, kernel::Time) {
      if (word == 0) offered_ = static_cast<std::uint16_t>(inputs_.next());
      return word == 0 ? offered_ : std::uint16_t{0};
    });
  }
  void begin() { held_ = bench_.master().input(0); }

  // At the end of a cycle; gives whether the application sees what it may.
  bool are_right() {
    const auto& cycle = bench_.finished();
    if (cycle.is_data && cycle.is_accepted) held_ = offered_;
    return bench_.master().input(0) == held_ && bench_.master().input(1) == 0;
  }

 private:
  MasterBench& bench_;
  kernel::Random inputs_;
  std::uint16_t offered_ = 0;
  std::uint16_t held_ = 0;
};

void judge_run(MasterBench& bench, CaseJudge& judge, const Ledger& ledger, bool goes_on) {
  judge.expect(goes_on, "no_data_cycle", "the master goes on with cycles", "no cycle ends any more");
  judge.expect(bench.is_in_run(), "stopped_without_cause", "the bus runs on after the faults",
               "it has stopped");
  judge.measure("share of rejected cycles", "", ledger.share_of_bad());
  judge.measure("longest run of cycles without new data", "cycles",
                static_cast<double>(ledger.longest_run()));
  judge.expect_between("cycles from the last fault to the next valid data", "cycles",
                       static_cast<double>(ledger.longest_recovery()), 0,
                       static_cast<double>(bench.rules().published_recovery_cycles), "recovery_too_slow");
}

void random_faults(MasterBench& bench, CaseJudge& judge) {
  WatchedInputs inputs(bench);
  bench.run_data_cycles(judge, 1);
  inputs.begin();
  Ledger ledger;
  RandomFaults faults(bench.random().split("faults"), bench.volume<std::uint64_t>(12, 120));
  bool is_faulted = false;
  bench.set_script([&](const CycleInfo& info, CycleFaults& cycle) {
    faults(info, cycle);
    is_faulted = !cycle.is_none();
  });
  bool is_wrong = false;
  bench.on_cycle([&] {
    is_wrong = is_wrong || !inputs.are_right();
    ledger.add(bench.finished(), is_faulted);
  });
  const std::uint64_t cycles = bench.volume<std::uint64_t>(600, 1'000'000);
  const std::uint64_t limit = bench.rules().published_recovery_cycles;
  bool goes_on = true;
  while (goes_on && ledger.cycles() < cycles && !is_wrong && ledger.longest_recovery() <= limit) {
    goes_on = bench.run_cycle();
  }
  bench.on_cycle({});
  judge.expect(!is_wrong, "wrong_inputs_accepted", "no input of a disturbed cycle reaches the application",
               "an input does");
  judge_run(bench, judge, ledger, goes_on);
}

// ---- stresses ----

// What arrived at the master since it was asked last, seen by the tester's own receiver.
class Returned {
 public:
  Returned(const segment::Segment& segment, const interbus::Rules& rules)
      : code_(rules.telegram), view_(segment, code_, rules.bit_rate), model_(rules) {}

  segment::Tap& tap() { return view_; }
  // Whether a whole data cycle with a right check was among it.
  bool has_right_cycle() {
    find_last_cycle(view_.data_telegrams(), cycle_);
    return cycle_.is_found && !cycle_.is_id_cycle && cycle_.check == model_.check().of(cycle_.octets);
  }
  void clear_observations() { view_.clear(); }

 private:
  line::TelegramCode code_;
  LineView view_;
  SlaveModel model_;
  FoundCycle cycle_;
};

// The cycles of a master through bursts, and what they came to.
class StressedRun {
 public:
  explicit StressedRun(MasterBench& bench) : bench_(bench), returned_(bench.segment(), bench.rules()) {}

  void begin(CaseJudge& judge) {
    bench_.tap_arrived(returned_.tap());
    inputs_.emplace(bench_);
    bench_.run_data_cycles(judge, 1);
    inputs_->begin();
    bench_.on_cycle([this] { on_cycle(); });
  }

  // One burst, and the cycles after it that bring valid data again.
  void suffer(const fault::Stress& stress) {
    bench_.begin_stress(stress);
    const kernel::Time end = bench_.now() + stress.duration;
    while (is_going_on() && bench_.now() < end) goes_on_ = bench_.run_cycle();
    bench_.end_stress();
    for (unsigned n = 0; is_going_on() && n <= bench_.rules().published_recovery_cycles; ++n) {
      goes_on_ = bench_.run_cycle();
    }
  }

  bool is_wrong() const { return is_wrong_; }
  bool is_going_on() const { return goes_on_ && !is_wrong_; }
  const Ledger& ledger() const { return ledger_; }
  std::uint64_t unseen() const { return unseen_; }

  // The bus has stopped for a reason: as many bad cycles in a row as the master waits for. Starts it again.
  bool restart_if_stopped() {
    const bool has_cause = bad_in_a_row_ >= bench_.rules().stop_after_bad_cycles;
    if (bench_.status().state != interbus::MasterState::bus_stop || !has_cause) return false;
    ++stops_;
    bench_.on_cycle({});
    bench_.start();
    goes_on_ = bench_.wait_for_run();
    inputs_->begin();
    ledger_.forget_recovery();
    bench_.on_cycle([this] { on_cycle(); });
    return goes_on_;
  }
  std::uint64_t stops() const { return stops_; }

 private:
  // What the check does not see is no fault of the master: the cycle arrived wrong with a right check.
  void on_cycle() {
    const std::uint64_t changed = bench_.stressed_transmissions();
    const bool is_faulted = changed != changed_;
    changed_ = changed;
    if (!inputs_->are_right()) {
      const bool is_unseen = is_faulted && returned_.has_right_cycle();
      if (is_unseen) ++unseen_;
      is_wrong_ = is_wrong_ || !is_unseen;
      inputs_->begin();
    }
    returned_.clear_observations();
    bad_in_a_row_ = bench_.finished().is_accepted ? 0 : bad_in_a_row_ + 1;
    ledger_.add(bench_.finished(), is_faulted);
  }

  MasterBench& bench_;
  Returned returned_;
  std::optional<WatchedInputs> inputs_;
  Ledger ledger_;
  std::uint64_t changed_ = 0;
  std::uint64_t bad_in_a_row_ = 0;
  std::uint64_t unseen_ = 0;
  std::uint64_t stops_ = 0;
  bool is_wrong_ = false;
  bool goes_on_ = true;
};

void stresses(MasterBench& bench, CaseJudge& judge) {
  FIELDPROOF_CHECK(!bench.stresses().empty(), "a case under stresses has some");
  StressedRun run(bench);
  run.begin(judge);
  for (const fault::Stress& stress : bench.stresses()) {
    for (unsigned burst = 0; burst < bench.volume(1U, 10U); ++burst) {
      run.suffer(stress);
      if (!run.is_going_on() && !run.restart_if_stopped()) break;
    }
    if (!run.is_going_on()) break;
  }
  bench.on_cycle({});
  judge.expect(!run.is_wrong(), "wrong_inputs_accepted",
               "no input of a disturbed cycle reaches the application", "an input does");
  judge.measure("transmissions struck by a pulse", "", static_cast<double>(bench.stressed_transmissions()));
  judge.measure("cycles that arrived wrong with a right check", "", static_cast<double>(run.unseen()));
  judge.measure("stops of the bus after ten bad cycles", "", static_cast<double>(run.stops()));
  judge_run(bench, judge, run.ledger(), run.is_going_on());
}

}  // namespace

std::vector<MasterCase> master_immunity_cases() {
  const judge::Reference recovery{"Beckhoff BC4000 documentation; check theory",
                                  "5 cycle times after an error; up to 3 bit errors found",
                                  Standing::searched};
  const MasterStep fast =
      in_run([](MasterBench& bench) { bench.rules().software_time = 10 * kernel::kMicrosecond; });
  return {
      master_case(
          "application/no_wrong_input_under_random_faults", "IM-40",
          "No input of a disturbed cycle reaches the application, and valid data come again within 5 cycles",
          recovery, {"must", "long", "declared_faults"},
          {{"own_check_ignored", "wrong_inputs_accepted"},
           {"inputs_taken_before_check", "wrong_inputs_accepted"},
           {"silent_after_error", "no_data_cycle"},
           {"id_cycles_for_ever_after_error", "recovery_too_slow"}},
          {.steps =
               {fast,
                step("bursts of up to 6 cycles with declared random faults on the return line, 1e6 cycles",
                     "no wrong input; at most 5 cycles to valid data", random_faults)}}),
      resting_also_on(
          {{"this project", "what a level of IEC 61000-4-4 does at a receiver is an uncalibrated model",
            Standing::own},
           {"wrong_inputs_accepted"}},
          master_case(
              "immunity/no_wrong_input_under_bursts", "IM-40",
              "No input of a cycle that a burst disturbed reaches the application, and valid data come again "
              "within 5 cycles, or after a start where the bus had to stop",
              recovery, {"must", std::string(kStressTag)},
              {{"own_check_ignored", "wrong_inputs_accepted"},
               {"inputs_taken_before_check", "wrong_inputs_accepted"},
               {"silent_after_error", "no_data_cycle"},
               {"id_cycles_for_ever_after_error", "no_data_cycle"}},
              {.steps = {fast,
                         step("single bursts of IEC 61000-4-4 that couple into the return line: levels 4 and "
                              "3, 5 and 100 kHz, both polarities",
                              "no wrong input, but of a cycle that arrived wrong with a right check; at most "
                              "5 cycles to valid data; no stop of the bus before ten bad cycles in a row",
                              stresses)}}))};
}

}  // namespace fieldproof::conformance
