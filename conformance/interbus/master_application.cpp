// Chapter application: what the application sees of good and bad cycles (IM-21 to IM-23).
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conformance/interbus/master_scene.hpp"

namespace fieldproof::conformance {

namespace {

using namespace master_chart;
using interbus::CycleFaults;
using judge::Standing;

// Random, and told from 0; the ring offers the opposite from then on.
MasterStep held_inputs() {
  return stimulus<RingScene>("2 data cycles", [](RingScene& scene) {
    scene.held = static_cast<std::uint16_t>(scene.bench.random().next() | 0x0100);
    scene.bench.ring().set_input(0, scene.held);
    scene.bench.run_data_cycles(scene.judge, 2);
    scene.bench.ring().set_input(0, static_cast<std::uint16_t>(~scene.held));
  });
}

MasterStep spoilt_cycle(std::string reason) {
  return {"a spoilt data cycle in which the ring offers other inputs",
          "the application sees the inputs of the cycle before",
          [reason = std::move(reason)](RingScene& scene) {
            scene.bench.set_script([](const auto& info, CycleFaults& faults) {
              if (!info.is_id_cycle) spoil(faults);
            });
            do {
              expect_next_cycle(scene.bench, scene.judge);
            } while (!scene.bench.finished().is_data);
            scene.bench.set_script({});
            const std::uint16_t seen = scene.bench.master().input(0);
            scene.judge.expect(seen == scene.held, seen == 0 ? "inputs_not_held" : reason,
                               fmt::format("the inputs before the bad cycle, {:04X}h", scene.held),
                               fmt::format("{:04X}h", seen));
          }};
}

void held_up_to_new(RingScene& scene) {
  MasterBench& bench = scene.bench;
  while (!(bench.finished().is_data && bench.finished().is_accepted)) {
    scene.judge.expect(bench.master().input(0) == scene.held, "inputs_not_held",
                       "held up to the first good cycle", "changed before");
    expect_next_cycle(bench, scene.judge);
  }
  scene.judge.expect(bench.master().input(0) == static_cast<std::uint16_t>(~scene.held), "new_inputs_missed",
                     "the inputs of the first good cycle", "older inputs");
}

// The writings of an application that sets all words to the number of the writing, and what the ring latched
// of them. Outputs go out with the cycle that follows the writing at the latest: that one starts within a
// cycle time, and is latched within another.
class Writings {
 public:
  Writings(kernel::Duration at_most, kernel::Time now) : at_most_(at_most), at_{now} {}

  std::uint16_t next(kernel::Time now) {
    at_.push_back(now);
    return last();
  }
  void on_latched(std::span<const std::uint16_t> outputs, kernel::Time when) {
    const std::uint16_t first = outputs.front();
    is_torn = is_torn || std::ranges::any_of(outputs, [&](std::uint16_t word) { return word != first; });
    is_late = is_late || first < seen_ || first > last() || is_overdue(when);
    seen_ = std::max(seen_, std::min(first, last()));
  }
  // Whether a writing should have been latched by now, and was not.
  bool is_overdue(kernel::Time now) const { return seen_ < last() && now - at_[seen_ + 1U] > at_most_; }

  bool is_torn = false;
  bool is_late = false;  // or something that was never written

 private:
  std::uint16_t last() const { return static_cast<std::uint16_t>(at_.size() - 1); }

  kernel::Duration at_most_;
  std::vector<kernel::Time> at_;  // by number; 0 is what was there before
  std::uint16_t seen_ = 0;
};

void whole_outputs(MasterBench& bench, CaseJudge& judge) {
  const auto words = static_cast<unsigned>(bench.ring().word_count());
  const kernel::Duration cycle = bench.cycle_time();
  Writings writings(2 * cycle, bench.now());
  bench.ring().on_outputs(
      [&](std::span<const std::uint16_t> outputs, kernel::Time when) { writings.on_latched(outputs, when); });
  const auto expect_whole = [&] {
    judge.expect(!writings.is_torn, "outputs_torn", "all output words of one writing of the application",
                 "words of two writings in one cycle");
    judge.expect(!writings.is_late, "outputs_late", "outputs go with the cycle that follows the writing",
                 "they go later");
    judge.expect(!writings.is_overdue(bench.now()), "outputs_not_sent",
                 "outputs are latched within two cycle times of the writing", "they are not");
  };
  for (int n = bench.volume(30, 5000); n > 0; --n) {
    bench.run_for(kernel::Duration{bench.random().between(1, cycle.count())});
    const std::uint16_t written = writings.next(bench.now());
    for (unsigned word = 0; word < words; ++word) bench.write_output(word, written);
    expect_whole();
  }
  // So that the last writing is judged as the others.
  bench.run_for(2 * cycle + kernel::kPicosecond);
  expect_whole();
  bench.ring().on_outputs(nullptr);
}

}  // namespace

std::vector<MasterCase> master_application_cases() {
  const judge::Reference held{"literature from memory", "inputs of a rejected cycle are discarded",
                              Standing::memory};
  const MasterStep spoilt = spoilt_cycle("inputs_not_held");
  return {
      master_case(
          "application/inputs_of_a_rejected_cycle_are_discarded", "IM-21",
          "The application never sees inputs of a rejected cycle", held, {"must"},
          {{"inputs_taken_before_check", "rejected_inputs_seen"},
           {"inputs_zeroed_on_error", "inputs_not_held"}},
          {{10, 1000}, {held_inputs(), spoilt_cycle("rejected_inputs_seen"), data_cycles(1)}, {in_run()}}),
      master_case("application/inputs_hold_through_bad_cycles", "IM-22",
                  "Inputs hold through 5 bad cycles up to the first good one", held, {"must"},
                  {{"inputs_zeroed_on_error", "inputs_not_held"}},
                  {.steps = {in_run(),
                             held_inputs(),
                             spoilt,
                             spoilt,
                             spoilt,
                             spoilt,
                             spoilt,
                             {"good cycles", "held up to the first good data cycle, then the new inputs",
                              held_up_to_new}}}),
      master_case("application/outputs_change_as_a_whole", "IM-23",
                  "A set of outputs that the application writes goes out whole, with the next cycle",
                  {"Phoenix Contact UK; literature from memory", "consistency of the process image",
                   Standing::memory},
                  {"must"},
                  {{"outputs_torn", "outputs_torn"},
                   {"outputs_one_cycle_late", "outputs_late"},
                   {"silent_after_first_data_cycle", "outputs_not_sent"}},
                  {.steps = {in_run("four stations", interbus::line_of(4, 0x0203, 2)),
                             step("the application writes all words at random instants of the cycle",
                                  "no mixture of two sets, none later", whole_outputs)}})};
}

}  // namespace fieldproof::conformance
