#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_scene.hpp"

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

void expect_time_distributed(FfScene& scene) {
  const kernel::Duration most = scene.bench.rules().time_distribution_period * 95 / 100;
  std::optional<DrivenDlpdu> last;
  kernel::Duration longest{};
  for (const DrivenDlpdu& one : scene.driven) {
    if (!is_of(one, scene.bench.rules().codes.td)) continue;
    if (last) {
      longest = std::max(longest, one.begin - last->begin);
      scene.judge.expect(one.begin - last->begin <= most + kLinkRounding, "time_told_late", [&] {
        return Mismatch{{fmt::format("a TD within {}: 95 % of V(TDP)", kernel::describe(most))},
                        kernel::describe(one.begin - last->begin),
                        one.begin};
      });
      expect_time_goes_on(scene.judge, *last, one);
    }
    last = one;
  }
  scene.judge.expect(last.has_value() && scene.bench.now() - last->begin <= most, "time_not_told",
                     "TDs to the end", "none");
  scene.judge.measure("longest time without a TD", "ms",
                      static_cast<double>(longest / kernel::kMicrosecond) * 1e-3);
}

// `before` is the last TD, `answer` the PT.
void serve_until_token(FfScene& scene) {
  FfBench& bench = scene.bench;
  for (int n = 0; n < 200; ++n) {
    scene.answer =
        expect_next(bench, scene.judge, bench.now() + bench.octets(400), "no_token", "a PT for 11");
    if (is_of(scene.answer, bench.rules().codes.td)) scene.before = scene.answer;
    if (is_pt(bench, scene.answer) && !scene.before.octets.empty()) return;
    bench.answer_one(scene.answer);
  }
  scene.judge.fail("no_token", {{"a PT for 11"}, "none"});
}

}  // namespace

std::vector<FfCase> ff_time_cases() {
  using namespace ff_chart;
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  const PartialSource time{own("link time in 1/32 ms at the end of a TD"), {"time_wrong"}};
  return {
      on_chart(
          must_in_time("fieldbus_dll/ff_las/time/is_distributed", "FF-27",
                       "Link time is sent within 95 % of V(TDP).", vendors("V(TDP)"),
                       {{"time_told_at_full_period", "time_told_late"}, {"time_at_half_speed", "time_wrong"}},
                       {time}),
          {{},
           {serve({12'500, 312'500}),
            expected<FfScene>("TDs at most 95 % of V(TDP) apart, 200 times V(TDP) long, which agree",
                              expect_time_distributed)}},
          {.change = often}),
      on_chart(
          must_in_time("fieldbus_dll/ff_las/time/who_asks_is_told", "FF-28",
                       "A CT is answered by a TD within V(MRD) x V(ST).", memory("CT and TD"),
                       {{"ct_ignored", "time_not_told"}}, {time}),
          {{},
           {repeat({3, 30}, {stimulus<FfScene>(
                                 "all tokens are returned at once until there was a TD, and 11 has the token",
                                 serve_until_token),
                             stimulus<FfScene>("11 asks by CT",
                                               [](FfScene& scene) {
                                                 scene.sent = scene.bench.send_at(
                                                     scene.answer.end + scene.bench.least_gap(),
                                                     {scene.bench.rules().codes.ct, 0x11});
                                                 scene.bench.run_until(scene.sent);
                                               }),
                             answer<FfScene>(
                                 "a TD", "time_not_told",
                                 [](const FfScene& scene, const DrivenDlpdu& one) {
                                   return is_of(one, scene.bench.rules().codes.td);
                                 },
                                 "time_not_told"),
                             expected<FfScene>("it agrees with the TD before, to a tick",
                                               [](FfScene& scene) {
                                                 expect_time_goes_on(scene.judge, scene.before, scene.answer);
                                               }),
                             stimulus<FfScene>("11 returns the token",
                                               [](FfScene& scene) {
                                                 scene.bench.run_until(scene.bench.send_at(
                                                     scene.answer.end + scene.bench.least_gap(),
                                                     {scene.bench.rules().codes.rt}));
                                               })})}},
          {.change = often}),
  };
}

}  // namespace fieldproof::conformance
