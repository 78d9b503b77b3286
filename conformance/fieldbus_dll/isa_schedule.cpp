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
      return Sighting{{fmt::format("{:02X}", fmt::join(wanted, " "))}, one.text(), one.begin};
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
        .expected = "The next token V(MID) behind the EE.",
        .tags = {"must", "timing"},
        .catches = {{"waits_out_duration", "next_too_late"}}},
       a_token_that_comes_back_is_not_waited_for,
       {.schedule = overdue_second()}},
  };
}

}  // namespace fieldproof::conformance
