// Cases for a whole network: what its description promises must be seen on its lines and at its terminals.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "conformance/interbus/network_bench.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::MasterState;

double microseconds(kernel::Duration duration) {
  return static_cast<double>(duration.count()) * 1e-6;
}

void bring_up(NetworkBench& bench, CaseJudge& judge) {
  judge.expect(bench.bring_up(), "network_does_not_run", [&] {
    const interbus::MasterStatus status = bench.status();
    return Mismatch{{"data cycles within ten seconds"},
                    fmt::format("{} stations found; {}", status.stations.size(),
                                status.configuration_error.empty() ? "no configuration error"
                                                                   : status.configuration_error)};
  });
}

void recognises_the_described_topology(NetworkBench& bench, CaseJudge& judge) {
  bring_up(bench, judge);
  const interbus::MasterStatus status = bench.status();
  judge.expect_equal(status.stations.size(), bench.places().size(), "other_stations_found", "stations found");
  for (std::size_t n = 0; n < status.stations.size(); ++n) {
    const interbus::RingPlace& place = bench.places()[n];
    const interbus::FoundStation& found = status.stations[n];
    judge.expect(
        found == interbus::FoundStation{place.station->id_code, place.words, place.before, place.on_branch},
        "other_stations_found", [&] {
          return Mismatch{{fmt::format("station {}: {} with ID code {:04X}h and {} words", n + 1,
                                       place.station->name, place.station->id_code, place.words)},
                          fmt::format("ID code {:04X}h, {} words", found.id_code, found.words)};
        });
  }
}

// Cycle times between consecutive data cycles on the master's output.
std::vector<kernel::Duration> measured_cycles(NetworkBench& bench, std::int64_t count) {
  bench.keep_starts();
  bench.run_cycles(count);
  std::vector<kernel::Duration> cycles;
  const auto& starts = bench.data_cycle_starts();
  for (std::size_t n = 1; n < starts.size(); ++n) cycles.push_back(starts[n] - starts[n - 1]);
  return cycles;
}

// What the structure of the network's frame takes, or what it asks for beyond that.
kernel::Duration promised_cycle_time(const interbus::NetworkDescription& network) {
  const kernel::Duration shortest = interbus::structural_cycle_time(network);
  return network.cycle_time ? std::max(*network.cycle_time, shortest) : shortest;
}

void cycle_time_is_that_of_the_formula(NetworkBench& bench, CaseJudge& judge) {
  bring_up(bench, judge);
  const interbus::NetworkDescription& network = bench.network();
  const auto cycles = measured_cycles(bench, bench.cycle_volume(20, 1000));
  judge.expect(!cycles.empty(), "no_data_cycles", "data cycles on the master's output", "none");
  kernel::Duration sum{};
  for (const kernel::Duration cycle : cycles) sum += cycle;
  const double mean = microseconds(sum) / static_cast<double>(cycles.size());
  // The formula that the network names may describe another frame, or another vendor's chip: it is told
  // beside.
  judge.measure(fmt::format("cycle time by {}", interbus::name(network.formula)), "us",
                microseconds(interbus::cycle_time(network.formula, interbus::timing_input(network))));
  const double promised = microseconds(promised_cycle_time(network));
  judge.expect_between("cycle time", "us", mean, promised * 0.999, promised * 1.001,
                       "cycle_time_off_formula");
}

