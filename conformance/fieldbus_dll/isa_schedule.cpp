#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// A scheduler that delegates its token as its schedule says.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaSchedule;
using fieldbus_dll::IsaScheduleItem;
using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;

IsaSchedule ten_items() {
  using enum Priority;
  return {.version = 7,
          .period = {},
          .items = {{20 * kOctetAt31250, IsaType::es, 0x21, time_available, 60},
                    {120 * kOctetAt31250, IsaType::et, 0x22, normal, 0},
                    {200 * kOctetAt31250, IsaType::es, 0x23, urgent, 100},
                    {330 * kOctetAt31250, IsaType::et, 0x21, urgent, 0},
                    {400 * kOctetAt31250, IsaType::es, 0x22, normal, 90},
                    {520 * kOctetAt31250, IsaType::et, 0x23, time_available, 0},
                    {600 * kOctetAt31250, IsaType::es, 0x21, normal, 120},
                    {740 * kOctetAt31250, IsaType::et, 0x22, normal, 0},
                    {800 * kOctetAt31250, IsaType::es, 0x23, time_available, 110},
                    {930 * kOctetAt31250, IsaType::et, 0x21, urgent, 0}}};
}

Octets octets_of_item(const IsaBench& bench, const IsaScheduleItem& item) {
  const bool is_sequence = item.type == IsaType::es;
  Octets octets{bench.control(is_sequence ? bench.rules().codes.es : bench.rules().codes.et, item.least),
                item.node, bench.address()};
  if (!is_sequence) return octets;
  octets.push_back(static_cast<std::uint8_t>(item.duration >> 8));
  octets.push_back(static_cast<std::uint8_t>(item.duration & 0xFF));
  return octets;
}

void each_item_has_its_time(IsaBench& bench, CaseJudge& judge) {
  const IsaSchedule schedule = ten_items();
  kernel::Duration farthest{};
  for (const IsaScheduleItem& item : schedule.items) {
    const kernel::Time due = kernel::kStart + item.at;
    const DrivenDlpdu one = expect_next(bench, judge, due + 2 * bench.slot(), "delegation_missing",
                                        "the next item of the schedule");
    const Octets wanted = octets_of_item(bench, item);
    judge.expect(one.octets == wanted, "delegation_wrong", [&] {
      return Mismatch{{fmt::format("{:02X}", fmt::join(wanted, " "))}, one.text(), one.begin};
    });
    expect_begins(judge, one, due - bench.slot(), "delegation_early", due + bench.slot(), "delegation_late");
    farthest = std::max(farthest, one.begin < due ? due - one.begin : one.begin - due);
    bench.run_until(bench.send_at(one.end + bench.least_gap(), bench.ee(item.node)));
  }
  judge.measure("farthest from its time", "us", static_cast<double>(farthest / kernel::kMicrosecond));
  expect_silence(bench, judge, "delegation_not_in_schedule", "the schedule is over");
}

IsaSchedule overdue_second() {
  return {.version = 1,
          .period = {},
          .items = {{20 * kOctetAt31250, IsaType::es, 0x21, Priority::time_available, 400},
                    {35 * kOctetAt31250, IsaType::et, 0x22, Priority::normal, 0}}};
}

void a_token_that_comes_back_is_not_waited_for(IsaBench& bench, CaseJudge& judge) {
  const DrivenDlpdu first = expect_next(bench, judge, "delegation_missing", "the first item");
  const kernel::Time back = bench.send_at(first.end + bench.least_gap(), bench.ee(0x21));
  bench.run_until(back);
  const DrivenDlpdu second = expect_next(bench, judge, kernel::kStart + 500 * kOctetAt31250,
                                         "delegation_missing", "the second item");
  expect_begins(judge, second, back + bench.least_gap(), "gap_too_short",
                back + bench.least_gap() + bench.slot(), "next_too_late");
}

constexpr int kOctetsOfPeriod = 200;
constexpr int kItemInPeriod = 20;
constexpr std::uint8_t kHolderInSchedule = 0x21;

IsaSchedule one_item_a_period() {
  return {.version = 1,
          .period = kOctetsOfPeriod * kOctetAt31250,
          .items = {{kItemInPeriod * kOctetAt31250, IsaType::et, kHolderInSchedule, Priority::normal, 0}}};
}

// The token of a period, in time, and returned at once; instant by which it is back.
kernel::Time expect_token_of_period(IsaBench& bench, CaseJudge& judge, int period) {
  const kernel::Time due =
      kernel::kStart + (std::int64_t{period} * kOctetsOfPeriod + kItemInPeriod) * kOctetAt31250;
  const DrivenDlpdu et =
      expect_next(bench, judge, due + 2 * bench.slot(), "delegation_missing", "the token of this period");
  judge.expect(is_type(et, bench.rules().codes.et), "delegation_wrong",
               [&] { return Mismatch{{"an ET"}, et.text(), et.begin}; });
  expect_begins(judge, et, due - bench.slot(), "delegation_early", due + bench.slot(), "delegation_late");
  const kernel::Time back = bench.send_at(et.end + bench.least_gap(), bench.ee(kHolderInSchedule));
  bench.run_until(back);
  return back;
}

