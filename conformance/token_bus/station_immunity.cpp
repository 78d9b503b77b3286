#include <fmt/format.h>

#include <numeric>

#include "conformance/token_bus/station_life.hpp"

// Bursts at the receiver of a station while its neighbours pass the token: it uses what arrives whole, counts
// what does not, and never makes a second token.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::mib;
using token_sources::own;
using token_sources::standard;

struct TokenBurstLedger {
  std::uint64_t tokens = 0;
  std::uint64_t lost = 0;  // that arrived otherwise, and were not used
};

std::uint64_t faults_counted(const TokenBench& bench) {
  const token_bus::Counters counters = bench.counters();
  return std::accumulate(counters.begin(), counters.end(), std::uint64_t{0});
}

// The others have the token.
void expect_no_second_token(TokenScene& scene, std::int64_t octets) {
  scene.expect_silence(scene.bench.octets(octets), "second_token", "another has the token");
}

void others_talk_under_stress(TokenScene& scene) {
  constexpr std::uint64_t kAbove = TokenBench::kAbove;
  TokenBench& bench = scene.bench;
  switch (bench.random().below(4)) {
    case 0:
      scene.send(bench.data_frame(0x62, kOwnAddress, kAbove, bench.numbered_data(40)));
      break;
    case 1:
      scene.send(bench.data_frame(0x62, TokenBench::kBelow, kAbove, bench.numbered_data(10)));
      break;
    case 2:
      scene.send(bench.frame(TokenControl::solicit_1, 0x000C, kAbove));
      break;
    default:
      scene.send(bench.frame(TokenControl::token, TokenBench::kBelow, kAbove));
      break;
  }
  expect_no_second_token(scene, 8);
}

// What it sends until it has passed the token on; its successor takes it.
void expect_use(TokenScene& scene, DrivenFrame one) {
  while (!one.is(TokenControl::token)) {
    scene.judge.expect(one.is_data() || one.is(TokenControl::solicit_1), "second_token", [&] {
      return Mismatch{{"data, a response window, or the token to 0004"}, one.text(), one.begin};
    });
    const auto next = scene.bench.next(scene.bench.now() + scene.bench.slots(2));
    scene.judge.expect(next.has_value(), "token_missing", "the token", "silence");
    one = *next;
  }
  scene.judge.expect(one.destination() == TokenBench::kBelow, "token_wrong", "the token to 0004", one.text());
  scene.bench.wait(scene.bench.octets(8));
  scene.send(scene.bench.frame(TokenControl::token, TokenBench::kAbove, TokenBench::kBelow));
  expect_no_second_token(scene, 8);
}

// 000E passes the token until it sees it used.
void pass_under_stress(TokenScene& scene, TokenBurstLedger& ledger) {
  TokenBench& bench = scene.bench;
  if (bench.random().chance(0.3))
    bench.submit({.destination = TokenBench::kBelow, .data = bench.numbered_data(20)});
  const std::uint64_t changed = bench.stressed_transmissions();
  const std::uint64_t counted = faults_counted(bench);
  ++ledger.tokens;
  scene.send(bench.frame(TokenControl::token, kOwnAddress, TokenBench::kAbove));
  const auto one = bench.next(bench.now() + bench.slots(2));
  if (one) return expect_use(scene, *one);
  ++ledger.lost;
  scene.judge.expect(bench.stressed_transmissions() > changed, "does_not_recover",
                     "a token that arrives as it was sent is used", "silence");
  scene.judge.expect(faults_counted(bench) > counted, "loss_not_counted",
                     "a token that does not arrive whole is a faulty reception",
                     "it is neither used nor counted");
}

// A frame that asks it for set_successor: nothing, where it has counted a faulty reception instead.
bool answers_under_stress(TokenScene& scene, TokenControl asks, std::uint64_t destination,
                          const TokenSpan& span) {
  TokenBench& bench = scene.bench;
  const std::uint64_t changed = bench.stressed_transmissions();
  const std::uint64_t counted = faults_counted(bench);
  scene.send(bench.frame(asks, destination, TokenBench::kAbove));
  const auto one = bench.next(bench.now() + span.latest + bench.octets(8));
  if (faults_counted(bench) > counted) {
    scene.judge.expect(!one, "answers_unasked", "silence: nobody asked that it has understood", "an answer");
    return false;
  }
  scene.judge.expect(one || bench.stressed_transmissions() > changed, "does_not_recover",
                     "an answer to what arrives as it was sent", "silence");
  scene.judge.expect(one.has_value(), "loss_not_counted", "an answer, or a faulty reception", "neither");
  scene.expect_right(*one, {TokenControl::set_successor, TokenBench::kAbove, kOwnAddress}, span,
                     "set_successor to 000E", "answer_wrong");
  return true;
}