void cycles_do_not_jitter(NetworkBench& bench, CaseJudge& judge) {
  bring_up(bench, judge);
  const auto cycles = measured_cycles(bench, bench.cycle_volume(50, 10'000));
  judge.expect(!cycles.empty(), "no_data_cycles", "data cycles on the master's output", "none");
  const auto [shortest, longest] = std::ranges::minmax(cycles);
  judge.expect_between("cycle jitter, peak to peak", "us", microseconds(longest - shortest), 0,
                       0.01 * microseconds(cycles.front()), "cycles_jitter");
}

void every_word_is_exchanged(NetworkBench& bench, CaseJudge& judge) {
  bring_up(bench, judge);
  const unsigned words = bench.ring().word_count();
  for (int round = 0; round < bench.volume(3, 100); ++round) {
    std::vector<std::uint16_t> outputs(words);
    std::vector<std::uint16_t> inputs(words);
    for (unsigned word = 0; word < words; ++word) {
      outputs[word] = static_cast<std::uint16_t>(bench.random().next());
      inputs[word] = static_cast<std::uint16_t>(bench.random().next());
      bench.master().write_output(word, outputs[word], bench.segment().now());
    }
    const auto for_each_word = [&](const auto& visit) {
      unsigned word = 0;
      for (std::size_t n = 0; n < bench.places().size(); ++n) {
        for (unsigned k = 0; k < bench.places()[n].words; ++k) visit(static_cast<int>(n) + 1, k, word++);
      }
    };
    for_each_word([&](int position, unsigned k, unsigned word) {
      bench.ring().terminals(position).set_input(k, inputs[word]);
    });
    bench.run_cycles(3);
    for_each_word([&](int position, unsigned k, unsigned word) {
      // A copied word is the application's, not the case's.
      const bool is_copied = std::ranges::any_of(bench.network().copy, [&](const interbus::CopyRule& rule) {
        return rule.to == bench.places()[static_cast<std::size_t>(position - 1)].station->name &&
               rule.output_word == k;
      });
      const std::uint16_t seen = bench.ring().terminals(position).output_at(k, bench.segment().now());
      judge.expect(is_copied || seen == outputs[word], "wrong_output", [&] {
        return Mismatch{{fmt::format("station {} output word {}: {:04X}h", position, k, outputs[word])},
                        fmt::format("{:04X}h", seen)};
      });
      const std::uint16_t read = bench.master().input(word);
      judge.expect(read == inputs[word], "wrong_input", [&] {
        return Mismatch{
            {fmt::format("input word {} of station {} in the master: {:04X}h", k, position, inputs[word])},
            fmt::format("{:04X}h", read)};
      });
    });
  }
}

struct CopiedWord {
  int from;
  int to;
  const interbus::CopyRule* rule;
};

std::vector<CopiedWord> copied_words(const NetworkBench& bench) {
  const auto position = [&](const std::string& name) {
    const auto at =
        std::ranges::find(bench.places(), name, [](const auto& place) { return place.station->name; });
    return static_cast<int>(at - bench.places().begin()) + 1;
  };
  std::vector<CopiedWord> copied;
  for (const interbus::CopyRule& rule : bench.network().copy) {
    copied.push_back({position(rule.from), position(rule.to), &rule});
  }
  return copied;
}

void inputs_reach_their_outputs(NetworkBench& bench, CaseJudge& judge) {
  bring_up(bench, judge);
  for (int round = 0; round < bench.volume(3, 200); ++round) {
    const auto value = static_cast<std::uint16_t>(bench.random().next());
    bench.run_behind_sampling();
    for (const CopiedWord& word : copied_words(bench)) {
      bench.ring().terminals(word.from).set_input(word.rule->input_word, value);
    }
    // The edge has just missed a cycle: it goes in with the next and out with the one after it (latch model
    // M2).
    bench.run_cycles(3);
    for (const CopiedWord& word : copied_words(bench)) {
      const std::uint16_t seen =
          bench.ring().terminals(word.to).output_at(word.rule->output_word, bench.segment().now());
      judge.expect(seen == value, "input_not_at_output", [&] {
        return Mismatch{{fmt::format("{} word {} at {} word {} within three cycles: {:04X}h", word.rule->from,
                                     word.rule->input_word, word.rule->to, word.rule->output_word, value)},
                        fmt::format("{:04X}h", seen)};
      });
    }
  }
}

void nothing_is_rejected(NetworkBench& bench, CaseJudge& judge) {
  bring_up(bench, judge);
  for (int cycle = 0; cycle < bench.volume(20, 2000); ++cycle) {
    for (std::size_t n = 0; n < bench.places().size(); ++n) {
      for (unsigned word = 0; word < bench.places()[n].words; ++word) {
        bench.ring()
            .terminals(static_cast<int>(n) + 1)
            .set_input(word, static_cast<std::uint16_t>(bench.random().next()));
      }
    }
    bench.run_cycles(1);
  }
  judge.expect_equal(bench.status().state == MasterState::run, true, "network_left_run",
                     "the master is in run");
  // From the first cycle of the recognition on.
  judge.expect_equal(bench.status().rejected_cycles, 0U, "cycles_rejected", "rejected cycles");
}

void canary(NetworkBench& bench, CaseJudge& judge) {
  bring_up(bench, judge);
  judge.fail("canary", {{"nothing: this case fails to show that a failure is seen"}, "a network that runs"});
}

TestCase network_case(std::string chapter_and_words, std::string requirement, judge::Reference reference,
                      std::string stimulus, std::string expected, std::vector<std::string> tags,
                      std::vector<MustCatch> catches) {
  TestCase test_case;
  test_case.id = "interbus/network/" + std::move(chapter_and_words);
  test_case.requirement = std::move(requirement);
  test_case.reference = std::move(reference);
  test_case.stimulus = std::move(stimulus);
  test_case.expected = std::move(expected);
  test_case.tags = std::move(tags);
  test_case.catches = std::move(catches);
  test_case.parts = {"slave", "master"};
  return test_case;
}

std::vector<NetworkCase> make_cases() {
  using judge::Standing;
  const judge::Reference park_cycle{"Park 2004", "section 2.2, cycle time of INTERBUS", Standing::seed};
  const judge::Reference park_copy{"Park 2004", "section 3, pre-process task", Standing::seed};
  const judge::Reference park_principle{
      "Park 2004", "section 2.1, data structure and principle of transmission", Standing::seed};
  const judge::Reference deterministic{"Park 2004", "section 1, a cycle always lasts equally long",
                                       Standing::seed};
  return {
      {network_case("start_up/described_topology_is_recognised",
                    "The master finds the stations of the network at their places, and data cycles run.",
                    park_principle, "Power-up of the master on a ring of stations in reset.",
                    "Every station with its ID code, register length and the interface on which it hangs.",
                    {"must"},
                    {{"slave_declares_another_id_code", "network_does_not_run"},
                     {"master_misses_branches", "network_does_not_run"}}),
       recognises_the_described_topology},
      {network_case(
           "exchange/every_word_reaches_its_station",
           "Outputs reach their station and inputs the master, word by word, by their place in the ring.",
           park_principle, "Random words on all inputs and in the whole output image, again and again.",
           "The same words at the terminals and in the input image three cycles later.", {"must"},
           {{"master_sends_first_station_first", "wrong_output"}, {"slave_swaps_octets", "wrong_output"}}),
       every_word_is_exchanged},
      {network_case("exchange/inputs_reach_their_outputs",
                    "The copy task carries each input word to its output word.", park_copy,
                    "New values on the copied inputs.", "The value at the output within three cycles.",
                    {"must"}, {{"master_copies_one_cycle_late", "input_not_at_output"}}),
       inputs_reach_their_outputs},
      {network_case(
           "timing/cycle_time_is_that_of_the_formula",
           "The cycle lasts as long as the formula says that the network description names.", park_cycle,
           "Data cycles without errors.",
           "The mean distance of data cycles on the master's output: within 0.1 % of F1 or F4; formulas for "
           "other structures are only compared.",
           {"must", "timing"},
           {{"master_has_generation_3", "cycle_time_off_formula"},
            {"master_leaves_no_gaps", "cycle_time_off_formula"}}),
       cycle_time_is_that_of_the_formula},
      {network_case("timing/cycles_do_not_jitter", "Every cycle lasts equally long.", deterministic,
                    "Data cycles without errors.", "Peak-to-peak jitter of at most 1 % of the cycle time.",
                    {"must", "timing"}, {{"master_wanders", "cycles_jitter"}}),
       cycles_do_not_jitter},
      {network_case("exchange/nothing_is_rejected_without_faults",
                    "Without faults no cycle is rejected and the bus stays in run.", deterministic,
                    "Recognition and data cycles without faults, all inputs changing from cycle to cycle.",
                    "No rejected cycle.", {"must"},
                    {{"slave_sends_check_of_what_it_received", "network_does_not_run"},
                     {"master_rejects_large_changes", "cycles_rejected"},
                     {"master_rejects_first_cycles", "cycles_rejected"}}),
       nothing_is_rejected},
      {network_case("canary/must_fail", "None: this case must fail.", {"this project", "", Standing::own},
                    "None.", "A failure.", {"canary"}, {}),
       canary},
  };
}

}  // namespace

const std::vector<NetworkCase>& network_cases() {
  static const std::vector<NetworkCase> cases = [] {
    std::vector<NetworkCase> all = make_cases();
    for (NetworkCase& one : network_immunity_cases()) all.insert(std::prev(all.end()), std::move(one));
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance
