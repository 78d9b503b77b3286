#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"

// A scheduler that compels by its schedule, and what it lets stand before it.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr FfAddress kFirst = 0x1120;
constexpr FfAddress kSecond = 0x1220;
constexpr FfAddress kThird = 0x1320;
constexpr FfAddress kOwn = 0x1020;             // of the scheduler
constexpr std::uint32_t kMacrocycle = 16'000;  // 500 ms

// Offsets that are no octet durations: 31.25 us, 155.125 ms, 320 ms.
void three_items(FfConfiguration& configuration) {
  configuration.live = {0x11, 0x12, 0x13};
  configuration.schedule = {.version = 1,
                            .macrocycle = kMacrocycle,
                            .items = {{1, kFirst, Priority::normal},
                                      {4'964, kSecond, Priority::urgent},
                                      {10'240, kThird, Priority::normal}}};
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

// What is compelled when, in macrocycles with holders that keep their tokens long.
void ff_each_item_has_its_time(FfBench& bench, CaseJudge& judge) {
  const auto& items = bench.configuration().schedule.items;
  const kernel::Duration most = bench.octets(bench.rules().scheduling_overhead_octets);
  const int cycles = bench.volume(20, 1'000);
  const kernel::Duration macrocycle = kMacrocycle * fieldbus_dll::kTick;
  const auto all = bench.serve(kernel::kStart + cycles * macrocycle,
                               [&](const DrivenDlpdu& one) { return kept_long(bench, one); });
  std::size_t n = 0;
  kernel::Duration farthest{};
  for (const DrivenDlpdu& one : all) {
    if (!is_cd(bench, one)) continue;
    const auto& item = items[n % items.size()];
    const kernel::Time due = kernel::kStart + static_cast<std::int64_t>(n / items.size()) * macrocycle +
                             std::int64_t{item.at} * fieldbus_dll::kTick;
    const bool is_right = one.octet(1) == item.address >> 8 && one.octet(2) == (item.address & 0xFF) &&
                          priority_in(one) == item.priority;
    judge.expect(is_right, "compelled_wrong", [&] {
      return Mismatch{{fmt::format("CD for {:04X}", item.address)}, one.text(), one.begin};
    });
    expect_begins(judge, one, due, "compelled_early", due + most, "compelled_late");
    farthest = std::max(farthest, one.begin - due);
    ++n;
  }
  const auto wanted = static_cast<std::size_t>(cycles) * items.size();
  judge.expect(n + items.size() >= wanted, "not_compelled",
               [&] { return Mismatch{{fmt::format("some {} CDs", wanted)}, fmt::format("{}", n)}; });
  judge.measure("farthest from its time", "us", static_cast<double>(farthest / kernel::kMicrosecond));
}

void a_token_ends_before_what_is_due(FfBench& bench, CaseJudge& judge) {
  const kernel::Duration macrocycle = kMacrocycle * fieldbus_dll::kTick;
  const auto all = bench.serve(kernel::kStart + bench.volume(10, 200) * macrocycle,
                               [&](const DrivenDlpdu& one) { return kept_long(bench, one); });
  std::size_t tokens = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const DrivenDlpdu& pt = all[n];
    if (!is_pt(bench, pt)) continue;
    ++tokens;
    const unsigned grant = duration_in(pt);
    judge.expect(grant >= bench.rules().least_token_octets, "token_too_short", [&] {
      return Mismatch{
          {fmt::format("tokens for V(DMDT), {} octets, at least", bench.rules().least_token_octets)},
          pt.text(),
          pt.begin};
    });
    judge.expect(grant <= bench.rules().token_holding_octets, "token_too_long", [&] {
      return Mismatch{
          {fmt::format("tokens for V(DTHT), {} octets, at most", bench.rules().token_holding_octets)},
          pt.text(),
          pt.begin};
    });
    for (const auto& item : bench.configuration().schedule.items) {
      const kernel::Duration at = item.at * fieldbus_dll::kTick;
      const kernel::Duration phase = (pt.end - kernel::kStart) % macrocycle;
      const kernel::Duration left = phase <= at ? at - phase : at + macrocycle - phase;
      judge.expect(bench.octets(grant) <= left, "token_over_due", [&] {
        return Mismatch{{fmt::format("a token that ends before the CD in {}", kernel::describe(left))},
                        pt.text(),
                        pt.begin};
      });
    }
  }
  judge.expect(tokens > 20, "no_token", "tokens between the CDs", fmt::format("{}", tokens));
}

// Holders return a long token at once: what matters are those in front of a CD.
void a_token_in_front_of_a_cd_uses_the_time(FfBench& bench, CaseJudge& judge) {
  const auto& rules = bench.rules();
  const kernel::Duration macrocycle = kMacrocycle * fieldbus_dll::kTick;
  const kernel::Duration free = bench.octets(rules.scheduling_overhead_octets) + bench.least_gap();
  const auto all = bench.serve(kernel::kStart + bench.volume(10, 200) * macrocycle,
                               [&](const DrivenDlpdu& one) { return kept_long(bench, one); });
  std::size_t cut = 0;
  for (const DrivenDlpdu& pt : all) {
    const unsigned grant = duration_in(pt);
    if (!is_pt(bench, pt) || grant >= rules.token_holding_octets) continue;
    ++cut;
    const kernel::Duration phase = (pt.end - kernel::kStart) % macrocycle;
    kernel::Duration left = macrocycle;
    for (const auto& item : bench.configuration().schedule.items) {
      const kernel::Duration at = item.at * fieldbus_dll::kTick;
      left = std::min(left, phase <= at ? at - phase : at + macrocycle - phase);
    }
    const auto sighting = [&] {
      return Mismatch{{fmt::format("a token that ends V(MSO) and V(MID) before the CD in {}, to two octets",
                                   kernel::describe(left))},
                      pt.text(),
                      pt.begin};
    };
    judge.expect(bench.octets(grant) <= left - free + kLinkRounding, "token_over_due", sighting);
    judge.expect(bench.octets(grant + 2) >= left - free, "token_shorter_than_the_time", sighting);
  }
  judge.expect(cut > 3, "no_token", "tokens that are cut in front of a CD", fmt::format("{}", cut));
}

// The next thing that is said after a CD which nobody answers.
void a_missing_answer_costs_its_time(FfBench& bench, CaseJudge& judge) {
  std::optional<DrivenDlpdu> cd;
  const kernel::Time end = kernel::kStart + bench.volume(4, 50) * (kMacrocycle * fieldbus_dll::kTick);
  std::size_t seen = 0;
  while (const auto one = bench.next(end)) {
    if (cd) {
      const kernel::Time over = cd->end + bench.response_delay();
      expect_begins(judge, *one, over, "goes_on_early", over + 2 * bench.slot(), "goes_on_late");
      ++seen;
      cd.reset();
    }
    if (is_cd(bench, *one)) {
      cd = *one;
    } else {
      bench.answer_one(*one);
    }
  }
  judge.expect(seen > 5, "not_compelled", "CDs", fmt::format("{}", seen));
}

void its_own_item(FfConfiguration& configuration) {
  three_items(configuration);
  configuration.published = {kOwn};
  configuration.schedule.items[1].address = kOwn;
}

void its_own_buffer_is_published(FfBench& bench, CaseJudge& judge) {
  const kernel::Duration macrocycle = kMacrocycle * fieldbus_dll::kTick;
  const kernel::Duration at = bench.configuration().schedule.items[1].at * fieldbus_dll::kTick;
  const kernel::Duration most = bench.octets(bench.rules().scheduling_overhead_octets);
  for (int n = 0; n < bench.volume(3, 30); ++n) {
    const Octets data = bench.numbered_data(8);
    judge.expect(bench.write(kOwn, data), "write_refused", "the buffer is written", "it was not");
    const kernel::Time due = kernel::kStart + n * macrocycle + at;
    bool is_published = false;
    for (const DrivenDlpdu& one : bench.serve(kernel::kStart + (n + 1) * macrocycle)) {
      if (!is_dt3(bench, one)) continue;
      const BufferOfDt3 buffer = buffer_in(one);
      judge.expect(buffer.from == kOwn && buffer.data == data, "buffer_wrong", [&] {
        return Mismatch{{fmt::format("{:04X} as it was written last", kOwn)}, one.text(), one.begin};
      });
      expect_begins(judge, one, due, "compelled_early", due + most, "compelled_late");
      is_published = true;
    }
    judge.expect(is_published, "own_buffer_not_published", "a DT3 of the scheduler in each macrocycle",
                 "none");
  }
}

void nothing_but_cds(FfConfiguration& configuration) {
  configuration.rules.least_token_octets = 3'000;
  configuration.live = {0x11};
  configuration.schedule = {.version = 1, .macrocycle = 9'600, .items = {{4'800, kFirst, Priority::normal}}};
}

void the_line_is_kept_active(FfBench& bench, CaseJudge& judge) {
  // The lowest link master claims after this silence.
  const kernel::Duration claim = 16 * bench.slot();
  const auto all = bench.serve(kernel::kStart + bench.octets(8'000));
  kernel::Time silent_since = kernel::kStart;
  std::size_t heard = 0;
  for (const DrivenDlpdu& one : all) {
    for (; heard < bench.heard().size() && bench.heard()[heard].end <= one.begin; ++heard)
      silent_since = std::max(silent_since, bench.heard()[heard].end);
    judge.expect(one.begin - silent_since < claim, "line_left_silent", [&] {
      return Mismatch{{fmt::format("silence for less than {}", kernel::describe(claim))},
                      kernel::describe(one.begin - silent_since),
                      one.begin};
    });
    silent_since = one.end;
  }
  judge.expect(bench.now() - silent_since < claim, "line_left_silent", "the line is kept active", "silence");
}

}  // namespace

std::vector<FfCase> ff_schedule_cases() {
  using link_sources::ff_paper;
  using link_sources::memory;
  using link_sources::vendors;
  return {
      {{.id = "fieldbus_dll/ff_las/schedule/each_item_has_its_time",
        .purpose = "FF-14",
        .requirement = "The scheduler compels at the times of its schedule, at most V(MSO) later.",
        .reference = ff_paper("the scheduler sends CD at the time of the schedule"),
        .details = {{vendors("V(MSO)"), {"compelled_late"}}},
        .stimulus =
            "Three items at 1/32 ms; holders keep their tokens as long as they may; 1000 macrocycles.",
        .expected = "Each CD in its turn, from its time to V(MSO) later.",
        .tags = {"must", "timing"},
        .catches = {{"token_over_due", "compelled_late"},
                    {"schedule_in_centiseconds", "compelled_late"},
                    {"item_skipped", "compelled_wrong"}}},
       ff_each_item_has_its_time,
       {.change = three_items}},
      {{.id = "fieldbus_dll/ff_las/schedule/a_token_ends_before_what_is_due",
        .purpose = "FF-15",
        .requirement = "No token is passed for less than V(DMDT), and none that would last into a CD.",
        .reference = vendors("V(DMDT), V(DTHT)"),
        .stimulus = "As before.",
        .expected = "Tokens from V(DMDT) to V(DTHT), each over before the next CD.",
        .tags = {"must", "timing"},
        .catches = {{"least_token_ignored", "token_too_short"}, {"token_over_due", "token_over_due"}}},
       a_token_ends_before_what_is_due,
       {.change = three_items}},
      {{.id = "fieldbus_dll/ff_las/schedule/a_token_that_just_fits_is_cut",
        .purpose = "FF-16",
        .requirement = "A token in front of a CD is as long as the time that is left.",
        .reference = memory("duration of a PT in front of a CD"),
        .details = {{link_sources::own("as long as possible, V(MSO) and V(MID) kept free"),
                     {"token_shorter_than_the_time", "token_over_due"}}},
        .stimulus = "As before.",
        .expected = "Tokens in front of a CD end V(MSO) and V(MID) before it, to two octets.",
        .tags = {"must", "timing"},
        .catches = {{"no_allowance_for_pt", "token_over_due"},
                    {"cut_to_the_least", "token_shorter_than_the_time"}}},
       a_token_in_front_of_a_cd_uses_the_time,
       {.change = three_items}},
      {{.id = "fieldbus_dll/ff_las/schedule/a_missing_answer_costs_its_time",
        .purpose = "FF-17",
        .requirement = "A CD that nobody answers costs V(MRD) x V(ST), no more than two slot times more.",
        .reference = memory("V(MRD) x V(ST)"),
        .stimulus = "CDs without an answer.",
        .expected = "The next DLPDU within two slot times after V(MRD) x V(ST), not before.",
        .tags = {"must", "timing"},
        .catches = {{"answer_time_from_begin", "goes_on_early"}, {"answer_time_doubled", "goes_on_late"}}},
       a_missing_answer_costs_its_time,
       {.change = three_items}},
      {{.id = "fieldbus_dll/ff_las/schedule/its_own_buffer_is_published",
        .purpose = "FF-14",
        .requirement = "What the scheduler itself publishes has its time, too.",
        .reference = link_sources::own("a scheduler that publishes: a DT3 without a CD"),
        .stimulus = "A schedule with a buffer of the scheduler, which is written in each macrocycle.",
        .expected = "A DT3 with the last write, from its time to V(MSO) later.",
        .tags = {"must", "timing"},
        .catches = {{"own_buffer_kept", "own_buffer_not_published"}}},
       its_own_buffer_is_published,
       {.change = its_own_item}},
      {{.id = "fieldbus_dll/ff_las/schedule/the_line_is_kept_active",
        .purpose = "FF-41",
        .requirement =
            "Who has the link leaves the line silent for less than a link master waits to claim it.",
        .reference = memory("IDLE"),
        .stimulus = "A schedule between whose items no token can be passed.",
        .expected = "Silences of less than V(ST) x 16.",
        .tags = {"must", "timing"},
        .catches = {{"line_left_silent", "line_left_silent"}}},
       the_line_is_kept_active,
       {.change = nothing_but_cds}},
  };
}

}  // namespace fieldproof::conformance
