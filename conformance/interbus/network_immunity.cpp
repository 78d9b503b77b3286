#include <fmt/format.h>

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <string>

#include "conformance/interbus/network_bench.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/frame_check_16.hpp"

// A whole network under bursts: whatever they do, no application gets a word that nobody sent.
namespace fieldproof::conformance {
namespace {

using interbus::ExchangeOracle;
using interbus::MasterState;

constexpr std::int64_t kQuickRounds = 10;  // most of a second of bursts
constexpr kernel::Duration kFullBursts = 60 * kernel::kSecond;
// A frame check lets some of what is broken pass: so rare a number of wrong cycles is no chance any more.
constexpr double kImpossible = 1e-6;

class BurstExchange {
 public:
  BurstExchange(NetworkBench& bench, CaseJudge& judge)
      : bench_(bench),
        judge_(judge),
        oracle_(bench.begin_exchange()),
        check_bits_(line::frame_check_named(bench.network().rules.frame_check).width) {}

  void run() {
    bench_.run_cycles(3);
    oracle_.begin();
    for (std::int64_t round = 0; round < rounds(); ++round) {
      for (const fault::Stress& stress : bench_.stresses()) {
        suffer(stress);
        recover();
        judge_words();
      }
    }
    measure();
  }

 private:
  std::int64_t rounds() const {
    kernel::Duration one{};
    for (const fault::Stress& stress : bench_.stresses()) one += stress.duration;
    return bench_.volume<std::int64_t>(kQuickRounds, kFullBursts / one + 1);
  }

  void suffer(const fault::Stress& stress) {
    bench_.begin_stress(stress);
    bench_.segment().run_for(stress.duration);
    bench_.end_stress();
    struck_time_ += stress.duration;
  }

  void recover() {
    bench_.run_cycles(bench_.network().rules.published_recovery_cycles);
    const MasterState state = bench_.status().state;
    if (state == MasterState::run || state == MasterState::identification || state == MasterState::locating)
      return;
    ++starts_;
    judge_.expect(bench_.bring_up(), "network_does_not_run_again",
                  "data cycles behind a start of the master, on a quiet line", "none");
  }

  // Of what arrived broken the frame check lets a share pass: of random patterns one in 2^width.
  void judge_words() {
    const std::uint64_t wrong = oracle_.ledger().wrong_cycles;
    if (wrong == 0) return;
    const double expected =
        std::ldexp(static_cast<double>(bench_.stressed_transmissions()), -static_cast<int>(check_bits_));
    const double chance = expected > 0 ? boost::math::gamma_p(static_cast<double>(wrong), expected) : 0.0;
    const ExchangeOracle::WrongWord& first = *oracle_.first_wrong();
    judge_.expect(
        chance >= kImpossible, first.is_output ? "wrong_output_accepted" : "wrong_input_accepted", [&] {
          return Sighting{
              {fmt::format("{}: {:04X}h, which was sent; or the words before", place_of(first), first.sent),
               fmt::format("at most what passes a check of {} bits by chance: {:.2g} cycles of {} "
                           "broken transmissions",
                           check_bits_, expected, bench_.stressed_transmissions())},
              fmt::format("{:04X}h; {} cycles with wrong words", first.got, wrong),
              first.when};
        });
  }

  std::string place_of(const ExchangeOracle::WrongWord& wrong) const {
    int position = 1;
    while (position < static_cast<int>(bench_.ring().size()) &&
           bench_.ring().first_word(position + 1) <= wrong.word) {
      ++position;
    }
    return fmt::format("{} word {} of station {}", wrong.is_output ? "output" : "input",
                       wrong.word - bench_.ring().first_word(position), position);
  }

  void measure() {
    const interbus::ErrorLedger& ledger = oracle_.ledger();
    const auto tell = [this](const char* what, const char* unit, double value) {
      judge_.measure(what, unit, value);
    };
    tell("bursts", "s", static_cast<double>(struck_time_.count()) * 1e-12);
    tell("data cycles", "", static_cast<double>(ledger.sent));
    tell("transmissions struck by a pulse", "", static_cast<double>(bench_.stressed_transmissions()));
    tell("cycles rejected by the master", "", static_cast<double>(ledger.detected));
    tell("cycles with wrong words", "", static_cast<double>(ledger.wrong_cycles));
    tell("starts behind a stop of the bus", "", static_cast<double>(starts_));
  }

  NetworkBench& bench_;
  CaseJudge& judge_;
  ExchangeOracle& oracle_;
  unsigned check_bits_;
  kernel::Duration struck_time_{};
  std::uint64_t starts_ = 0;
};

void words_under_bursts(NetworkBench& bench, CaseJudge& judge) {
  FIELDPROOF_CHECK(!bench.stresses().empty(), "a case under stresses has some");
  judge.expect(bench.bring_up(), "network_does_not_run", "data cycles on a quiet line", "none");
  BurstExchange(bench, judge).run();
}

}  // namespace

std::vector<NetworkCase> network_immunity_cases() {
  TestCase test_case;
  test_case.id = "interbus/network/immunity/no_wrong_word_is_accepted_under_bursts";
  test_case.requirement =
      "Under bursts the applications of master and stations keep old words or get those that were sent, but "
      "for what a frame check of this width lets pass; behind a burst the network goes on, or does so after "
      "a start.";
  test_case.reference = sources::derived("every cycle is checked; data of a rejected one are not taken over");
  test_case.stimulus =
      "Bursts of IEC 61000-4-4 on all cables of the remote bus, 5 and 100 kHz, both polarities, the two "
      "highest levels, while all words change from cycle to cycle: each ten times, or a minute of them.";
  test_case.expected = "No more cycles with wrong words than chance explains; data cycles behind each burst.";
  test_case.tags = {"must", std::string(kStressTag)};
  test_case.catches = {{"slave_latches_in_spite_of_its_check", "wrong_output_accepted"},
                       {"master_does_not_check", "wrong_input_accepted"}};
  test_case.parts = {"slave", "master"};
  return {{std::move(test_case), words_under_bursts}};
}

}  // namespace fieldproof::conformance
