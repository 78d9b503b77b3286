#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <string>

#include "conformance/interbus/network_bench.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/interbus/timing.hpp"

// A whole network under bursts: whatever they do, no application gets a word that nobody sent.
namespace fieldproof::conformance {
namespace {

using interbus::MasterState;
using network::ErrorStatistics;
using network::ExchangeStatistics;

constexpr std::int64_t kQuickRounds = 10;  // most of a second of bursts
constexpr kernel::Duration kFullBursts = 60 * kernel::kSecond;
constexpr std::int64_t kMostRecoveryCycles = 1000;

// What a right network may accept wrong, of the transmissions that were struck: a check of 16 bits lets one
// random pattern of 2^16 pass, a flipped control level moves the end of the data and passes more often. This
// bound is four times the former, and 20 times what the reference network shows (one cycle of 3 10^5).
constexpr double kAllowedShare = 1.0 / 16384;
// Counts of wrong cycles that are that improbable at the allowed share are no chance.
constexpr double kImpossible = 1e-6;

class BurstExchange {
 public:
  BurstExchange(NetworkBench& bench, CaseJudge& judge)
      : bench_(bench),
        judge_(judge),
        statistics_(bench.begin_exchange()),
        cycle_(std::max(interbus::structural_cycle_time(bench.network()),
                        bench.network().cycle_time.value_or(kernel::Duration{}))) {}

  void run() {
    bench_.segment().run_for(3 * cycle_);
    statistics_.begin();
    for (std::int64_t round = 0; round < rounds(); ++round) {
      for (const fault::Stress& stress : bench_.stresses()) {
        suffer(stress);
        recover();
        judge_words();
      }
    }
    measure();
    if (struck() == 0) {
      judge_.inconclusive("nothing_was_hit", {{"bursts change transmissions"}, "none arrived otherwise"});
    }
  }

 private:
  // By the bursts of the case, and by a plan.
  std::uint64_t struck() const {
    std::uint64_t sum = bench_.stressed_transmissions();
    for (const std::uint64_t hits : bench_.planned_hits()) sum += hits;
    return sum;
  }

  std::int64_t rounds() const {
    kernel::Duration one{};
    for (const fault::Stress& stress : bench_.stresses()) one += stress.duration;
    return std::min(bench_.volume<std::int64_t>(kQuickRounds, kFullBursts / one + 1), affordable_rounds());
  }

  // Fewer on a large ring: each octet of a cycle is received at each station, and a cycle that bursts hit is
  // received at the fine rate.
  std::int64_t affordable_rounds() const {
    constexpr std::int64_t kReceptions = 1'000'000'000;
    constexpr std::int64_t kReceptionsOfAStruckCycle = 64;
    constexpr std::int64_t kCyclesOfRecovery = 3;
    const auto stations = static_cast<std::int64_t>(bench_.ring().size());
    const std::int64_t octets = 2 * std::int64_t{bench_.ring().word_count()} + 8;
    std::int64_t cycles = 0;
    for (const fault::Stress& stress : bench_.stresses()) {
      cycles += (stress.duration / cycle_ + 1) * kReceptionsOfAStruckCycle + kCyclesOfRecovery;
    }
    return std::max<std::int64_t>(1, kReceptions / (cycles * stations * octets));
  }

  void suffer(const fault::Stress& stress) {
    bench_.begin_stress(stress);
    bench_.segment().run_for(stress.duration);
    bench_.end_stress();
    struck_time_ += stress.duration;
  }

  // A network that says that it has stopped may be started again; any other must go on by itself.
  void recover() {
    if (goes_on()) return;
    const MasterState state = bench_.status().state;
    if (state == MasterState::bus_stop || state == MasterState::off) {
      ++starts_;
      if (bench_.bring_up() && goes_on()) return;
    }
    judge_.fail("network_does_not_go_on",
                {{fmt::format("a good data cycle, put out everywhere, within {} cycles after a burst; or "
                              "after a stop of the bus and a start",
                              kMostRecoveryCycles)},
                 fmt::format("none; the master is in state {}", static_cast<int>(bench_.status().state))});
  }

  bool goes_on() {
    const std::uint64_t before = statistics_.good_exchanges();
    for (std::int64_t cycle = 0; cycle < kMostRecoveryCycles; ++cycle) {
      bench_.segment().run_for(cycle_);
      if (statistics_.good_exchanges() > before) return true;
      if (bench_.status().state == MasterState::bus_stop) return false;
    }
    return false;
  }

