// Chapter application: what the application sees of good and bad cycles (IM-21 to IM-23).
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conformance/interbus/master_cases.hpp"

namespace fieldproof::conformance {

namespace {

using interbus::CycleFaults;
using judge::Standing;
using CycleInfo = interbus::RingEmulator::CycleInfo;

void spoil(CycleFaults& faults) {
  faults.flips = {{0, 0x01, false}};
}

// The ring offers other inputs in a cycle that is spoilt; gives what the application saw right after it.
std::uint16_t seen_behind_bad_cycle(MasterBench& bench, CaseJudge& judge, std::uint16_t offered) {
  bench.ring().set_input(0, offered);
  bench.set_script([](const CycleInfo& info, CycleFaults& faults) {
    if (!info.is_id_cycle) spoil(faults);
  });
  do {
    judge.expect(bench.run_cycle(), "no_data_cycle", "cycles go on", "no cycle ends");
  } while (!bench.finished().is_data);
  bench.set_script({});
  return bench.master().input(0);
}

void rejected_inputs(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  for (int n = bench.volume(10, 1000); n > 0; --n) {
    const auto good = static_cast<std::uint16_t>(bench.random().next() | 0x0100);
    bench.ring().set_input(0, good);
    bench.run_data_cycles(judge, 2);
    const auto offered = static_cast<std::uint16_t>(~good);
    const std::uint16_t seen = seen_behind_bad_cycle(bench, judge, offered);
    judge.expect(seen == good, seen == 0 ? "inputs_not_held" : "rejected_inputs_seen", [&] {
      return Mismatch{{fmt::format("the inputs before the bad cycle, {:04X}h", good)},
                      fmt::format("{:04X}h", seen)};
    });
    bench.run_data_cycles(judge, 1);
  }
}

void inputs_hold(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  constexpr std::uint16_t kHeld = 0x1234;
  constexpr std::uint16_t kNew = 0x4321;
  bench.ring().set_input(0, kHeld);
  bench.run_data_cycles(judge, 2);
  for (int n = 0; n < 5; ++n) {
    const std::uint16_t seen = seen_behind_bad_cycle(bench, judge, kNew);
    judge.expect(seen == kHeld, "inputs_not_held", [&] {
      return Mismatch{{fmt::format("{:04X}h through bad cycle {}", kHeld, n + 1)},
                      fmt::format("{:04X}h", seen)};
    });
  }
  while (!(bench.finished().is_data && bench.finished().is_accepted)) {
    judge.expect(bench.master().input(0) == kHeld, "inputs_not_held", "held up to the first good cycle",
                 "changed before");
    judge.expect(bench.run_cycle(), "no_data_cycle", "cycles go on", "no cycle ends");
  }
  judge.expect(bench.master().input(0) == kNew, "new_inputs_missed", "the inputs of the first good cycle",
               "older inputs");
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
  bench.bring_up(judge, interbus::line_of(4, 0x0203, 2));
  const auto words = static_cast<unsigned>(bench.ring().word_count());
  const kernel::Duration cycle = bench.status().cycle_time;
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
  std::vector<MasterCase> cases;
  const auto add = [&cases](std::string_view words, std::string_view purpose, std::string_view requirement,
                            judge::Reference reference, std::string_view stimulus, std::string_view expected,
                            std::vector<std::string> tags, std::vector<MustCatch> catches, auto procedure) {
    TestCase test_case;
    test_case.id = fmt::format("interbus/master/application/{}", words);
    test_case.purpose = purpose;
    test_case.requirement = requirement;
    test_case.reference = std::move(reference);
    test_case.stimulus = stimulus;
    test_case.expected = expected;
    test_case.tags = std::move(tags);
    test_case.catches = std::move(catches);
    cases.push_back({std::move(test_case), procedure});
  };
  const judge::Reference held{"literature from memory", "inputs of a rejected cycle are discarded",
                              Standing::memory};
  add("inputs_of_a_rejected_cycle_are_discarded", "IM-21",
      "The application never sees inputs of a rejected cycle", held,
      "a spoilt cycle in which the ring offers other inputs", "the inputs of the cycle before", {"must"},
      {{"inputs_taken_before_check", "rejected_inputs_seen"}, {"inputs_zeroed_on_error", "inputs_not_held"}},
      rejected_inputs);
  add("inputs_hold_through_bad_cycles", "IM-22", "Inputs hold through bad cycles up to the first good one",
      held, "5 spoilt data cycles in a row", "held, then the new inputs", {"must"},
      {{"inputs_zeroed_on_error", "inputs_not_held"}}, inputs_hold);
  add("outputs_change_as_a_whole", "IM-23",
      "A set of outputs that the application writes goes out whole, with the next cycle",
      {"Phoenix Contact UK; literature from memory", "consistency of the process image", Standing::memory},
      "all words written at random instants of the cycle", "no mixture of two sets, none later", {"must"},
      {{"outputs_torn", "outputs_torn"},
       {"outputs_one_cycle_late", "outputs_late"},
       {"silent_after_first_data_cycle", "outputs_not_sent"}},
      whole_outputs);
  return cases;
}

}  // namespace fieldproof::conformance