void the_schedule_goes_round(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(4, 100); ++n) expect_token_of_period(bench, judge, n);
}

void its_own_data_goes_between(IsaBench& bench, CaseJudge& judge) {
  constexpr std::size_t kShort = 10;
  constexpr std::size_t kLong = 60;
  // Less than the long one needs, before the next token.
  constexpr int kLeft = 40;
  const auto expect_own = [&](const Octets& data, kernel::Time latest) {
    const DrivenDlpdu du =
        expect_next(bench, judge, latest, "own_data_not_sent", "a DU of the scheduler's user");
    judge.expect(is_type(du, bench.rules().codes.du) && du.rest() == data, "own_data_not_sent",
                 [&] { return Mismatch{{"a DU with the data of its user"}, du.text(), du.begin}; });
  };
  int period = 0;
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const kernel::Time back = expect_token_of_period(bench, judge, period++);
    const Octets fits = bench.numbered_data(kShort);
    judge.expect(bench.submit_unit_data(Priority::normal, fits), "data_refused", "data is accepted",
                 "it was not");
    expect_own(fits, back + bench.octets(60));
    const kernel::Time next =
        kernel::kStart + (std::int64_t{period} * kOctetsOfPeriod + kItemInPeriod) * kOctetAt31250;
    bench.run_until(next - bench.octets(kLeft));
    const Octets waits = bench.numbered_data(kLong);
    judge.expect(bench.submit_unit_data(Priority::urgent, waits), "data_refused", "data is accepted",
                 "it was not");
    expect_own(waits, expect_token_of_period(bench, judge, period++) + bench.octets(60));
  }
}

}  // namespace

std::vector<IsaCase> isa_schedule_cases() {
  using link_sources::isa_paper;
  using link_sources::own;
  return {
      {{.id = "fieldbus_dll/isa_las/schedule/each_item_has_its_time",
        .purpose = "ISA-29",
        .requirement = "The scheduler delegates its token in the order and at the times of its schedule.",
        .reference = isa_paper("the link active scheduler passes the delegated token in scheduled order"),
        .details = {{own("within one V(ST) of its time"), {"delegation_early", "delegation_late"}}},
        .stimulus = "A schedule of ten items; each holder returns its token at once.",
        .expected = "Ten tokens as scheduled, and no more.",
        .tags = {"must", "timing"},
        .catches = {{"schedule_late", "delegation_late"},
                    {"schedule_early", "delegation_early"},
                    {"items_skipped", "delegation_missing"},
                    {"delegates_urgent_only", "delegation_wrong"},
                    {"duration_sent_little_endian", "delegation_wrong"}}},
       each_item_has_its_time,
       {.schedule = ten_items()}},
      {{.id = "fieldbus_dll/isa_las/schedule/a_token_that_comes_back_is_not_waited_for",
        .purpose = "ISA-30",
        .requirement = "A token that comes back early ends its duration.",
        .reference = isa_paper("EE: the use of the token has ended"),
        .stimulus = "An ES for 400 octets whose holder returns it at once; the next item is due.",
        .expected = "The next token V(MID) after the EE.",
        .tags = {"must", "timing"},
        .catches = {{"waits_out_duration", "next_too_late"}}},
       a_token_that_comes_back_is_not_waited_for,
       {.schedule = overdue_second()}},
      {{.id = "fieldbus_dll/isa_las/schedule/goes_round",
        .purpose = "ISA-29",
        .requirement = "The scheduler delegates its token in the order and at the times of its schedule.",
        .reference = isa_paper("the link active scheduler passes the delegated token in scheduled order"),
        .details = {{own("the period of a schedule; within one V(ST) of its time"),
                     {"delegation_missing", "delegation_early", "delegation_late"}}},
        .stimulus = "A schedule with one ET in each period of 200 octet durations.",
        .expected = "The ET in each period.",
        .tags = {"must", "timing"},
        .catches = {{"period_doubled", "delegation_missing"}}},
       the_schedule_goes_round,
       {.schedule = one_item_a_period()}},
      {{.id = "fieldbus_dll/isa_las/schedule/its_own_data_goes_between",
        .purpose = "ISA-29",
        .requirement = "What the scheduler's own user submits goes between the items of the schedule.",
        .reference = own("the scheduler's own data, where it ends before the next item"),
        .stimulus = "Data that ends before the next token, and data that does not.",
        .expected = "The first before it; the second after it, and the token in time.",
        .tags = {"must", "timing"},
        .catches = {{"own_data_kept", "own_data_not_sent"}, {"own_data_over_due", "delegation_wrong"}}},
       its_own_data_goes_between,
       {.schedule = one_item_a_period()}},
  };
}

}  // namespace fieldproof::conformance