  void judge_words() {
    statistics_.end();
    const std::uint64_t wrong = statistics_.counts().wrong_exchanges;
    if (wrong == 0) return;
    // Where the bursts of the case are left out, what a plan flips was chosen: there nothing is by chance.
    const double expected =
        bench_.stressed_transmissions() > 0 ? kAllowedShare * static_cast<double>(struck()) : 0.0;
    const double chance = expected > 0 ? boost::math::gamma_p(static_cast<double>(wrong), expected) : 0.0;
    if (chance >= kImpossible) return;
    const network::WrongWord& first = *statistics_.first_wrong();
    const Mismatch sighting{
        {fmt::format("{}: {:04X}h, which was sent; or the words before", place_of(first), first.sent),
         fmt::format("by chance at most {:.2g} cycles with wrong words, of {} struck transmissions", expected,
                     struck())},
        fmt::format("{:04X}h; {} cycles with wrong words", first.got, wrong),
        first.when};
    judge_.fail(is_output(first) ? "wrong_output_accepted" : "wrong_input_accepted", sighting);
  }

  bool is_output(const network::WrongWord& wrong) const {
    return bench_.running().signals()[wrong.signal].is_output;
  }
  std::string place_of(const network::WrongWord& wrong) const {
    return bench_.running().signals()[wrong.signal].name;
  }

  void measure() {
    const ErrorStatistics& counts = statistics_.counts();
    const auto tell = [this](const char* what, const char* unit, double value) {
      judge_.measure(what, unit, value);
    };
    tell("bursts", "s", static_cast<double>(struck_time_.count()) * 1e-12);
    tell("data cycles", "", static_cast<double>(counts.sent));
    tell("transmissions struck by a pulse", "", static_cast<double>(struck()));
    tell("cycles rejected by the master", "", static_cast<double>(counts.detected));
    tell("cycles with wrong words", "", static_cast<double>(counts.wrong_exchanges));
    tell("starts after a stop of the bus", "", static_cast<double>(starts_));
  }

  NetworkBench& bench_;
  CaseJudge& judge_;
  ExchangeStatistics& statistics_;
  kernel::Duration cycle_;
  kernel::Duration struck_time_{};
  std::uint64_t starts_ = 0;
};

void words_under_bursts(NetworkBench& bench, CaseJudge& judge) {
  FIELDPROOF_CHECK(!bench.stresses().empty(), "a case under stresses has some");
  if (bench.network().rules.end_telegrams > 0) {
    throw iut::CannotBeDone(
        "telegrams after the status word hide errors: what moves the end of the data passes each check");
  }
  judge.expect(bench.bring_up(), "network_does_not_run", "data cycles on a quiet line", "none");
  BurstExchange(bench, judge).run();
}

}  // namespace

std::vector<NetworkCase> network_immunity_cases() {
  TestCase test_case;
  test_case.id = "interbus/network/immunity/no_wrong_word_is_accepted_under_bursts";
  test_case.requirement =
      "Under bursts the applications of master and stations keep old words or get those that were sent, but "
      "for the few that pass any check of 16 bits; after a burst the network goes on, or it says that it "
      "has "
      "stopped and does so after a start.";
  test_case.details = {{sources::own("how many wrong cycles are no chance, how soon a network goes on"),
                        {"wrong_output_accepted", "wrong_input_accepted", "network_does_not_go_on"}}};
  test_case.reference = sources::derived("every cycle is checked; data of a rejected one are not taken over");
  test_case.stimulus =
      "Bursts of IEC 61000-4-4 on all cables of the remote bus, 5 and 100 kHz, both polarities, the two "
      "highest levels, while all words change from cycle to cycle: each ten times, or a minute of them.";
  test_case.expected = "No more cycles with wrong words than chance explains; data cycles after each burst.";
  test_case.tags = {"must", std::string(kStressTag)};
  test_case.catches = {{"slave_latches_in_spite_of_its_check", "wrong_output_accepted"},
                       {"master_does_not_check", "wrong_input_accepted"},
                       {"master_falls_silent", "network_does_not_go_on"},
                       {"master_identifies_for_ever", "network_does_not_go_on"}};
  test_case.parts = {"slave", "master"};
  return {{std::move(test_case), words_under_bursts}};
}

}  // namespace fieldproof::conformance
