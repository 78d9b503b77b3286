#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "conformance/valve_bus/blind_check.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_expect.hpp"

// Bursts on the line of a host. What its PC is told must follow from what arrived: a response that is wrong
// and whose exclusive or fits all the same is told, and no host can know better.
namespace fieldproof::conformance {
namespace {

struct ReadLedger {
  std::uint64_t reads = 0;
  std::uint64_t told_wrong = 0;
  std::uint64_t failed = 0;
  std::array<std::uint64_t, 4> by_attempt{};  // at 1, 2, 3: told at the first, second, third poll
};

std::string arrived_text(HostBench& bench) {
  std::vector<std::string> texts;
  for (const ArrivedFrame& frame : bench.arrived()) {
    texts.push_back(
        fmt::format("{:02X}{}", fmt::join(frame.octets, " "), frame.is_spoilt ? " (spoilt)" : ""));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

void expect_told_follows(HostBench& bench, CaseJudge& judge, const valve_bus::HostResponse& told,
                         kernel::Time when) {
  const bool follows = std::ranges::any_of(bench.arrived(), [&](const ArrivedFrame& frame) {
    return frame.is_response() && frame.octets[0] == told.data0 && frame.octets[1] == told.data1 &&
           frame.end <= when;
  });
  judge.expect(follows, "told_without_response", [&] {
    return Mismatch{{fmt::format("only what arrived is reported to the PC: {}", arrived_text(bench))},
                    fmt::format("{:02X} {:02X} of node {:02X}", told.data0, told.data1, told.id),
                    when};
  });
}

// Answers each poll of one read until the PC is told how it ended. Gives how many there were.
unsigned answer_until_told(HostBench& bench, CaseJudge& judge, HostFrame frame,
                           const valve_bus::Response& response) {
  for (unsigned poll = 1;; ++poll) {
    bench.answer(response);
    bench.await(bench.observation_timeout());
    if (bench.was_told()) return poll;
    judge.expect(poll < bench.rules().read_attempts, "polled_too_often", "three attempts in all",
                 "a fourth one, or nothing at all");
    frame = expect_retry(bench, judge, frame);
  }
}

void read_under_stress(HostBench& bench, CaseJudge& judge, ReadLedger& ledger) {
  bench.clear_observations();
  const valve_bus::Response response{bench.random_octet(), bench.random_octet()};
  const unsigned polls =
      answer_until_told(bench, judge, order_read(bench, judge, bench.random_id()), response);
  ++ledger.reads;
  const std::optional<HostEvent> told = bench.next_told({});
  const auto* seen = std::get_if<valve_bus::HostResponse>(&told->what);
  if (seen == nullptr) {
    ++ledger.failed;
    bench.wait(bench.delimiter());  // in which old data may be told
    return;
  }
  expect_told_follows(bench, judge, *seen, told->when);
  ++ledger.by_attempt.at(std::min<std::size_t>(polls, ledger.by_attempt.size() - 1));
  if (valve_bus::Response{seen->data0, seen->data1} != response) ++ledger.told_wrong;
}

void bursts_tell_nothing_by_themselves(HostBench& bench, CaseJudge& judge) {
  ReadLedger ledger;
  for (int round = 0; round < bench.volume(4, 100); ++round) {
    for (const fault::Stress& stress : bench.stresses()) {
      bench.begin_stress(stress);
      const kernel::Time until = bench.now() + stress.duration;
      while (bench.now() < until) read_under_stress(bench, judge, ledger);
      bench.end_stress();
      expect_host_recovers(bench, judge);
    }
  }
  judge.measure("reads under bursts", "", static_cast<double>(ledger.reads));
  judge.measure("characters that arrived otherwise", "", static_cast<double>(bench.stressed_transmissions()));
  for (std::size_t poll = 1; poll < ledger.by_attempt.size(); ++poll) {
    judge.measure(fmt::format("reported at poll {}", poll), "",
                  static_cast<double>(ledger.by_attempt.at(poll)));
  }
  judge.measure("reads that failed", "", static_cast<double>(ledger.failed));
  judge.measure("wrong data reported", "", static_cast<double>(ledger.told_wrong));
  if (bench.stressed_transmissions() == 0) {
    judge.inconclusive("nothing_was_hit", {{"bursts change characters"}, "no character arrived otherwise"});
  }
  warn_of_blind_check(judge, ledger.told_wrong, ledger.reads,
                      "reads under bursts were reported with wrong data");
}

}  // namespace

std::vector<HostCase> host_immunity_cases() {
  std::vector<HostCase> cases;
  cases.push_back(
      {{.id = "valve_bus/host/immunity/bursts_tell_nothing_by_themselves",
        .purpose = "RH-36",
        .requirement = "Under bursts the PC gets what arrives with a check that fits, or that a "
                       "read has failed, within three polls; after a burst reads are served.",
        .reference = valve_sources::paper("block check; use in disturbed surroundings"),
        .details = {{valve_sources::own("a read that failed is repeated twice"), {"polled_too_often"}},
                    {valve_sources::calculated("errors in one column"), {std::string(kCheckDoesNotSeeIt)}}},
        .stimulus = "Bursts of IEC 61000-4-4, 5 and 100 kHz, both polarities, the two highest "
                    "levels, while reads go on that are all answered.",
        .expected = "Each response that is reported follows from a frame that arrived; wrong data "
                    "whose exclusive or fits are counted. Each read ends.",
        .tags = {"must", std::string(kStressTag)},
        .catches = {{"response_not_checked", "told_without_response"},
                    {"stop_bits_not_looked_at", "told_without_response"}}},
       bursts_tell_nothing_by_themselves});
  return cases;
}

}  // namespace fieldproof::conformance