void joining_under_bursts(TokenScene& scene) {
  TokenBench& bench = scene.bench;
  for (int round = 0; round < bench.volume(1, 20); ++round) {
    for (const fault::Stress& stress : bench.stresses()) {
      bench.begin_stress(stress);
      const kernel::Time until = bench.now() + stress.duration;
      while (bench.now() < until) {
        const bool has_answered =
            answers_under_stress(scene, TokenControl::solicit_1, TokenBench::kBelow, scene.at_once());
        bench.wait(bench.octets(8));
        // The first two bits of its address are 00.
        if (has_answered)
          answers_under_stress(scene, TokenControl::resolve, TokenBench::kAbove, scene.in_window(3));
        bench.wait(bench.octets(8));
      }
      bench.end_stress();
    }
  }
  if (bench.stressed_transmissions() == 0)
    scene.judge.inconclusive("nothing_was_hit", {{"bursts change frames"}, "none arrived otherwise"});
}

void ring_under_bursts(TokenScene& scene) {
  TokenBench& bench = scene.bench;
  TokenBurstLedger ledger;
  for (int round = 0; round < bench.volume(1, 40); ++round) {
    for (const fault::Stress& stress : bench.stresses()) {
      bench.begin_stress(stress);
      const kernel::Time until = bench.now() + stress.duration;
      while (bench.now() < until) {
        pass_under_stress(scene, ledger);
        others_talk_under_stress(scene);
      }
      bench.end_stress();
      pass_under_stress(scene, ledger);
    }
  }
  scene.judge.measure("tokens under bursts", "", static_cast<double>(ledger.tokens));
  scene.judge.measure("of these, lost", "", static_cast<double>(ledger.lost));
  scene.judge.measure("transmissions that arrived otherwise", "",
                      static_cast<double>(bench.stressed_transmissions()));
  if (bench.stressed_transmissions() == 0)
    scene.judge.inconclusive("nothing_was_hit", {{"bursts change frames"}, "none arrived otherwise"});
}

}  // namespace

std::vector<TokenCase> token_immunity_cases() {
  TestCase test_case = token_must(
      "immunity/bursts_make_no_second_token", "",
      "Under bursts a station uses what arrives whole and counts what does not, sends only while it has the "
      "token, and claims a lost one when its time is over.",
      standard("token pass"),
      {{"counts_to_nine", "loss_not_counted"},
       {"deaf_after_many_faults", "does_not_recover"},
       {"claims_after_faults", "second_token"}},
      {{mib("faulty receptions"), {"loss_not_counted"}}});
  test_case.tags.emplace_back(kStressTag);
  TestCase joining = token_must("immunity/bursts_let_nobody_answer_unasked", "",
                                "Under bursts a station outside of the ring answers the solicitations and "
                                "contests that arrive whole, and "
                                "nothing else; after them it joins.",
                                standard("response windows"), {{"faults_are_contests", "answers_unasked"}},
                                {{mib("faulty receptions"), {"loss_not_counted"}}});
  joining.tags.emplace_back(kStressTag);
  return {
      on_chart(std::move(joining),
               {{},
                {wait(10),
                 TokenStep{"bursts of IEC 61000-4-4 while 000E solicits the station, and resolves contention "
                           "when it answers",
                           "set_successor to what arrives whole, and a faulty reception counted otherwise",
                           joining_under_bursts},
                 joined(), serves()}}),
      on_chart(
          std::move(test_case),
          {{},
           {joined(),
            TokenStep{
                "bursts of IEC 61000-4-4, 5 and 100 kHz, both polarities, the two highest levels, while the "
                "token goes round, and data with it",
                "the token is used or counted as a faulty reception, and nothing is sent without it",
                ring_under_bursts},
            says("the first claim of a token that is lost then", {TokenControl::claim}, after_slots(7),
                 "claim_missing", "claim_wrong")}})};
}

}  // namespace fieldproof::conformance
