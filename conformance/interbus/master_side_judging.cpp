#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/interbus/master_side.hpp"
#include "protocols/interbus/network.hpp"

// What no master may do, whatever the reference does: see the list in the header.
namespace fieldproof::conformance {

using interbus::MasterStatus;
using interbus::SeenCycle;
using interbus::VirtualStation;

void MasterSide::judge_cycle(const SeenCycle& sent) {
  if (judge_ == nullptr) return;
  expect(sent.in_phase, "phase_wrong", "headers as the phase requires", sent.describe());
  expect(sent.check_good, "check_wrong", "a check that fits what was sent", sent.describe());
  expect(sent.is_id_cycle != bench_.finished().is_data, "cycle_only_claimed",
         "a cycle of the kind that it reports", sent.describe());
  const Arrival arrival = returned_->judge(sent, bench_.finished().end);
  const bool accepted = bench_.finished().is_accepted;
  expect(!accepted || arrival != Arrival::wrong, "wrong_cycle_accepted", "a cycle with errors is rejected",
         "it is accepted");
  expect(accepted || arrival != Arrival::right, "right_cycle_rejected", "a cycle without errors is accepted",
         "it is rejected");
  judge_inputs(sent, arrival);
  judge_silence();
}

// The words of the last station came first, those of each station in their order.
void MasterSide::judge_inputs(const SeenCycle& sent, Arrival arrival) {
  // Of another ring nobody can say where its words belong.
  if (!is_ring_right_) {
    held_ = bench_.inputs();
    return;
  }
  const bool brings = !sent.is_id_cycle && bench_.finished().is_accepted && arrival != Arrival::wrong;
  std::vector<std::uint16_t> right = held_;
  if (brings) {
    right.clear();
    for (const std::size_t place : input_places()) right.push_back(returned_->word(place));
  }
  const std::vector<std::uint16_t> seen = bench_.inputs();
  // What is held may be of a ring that has other words.
  if (is_running() && seen.size() == right.size() && seen != right) {
    judge_->fail(brings ? "new_inputs_missed" : "inputs_not_held",
                 {{fmt::format("inputs {:04X}h", fmt::join(right, "h "))},
                  fmt::format("{:04X}h", fmt::join(seen, "h "))});
  }
  held_ = seen;
}

// By input word: where it stands among those that come back.
std::vector<std::size_t> MasterSide::input_places() const {
  std::vector<std::size_t> places;
  std::size_t first = bench_.ring().word_count();
  for (const VirtualStation& station : bench_.ring().stations()) {
    first -= station.words;
    for (unsigned word = 0; word < station.words && interbus::has_inputs(station.id_code); ++word)
      places.push_back(first + word);
  }
  return places;
}

// Against the cycles that it has reported since it runs, also where it is in run no more: the last one of a
// stop, and those that look for a fault.
void MasterSide::judge_counters() {
  if (judge_ == nullptr) return;
  const MasterStatus status = bench_.status();
  const auto& ended = bench_.finished();
  const std::uint64_t data = ended.data_count - ended_at_entry_.data_count;
  const std::uint64_t all = ended.count - ended_at_entry_.count;
  judge_->expect_equal(status.data_cycles - at_entry_.data_cycles, data, "counter_wrong", "data cycles");
  judge_->expect_equal(status.id_cycles - at_entry_.id_cycles, all - data, "counter_wrong", "ID cycles");
  if (!is_running()) return;
  judge_->expect_equal(status.rejected_data_cycles - at_entry_.rejected_data_cycles, rejected_data_,
                       "counter_wrong", "rejected data cycles");
  judge_->expect_equal(status.rejected_cycles - at_entry_.rejected_cycles,
                       ended.rejected_count - ended_at_entry_.rejected_count, "counter_wrong",
                       "rejected cycles");
}

void MasterSide::judge_silence() {
  const kernel::Duration longest = bench_.ring().statistics().longest_silence;
  bench_.ring().forget_statistics();
  expect(longest <= bench_.rules().silence_limit, "silence_too_long",
         fmt::format("a telegram each {}", kernel::describe(bench_.rules().silence_limit)),
         kernel::describe(longest));
}

// One cycle that takes the outputs to 0, also when it comes back bad, after one that was under way. Whether
// either brings inputs is the master's choice.
void MasterSide::judge_stop(std::uint64_t first, std::uint64_t under_way) {
  const interbus::RingEmulator& ring = bench_.ring();
  bool is_zero = ring.cycle_count() > first && !ring.last_cycle().is_id_cycle;
  for (unsigned word = 0; word < ring.word_count(); ++word) is_zero = is_zero && ring.output(word) == 0;
  expect(is_zero, "outputs_not_cleared", "a last data cycle with outputs 0", "no such cycle");
  std::uint64_t data_cycles = 0;
  for (std::uint64_t n = first; n < ring.cycle_count() && ring.has_cycle(n); ++n)
    if (!ring.cycle(n).is_id_cycle) ++data_cycles;
  expect(data_cycles <= 1 + under_way, "goes_on_after_a_stop",
         fmt::format("one data cycle after a stop, and {} that was under way", under_way),
         fmt::format("{} data cycles", data_cycles));
  const std::vector<unsigned> words = bench_.input_words();
  for (std::size_t n = 0; n < words.size() && n < held_.size(); ++n) {
    const std::uint16_t seen = bench_.master().input(words[n]);
    expect(seen == held_[n] || seen == ring.input(words[n]), "inputs_not_held",
           "inputs that hold when the bus stops", fmt::format("input word {} is {:04X}h", words[n], seen));
  }
}

// After a stop or a bus stop all stations fall into reset before anything is looked for.
void MasterSide::judge_break() {
  const interbus::Rules& rules = bench_.rules();
  const kernel::Duration least = rules.silence_limit + rules.silence_tolerance;
  const kernel::Duration longest = driven_->longest_silence();
  expect(longest >= least, "silence_too_short",
         fmt::format("{} of silence before the ring is recognised", kernel::describe(least)),
         kernel::describe(longest));
}

void MasterSide::judge_line() {
  if (judge_ == nullptr) return;
  const DrivenTelegrams::Misplaced& misplaced = driven_->misplaced();
  if (!misplaced.reason.empty()) {
    judge_->fail(misplaced.reason,
                 {.expected = {misplaced.expected}, .actual = misplaced.actual, .time = misplaced.when});
  }
}

}  // namespace fieldproof::conformance
