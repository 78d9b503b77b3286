#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"

// Link time: TD and CT.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfConfiguration;

void often(FfConfiguration& configuration) {
  configuration.live = {0x11};
  configuration.rules.time_distribution_period = 400 * kernel::kMillisecond;
  configuration.schedule = {
      .version = 1, .macrocycle = 3'200, .items = {{1'600, 0x1120, fieldbus_dll::Priority::normal}}};
}

std::uint64_t time_in(const DrivenDlpdu& td) {
  std::uint64_t ticks = 0;
  for (std::size_t n = 1; n <= 6; ++n) ticks = ticks << 8 | td.octet(n);
  return ticks;
}

void expect_time_goes_on(CaseJudge& judge, const DrivenDlpdu& before, const DrivenDlpdu& td) {
  const auto ticks = static_cast<std::int64_t>(time_in(td) - time_in(before));
  const kernel::Duration passed = td.end - before.end;
  const kernel::Duration told = ticks * fieldbus_dll::kTick;
  judge.expect(
      told <= passed + fieldbus_dll::kTick && told >= passed - fieldbus_dll::kTick, "time_wrong", [&] {
        return Mismatch{
            {fmt::format("{} more, to a tick", kernel::describe(passed))}, kernel::describe(told), td.begin};
      });
}

void time_is_distributed(FfBench& bench, CaseJudge& judge) {
  const kernel::Duration most = bench.rules().time_distribution_period * 95 / 100;
  std::optional<DrivenDlpdu> last;
  kernel::Duration longest{};
  const auto all =
      bench.serve(kernel::kStart + bench.volume(8, 200) * bench.rules().time_distribution_period);
  for (const DrivenDlpdu& one : all) {
    if (!is_of(one, bench.rules().codes.td)) continue;
    if (last) {
      longest = std::max(longest, one.begin - last->begin);
      judge.expect(one.begin - last->begin <= most + kLinkRounding, "time_told_late", [&] {
        return Mismatch{{fmt::format("a TD within {}: 95 % of V(TDP)", kernel::describe(most))},
                        kernel::describe(one.begin - last->begin),
                        one.begin};
      });
      expect_time_goes_on(judge, *last, one);
    }
    last = one;
  }
  judge.expect(last.has_value() && bench.now() - last->begin <= most, "time_not_told", "TDs to the end",
               "none");
  judge.measure("longest time without a TD", "ms",
                static_cast<double>(longest / kernel::kMicrosecond) * 1e-3);
}

void who_asks_is_told(FfBench& bench, CaseJudge& judge) {
  const auto& codes = bench.rules().codes;
  std::optional<DrivenDlpdu> before;
  int asked = 0;
  for (int n = 0; n < bench.volume(200, 2'000) && asked < bench.volume(3, 30); ++n) {
    const auto one = bench.next(bench.now() + bench.octets(400));
    judge.expect(one.has_value(), "no_token", "a PT for 11", "silence");
    if (is_of(*one, codes.td)) before = *one;
    if (!is_pt(bench, *one) || !before) {
      bench.answer_one(*one);
      continue;
    }
    // The holder asks, and returns the token when it knows.
    const kernel::Time end = bench.send_at(one->end + bench.least_gap(), {codes.ct, 0x11});
    bench.run_until(end);
    const DrivenDlpdu td = expect_next(bench, judge, "time_not_told", "a TD");
    judge.expect(is_of(td, codes.td), "time_not_told", "a TD", td.text());
    expect_begins(judge, td, end + bench.least_gap(), "answers_too_early", end + bench.response_delay(),
                  "answers_too_late");
    expect_time_goes_on(judge, *before, td);
    bench.run_until(bench.send_at(td.end + bench.least_gap(), {codes.rt}));
    ++asked;
  }
  judge.expect(asked > 0, "no_token", "a PT for 11", "none");
}

}  // namespace

std::vector<FfCase> ff_time_cases() {
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  const PartialSource time{own("link time in 1/32 ms at the end of a TD"), {"time_wrong"}};
  return {
      {{.id = "fieldbus_dll/ff_las/time/is_distributed",
        .purpose = "FF-27",
        .requirement = "Link time is sent within 95 % of V(TDP).",
        .reference = vendors("V(TDP)"),
        .details = {time},
        .stimulus = "200 times V(TDP) with tokens and CDs.",
        .expected = "TDs at most 95 % of V(TDP) apart, which agree.",
        .tags = {"must", "timing"},
        .catches = {{"time_told_at_full_period", "time_told_late"}, {"time_at_half_speed", "time_wrong"}}},
       time_is_distributed,
       {.change = often}},
      {{.id = "fieldbus_dll/ff_las/time/who_asks_is_told",
        .purpose = "FF-28",
        .requirement = "A CT is answered by a TD within V(MRD) x V(ST).",
        .reference = memory("CT and TD"),
        .details = {time},
        .stimulus = "CTs of a node that holds the token.",
        .expected = "A TD each.",
        .tags = {"must", "timing"},
        .catches = {{"ct_ignored", "time_not_told"}}},
       who_asks_is_told,
       {.change = often}},
  };
}

}  // namespace fieldproof::conformance
