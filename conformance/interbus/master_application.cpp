// Chapter application: what the application sees of good and bad cycles (IM-21 to IM-23, IM-40).
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

// The ring offers other inputs in a cycle that is spoilt; gives what the application saw right behind it.
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
      return Sighting{{fmt::format("the inputs before the bad cycle, {:04X}h", good)},
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
      return Sighting{{fmt::format("{:04X}h through bad cycle {}", kHeld, n + 1)},
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

void whole_outputs(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, interbus::line_of(4, 0x0203, 2));
  const auto words = static_cast<unsigned>(bench.ring().word_count());
  std::uint16_t written = 0;
  bool is_torn = false;
  bool is_late = false;
  // The ring takes in a whole cycle at its start, so what was written last is what it must carry.
  bench.ring().on_outputs([&](std::span<const std::uint16_t> outputs, kernel::Time) {
    if (std::ranges::any_of(outputs, [&](std::uint16_t word) { return word != outputs.front(); }))
      is_torn = true;
    if (outputs.front() != written) is_late = true;
  });
  const kernel::Duration cycle = bench.status().cycle_time;
  for (int n = bench.volume(30, 5000); n > 0; --n) {
    bench.run_for(kernel::Duration{bench.random().between(1, cycle.count())});
    ++written;
    for (unsigned word = 0; word < words; ++word) bench.master().write_output(word, written);
    judge.expect(!is_torn, "outputs_torn", "all output words of one writing of the application",
                 "words of two writings in one cycle");
    judge.expect(!is_late, "outputs_late", "outputs go with the cycle that follows the writing",
                 "they go later");
  }
}

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

struct Ledger {
  std::uint64_t wrong = 0;
  std::uint64_t bad = 0;
  std::uint64_t run = 0;
  std::uint64_t longest_run = 0;
  std::uint64_t since_fault = 0;
  std::uint64_t longest_recovery = 0;
};

void random_faults(MasterBench& bench, CaseJudge& judge) {
  bench.rules().software_time = 10 * kernel::kMicrosecond;
  bench.bring_up(judge, paper_ring());
  kernel::Random inputs = bench.random().split("inputs");
  std::uint16_t offered = bench.master().input(0);
  std::uint16_t held = offered;
  // Only the first word is an input; the second comes back as it is.
  bench.ring().set_signal([&](unsigned word, kernel::Time) {
    if (word == 0) offered = static_cast<std::uint16_t>(inputs.next());
    return word == 0 ? offered : std::uint16_t{0};
  });
  Ledger ledger;
  bench.run_data_cycles(judge, 1);
  held = bench.master().input(0);
  RandomFaults faults(bench.random().split("faults"), bench.volume<std::uint64_t>(12, 120));
  bool is_faulted = false;
  bench.set_script([&](const CycleInfo& info, CycleFaults& cycle) {
    faults(info, cycle);
    is_faulted = !cycle.is_none();
  });
  bench.on_cycle([&] {
    const auto& cycle = bench.finished();
    if (cycle.is_data && cycle.is_accepted) held = offered;
    if (bench.master().input(0) != held || bench.master().input(1) != 0) ++ledger.wrong;
    ledger.since_fault = is_faulted ? 0 : ledger.since_fault + 1;
    if (cycle.is_accepted && cycle.is_data) {
      ledger.longest_recovery = std::max(ledger.longest_recovery, ledger.run > 0 ? ledger.since_fault : 0);
      ledger.run = 0;
    } else {
      ++ledger.run;
      if (!cycle.is_accepted) ++ledger.bad;
    }
    ledger.longest_run = std::max(ledger.longest_run, ledger.run);
  });
  const std::uint64_t first = bench.finished().count;
  const std::uint64_t cycles = bench.volume<std::uint64_t>(600, 1'000'000);
  while (bench.finished().count < first + cycles && ledger.wrong == 0 && bench.run_cycle()) {
  }
  bench.on_cycle({});
  judge.expect(ledger.wrong == 0, "wrong_inputs_accepted",
               "no input of a disturbed cycle reaches the application", "an input does");
  judge.expect(bench.is_in_run(), "stopped_without_cause", "the bus runs through bursts of 6 cycles",
               "it has stopped");
  judge.measure("share of rejected cycles", "",
                static_cast<double>(ledger.bad) / static_cast<double>(cycles));
  judge.measure("longest run of cycles without new data", "cycles", static_cast<double>(ledger.longest_run));
  judge.expect_between("cycles from the last fault to the next valid data", "cycles",
                       static_cast<double>(ledger.longest_recovery), 0,
                       bench.rules().published_recovery_cycles, "recovery_too_slow");
}

}  // namespace

std::vector<MasterCase> master_application_cases() {
  std::vector<MasterCase> cases;
  const auto add = [&cases](std::string_view words, std::string_view purpose, std::string_view requirement,
                            judge::Reference reference, std::string_view stimulus, std::string_view expected,
                            std::vector<std::string> tags, std::vector<Catch> catches, auto procedure) {
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
      {{"outputs_torn", "outputs_torn"}}, whole_outputs);
  add("no_wrong_input_under_random_faults", "IM-40",
      "No input of a disturbed cycle reaches the application, and valid data come again within 5 cycles",
      {"Beckhoff BC4000 documentation; check theory",
       "5 cycle times after an error; up to 3 bit errors found", Standing::searched},
      "bursts of up to 6 cycles with declared random faults on the return line, 1e6 cycles",
      "no wrong input; at most 5 cycles to valid data", {"must", "long", "declared_faults"},
      {{"own_check_ignored", "wrong_inputs_accepted"},
       {"inputs_taken_before_check", "wrong_inputs_accepted"}},
      random_faults);
  return cases;
}

}  // namespace fieldproof::conformance
