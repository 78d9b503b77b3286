#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_scene.hpp"

// A scheduler that compels by its schedule, and what it lets stand before it.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr FfAddress kFirst = 0x1120;
constexpr FfAddress kSecond = 0x1220;
constexpr FfAddress kThirdRelationship = 0x1320;
constexpr FfAddress kOwn = 0x1020;             // of the scheduler
constexpr std::uint32_t kMacrocycle = 16'000;  // 500 ms

// Offsets that are no octet durations: 31.25 us, 155.125 ms, 320 ms.
void three_items(FfConfiguration& configuration) {
  configuration.live = {0x11, 0x12, 0x13};
  configuration.schedule = {.version = 1,
                            .macrocycle = kMacrocycle,
                            .items = {{1, kFirst, Priority::normal},
                                      {4'964, kSecond, Priority::urgent},
                                      {10'240, kThirdRelationship, Priority::normal}}};
}

// The reply to the last one comes in the next macrocycle.
void at_both_ends(FfConfiguration& configuration) {
  configuration.live = {0x11, 0x12};
  configuration.schedule = {
      .version = 1,
      .macrocycle = kMacrocycle,
      .items = {{4'964, kFirst, Priority::normal}, {kMacrocycle - 1, kSecond, Priority::urgent}}};
}

// Who holds a token keeps it as long as it may, with data; now and then not so long.
std::optional<FfBench::Reply> kept_long(FfBench& bench, const DrivenDlpdu& dlpdu) {
  if (!is_pt(bench, dlpdu)) return bench.returned(dlpdu);
  constexpr unsigned kAround = 5 + 2 + 3;
  const unsigned gap = bench.link().inter_pdu_delay_octets;
  const unsigned grant = duration_in(dlpdu);
  if (grant < gap + kAround + 1) return FfBench::Reply{{bench.rules().codes.rt}};
  std::size_t size = std::min<std::size_t>(256, grant - gap - kAround);
  if (bench.random().below(2) == 1) size = 1 + bench.random().below(size);
  return FfBench::Reply{bench.dt1(Priority::time_available, 0x1030,
                                  fieldbus_dll::address_of(dlpdu.octet(1), 1), Octets(size, 0x55), true)};
}

void its_own_item(FfConfiguration& configuration) {
  three_items(configuration);
  configuration.published = {kOwn};
  configuration.schedule.items[1].address = kOwn;
}

void nothing_but_cds(FfConfiguration& configuration) {
  configuration.rules.least_token_octets = 3'000;
  configuration.live = {0x11};
  configuration.schedule = {.version = 1, .macrocycle = 9'600, .items = {{4'800, kFirst, Priority::normal}}};
}

constexpr kernel::Duration kCycle = kMacrocycle * fieldbus_dll::kTick;

FfStep kept(Rounds cycles) {
  return stimulus<FfScene>(fmt::format("holders keep their tokens as long as they may, now and then not so "
                                       "long, for {} macrocycles with three items at 1/32 ms",
                                       cycles.full),
                           [cycles](FfScene& scene) {
                             FfBench& bench = scene.bench;
                             scene.driven = bench.serve(
                                 kernel::kStart + bench.volume(cycles.quick, cycles.full) * kCycle,
                                 [&](const DrivenDlpdu& one) { return kept_long(bench, one); });
                           });
}

kernel::Duration scheduling_overhead(const FfBench& bench) {
  return bench.octets(bench.rules().scheduling_overhead_octets);
}

void expect_items_in_time(FfScene& scene) {
  const auto& items = scene.bench.configuration().schedule.items;
  std::size_t n = 0;
  kernel::Duration farthest{};
  for (const DrivenDlpdu& one : scene.driven) {
    if (!is_cd(scene.bench, one)) continue;
    const auto& item = items[n % items.size()];
    const kernel::Time due = kernel::kStart + static_cast<std::int64_t>(n / items.size()) * kCycle +
                             std::int64_t{item.at} * fieldbus_dll::kTick;
    const bool is_right = one.octet(1) == item.address >> 8 && one.octet(2) == (item.address & 0xFF) &&
                          priority_in(one) == item.priority;
    scene.judge.expect(is_right, "compelled_wrong", [&] {
      return Mismatch{{fmt::format("CD for {:04X}", item.address)}, one.text(), one.begin};
    });
    expect_begins(scene.judge, one, due, "compelled_early", due + scheduling_overhead(scene.bench),
                  "compelled_late");
    farthest = std::max(farthest, one.begin - due);
    ++n;
  }
  const auto all = static_cast<std::size_t>((scene.bench.now() - kernel::kStart) / kCycle) * items.size();
  scene.judge.expect(n + items.size() >= all, "not_compelled",
                     [&] { return Mismatch{{fmt::format("some {} CDs", all)}, fmt::format("{}", n)}; });
  scene.judge.measure("farthest from its time", "us", static_cast<double>(farthest / kernel::kMicrosecond));
}

// From the end of a PT to the next item of the schedule.
kernel::Duration time_left(const FfBench& bench, const DrivenDlpdu& pt) {
  const kernel::Duration phase = (pt.end - kernel::kStart) % kCycle;
  kernel::Duration left = kCycle;
  for (const auto& item : bench.configuration().schedule.items) {
    const kernel::Duration at = item.at * fieldbus_dll::kTick;
    left = std::min(left, phase <= at ? at - phase : at + kCycle - phase);
  }
  return left;
}

void expect_tokens_over_in_time(FfScene& scene) {
  const auto& rules = scene.bench.rules();
  std::size_t tokens = 0;
  for (const DrivenDlpdu& pt : scene.driven) {
    if (!is_pt(scene.bench, pt)) continue;
    ++tokens;
    const unsigned grant = duration_in(pt);
    const auto require_that = [&](bool holds, std::string_view reason, const std::string& what) {
      scene.judge.expect(holds, reason, [&] { return Mismatch{{what}, pt.text(), pt.begin}; });
    };
    require_that(grant >= rules.least_token_octets, "token_too_short",
                 fmt::format("tokens for V(DMDT), {} octets, at least", rules.least_token_octets));
    require_that(grant <= rules.token_holding_octets, "token_too_long",
                 fmt::format("tokens for V(DTHT), {} octets, at most", rules.token_holding_octets));
    const kernel::Duration left = time_left(scene.bench, pt);
    require_that(scene.bench.octets(grant) <= left, "token_over_due",
                 fmt::format("a token that ends before the CD in {}", kernel::describe(left)));
  }
  scene.judge.expect(tokens > 20, "no_token", "tokens between the CDs", fmt::format("{}", tokens));
}

// Holders return a long token at once: what matters are those in front of a CD.
void expect_time_used(FfScene& scene) {
  FfBench& bench = scene.bench;
  std::size_t cut = 0;
  for (const DrivenDlpdu& pt : scene.driven) {
    const unsigned grant = duration_in(pt);
    if (!is_pt(bench, pt) || grant >= bench.rules().token_holding_octets) continue;
    ++cut;
    const kernel::Duration left = time_left(bench, pt);
    const kernel::Duration usable = left - scheduling_overhead(bench) - bench.least_gap();
    const auto sighting = [&] {
      return Mismatch{{fmt::format("a token that ends V(MSO) and V(MID) before the CD in {}, to two octets",
                                   kernel::describe(left))},
                      pt.text(),
                      pt.begin};
    };
    scene.judge.expect(bench.octets(grant) <= usable + kLinkRounding, "token_over_due", sighting);
    scene.judge.expect(bench.octets(grant + 2) >= usable, "token_shorter_than_the_time", sighting);
  }
  scene.judge.expect(cut > 3, "no_token", "tokens that are cut in front of a CD", fmt::format("{}", cut));
}

void leave_cds(FfScene& scene) {
  FfBench& bench = scene.bench;
  scene.driven = bench.serve(kernel::kStart + bench.volume(4, 50) * kCycle, [&](const DrivenDlpdu& one) {
    return is_cd(bench, one) ? std::nullopt : bench.returned(one);
  });
}

void expect_time_of_answer_lost(FfScene& scene) {
  std::size_t seen = 0;
  for (std::size_t n = 1; n < scene.driven.size(); ++n) {
    if (!is_cd(scene.bench, scene.driven[n - 1])) continue;
    const kernel::Time over = scene.driven[n - 1].end + scene.bench.response_delay();
    expect_begins(scene.judge, scene.driven[n], over, "goes_on_early", over + 2 * scene.bench.slot(),
                  "goes_on_late");
    ++seen;
  }
  scene.judge.expect(seen > 5, "not_compelled", "CDs", fmt::format("{}", seen));
}

void write_own(FfScene& scene) {
  FfBench& bench = scene.bench;
  scene.judge.expect(bench.write(kOwn, scene.fresh(8)), "write_refused", "the buffer is written",
                     "it was not");
  scene.driven = bench.serve(kernel::kStart + (scene.round + 1) * kCycle);
}

void expect_own_published(FfScene& scene) {
  const kernel::Duration at = scene.bench.configuration().schedule.items[1].at * fieldbus_dll::kTick;
  const kernel::Time due = kernel::kStart + scene.round * kCycle + at;
  bool is_published = false;
  for (const DrivenDlpdu& one : scene.driven) {
    if (!is_dt3(scene.bench, one)) continue;
    const BufferOfDt3 buffer = buffer_in(one);
    scene.judge.expect(buffer.from == kOwn && buffer.data == scene.data, "buffer_wrong", [&] {
      return Mismatch{{fmt::format("{:04X} as it was written last", kOwn)}, one.text(), one.begin};
    });
    expect_begins(scene.judge, one, due, "compelled_early", due + scheduling_overhead(scene.bench),
                  "compelled_late");
    is_published = true;
  }
  scene.judge.expect(is_published, "own_buffer_not_published", "a DT3 of the scheduler in each macrocycle",
                     "none");
}

// The lowest link master claims after a silence of V(ST) x 16.
void expect_line_active(FfScene& scene) {
  const kernel::Duration claim = 16 * scene.bench.slot();
  const auto heard = scene.bench.heard();
  kernel::Time silent_since = kernel::kStart;
  std::size_t next = 0;
  for (const DrivenDlpdu& one : scene.driven) {
    for (; next < heard.size() && heard[next].end <= one.begin; ++next)
      silent_since = std::max(silent_since, heard[next].end);
    scene.judge.expect(one.begin - silent_since < claim, "line_left_silent", [&] {
      return Mismatch{{fmt::format("silence for less than {}", kernel::describe(claim))},
                      kernel::describe(one.begin - silent_since),
                      one.begin};
    });
    silent_since = one.end;
  }
  scene.judge.expect(scene.bench.now() - silent_since < claim, "line_left_silent", "the line is kept active",
                     "silence");
}

}  // namespace

std::vector<FfCase> ff_schedule_cases() {
  using namespace ff_chart;
  using link_sources::ff_paper;
  using link_sources::memory;
  using link_sources::vendors;
  return {
      on_chart(must_in_time("fieldbus_dll/ff_las/schedule/each_item_has_its_time", "FF-14",
                            "The scheduler compels at the times of its schedule, at most V(MSO) later.",
                            ff_paper("the scheduler sends CD at the time of the schedule"),
                            {{"token_over_due", "compelled_late"},
                             {"schedule_in_centiseconds", "compelled_late"},
                             {"item_skipped", "compelled_wrong"}},
                            {{vendors("V(MSO)"), {"compelled_late"}}}),
               {{},
                {kept({20, 1'000}), expected<FfScene>("each CD in its turn, from its time to V(MSO) later",
                                                      expect_items_in_time)}},
               {.change = three_items}),
      on_chart(
          must_in_time("fieldbus_dll/ff_las/schedule/its_last_instant_is_an_instant", "FF-14",
                       "An item at the last instant of a macrocycle is compelled, and the next macrocycle "
                       "begins when this one ends.",
                       ff_paper("the scheduler sends CD at the time of the schedule"),
                       {{"refuses_its_last_instant", "not_compelled"}},
                       {{vendors("V(MSO)"), {"compelled_late"}}}),
          {{},
           {kept({20, 200}),
            expected<FfScene>("each CD in its turn, from its time to V(MSO) later", expect_items_in_time)}},
          {.change = at_both_ends}),
      on_chart(
          must_in_time("fieldbus_dll/ff_las/schedule/a_token_ends_before_what_is_due", "FF-15",
                       "No token is passed for less than V(DMDT), and none that would last into a CD.",
                       vendors("V(DMDT), V(DTHT)"),
                       {{"least_token_ignored", "token_too_short"}, {"token_over_due", "token_over_due"}}),
          {{},
           {kept({10, 200}), expected<FfScene>("tokens from V(DMDT) to V(DTHT), each over before the next CD",
                                               expect_tokens_over_in_time)}},
          {.change = three_items}),
      on_chart(must_in_time("fieldbus_dll/ff_las/schedule/a_token_that_just_fits_is_cut", "FF-16",
                            "A token in front of a CD is as long as the time that is left.",
                            memory("duration of a PT in front of a CD"),
                            {{"no_allowance_for_pt", "token_over_due"},
                             {"cut_to_the_least", "token_shorter_than_the_time"}},
                            {{link_sources::own("as long as possible, V(MSO) and V(MID) kept free"),
                              {"token_shorter_than_the_time", "token_over_due"}}}),
               {{},
                {kept({10, 200}),
                 expected<FfScene>("tokens in front of a CD end V(MSO) and V(MID) before it, to two octets",
                                   expect_time_used)}},
               {.change = three_items}),
      on_chart(
          must_in_time(
              "fieldbus_dll/ff_las/schedule/a_missing_answer_costs_its_time", "FF-17",
              "A CD that nobody answers costs V(MRD) x V(ST), no more than two slot times more.",
              memory("V(MRD) x V(ST)"),
              {{"answer_time_from_begin", "goes_on_early"}, {"answer_time_doubled", "goes_on_late"}}),
          {{},
           {stimulus<FfScene>("CDs are not answered, in 50 macrocycles, all tokens returned at once",
                              leave_cds),
            expected<FfScene>("the DLPDU after a CD within two slot times after V(MRD) x V(ST), not before",
                              expect_time_of_answer_lost)}},
          {.change = three_items}),
      on_chart(must_in_time("fieldbus_dll/ff_las/schedule/its_own_buffer_is_published", "FF-14",
                            "What the scheduler itself publishes has its time, too.",
                            link_sources::own("a scheduler that publishes: a DT3 without a CD"),
                            {{"own_buffer_kept", "own_buffer_not_published"}}),
               {{3, 30},
                {stimulus<FfScene>("the user writes 8 octets into the buffer of the scheduler, which its "
                                   "schedule has, once in each macrocycle",
                                   write_own),
                 expected<FfScene>("a DT3 with them, from its time to V(MSO) later", expect_own_published)}},
               {.change = its_own_item}),
      on_chart(
          must_in_time(
              "fieldbus_dll/ff_las/schedule/the_line_is_kept_active", "FF-41",
              "Who has the link leaves the line silent for less than a link master waits to claim it.",
              memory("IDLE"), {{"line_left_silent", "line_left_silent"}}),
          {{},
           {serve({8'000, 8'000}),
            expected<FfScene>(
                "silences of less than V(ST) x 16, though no token fits between the items of the schedule",
                expect_line_active)}},
          {.change = nothing_but_cds}),
  };
}

}  // namespace fieldproof::conformance
