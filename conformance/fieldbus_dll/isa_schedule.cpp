#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/fieldbus_dll/isa_scene.hpp"

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

IsaSchedule overdue_second() {
  return {.version = 1,
          .period = {},
          .items = {{20 * kOctetAt31250, IsaType::es, 0x21, Priority::time_available, 400},
                    {35 * kOctetAt31250, IsaType::et, 0x22, Priority::normal, 0}}};
}

// A scheduler that does not receive the EE waits V(RR), which is far longer than V(MID) and V(ST).
void with_long_reply_wait(fieldbus_dll::IsaConfiguration& configuration) {
  constexpr unsigned kSlots = 11;
  configuration.rules.link.response_delay_slots = kSlots;
  configuration.rules.reply_wait_octets = kSlots * configuration.rules.link.slot_time_octets;
}

constexpr int kOctetsOfPeriod = 200;
constexpr int kItemInPeriod = 20;
constexpr std::uint8_t kHolderInSchedule = 0x21;

IsaSchedule one_item_a_period() {
  return {.version = 1,
          .period = kOctetsOfPeriod * kOctetAt31250,
          .items = {{kItemInPeriod * kOctetAt31250, IsaType::et, kHolderInSchedule, Priority::normal, 0}}};
}

constexpr std::size_t kShort = 10;
constexpr std::size_t kLong = 60;
constexpr int kLeft = 40;  // octet durations, less than the long one needs

// Of the turn, as often as the schedule goes round. `latency`: farthest from its time.
void expect_item_of(IsaScene& scene, const IsaSchedule& schedule) {
  IsaBench& bench = scene.bench;
  const std::size_t count = schedule.items.size();
  const IsaScheduleItem& item = schedule.items.at(scene.turn % count);
  const kernel::Time due =
      kernel::kStart + static_cast<std::int64_t>(scene.turn / count) * schedule.period + item.at;
  scene.answer = expect_next(bench, scene.judge, due + 2 * bench.slot(), "delegation_missing",
                             "the next item of the schedule");
  const DrivenDlpdu& one = scene.answer;
  const Octets right = octets_of_item(bench, item);
  scene.judge.expect(one.octets == right, "delegation_wrong", [&] {
    return Mismatch{{fmt::format("{:02X}", fmt::join(right, " "))}, one.text(), one.begin};
  });
  expect_begins(scene.judge, one, due - bench.slot(), "delegation_early", due + bench.slot(),
                "delegation_late");
  scene.latency = std::max(scene.latency, one.begin < due ? due - one.begin : one.begin - due);
}

void expect_item(IsaScene& scene) {
  expect_item_of(scene, ten_items());
  if (scene.turn == 9)
    scene.judge.measure("farthest from its time", "us",
                        static_cast<double>(scene.latency / kernel::kMicrosecond));
}

void expect_without_wait(IsaScene& scene) {
  const DrivenDlpdu second = expect_next(scene.bench, scene.judge, kernel::kStart + 500 * kOctetAt31250,
                                         "delegation_missing", "the second item");
  const kernel::Time earliest = scene.sent + scene.bench.least_gap();
  expect_begins(scene.judge, second, earliest, "gap_too_short", earliest + scene.bench.slot(),
                "next_too_late");
}

// More than an octet counts, in a period that is longer than 2^32 nanoseconds.
constexpr unsigned kManyItems = 300;
IsaSchedule many_items() {
  IsaSchedule schedule{.version = 1, .period = 5 * kernel::kSecond, .items = {}};
  for (unsigned n = 0; n < kManyItems; ++n) {
    const auto least = static_cast<Priority>(1 + n % 3);
    schedule.items.push_back({(20 + 50 * std::int64_t{n}) * kOctetAt31250,
                              n % 2 == 0 ? IsaType::et : IsaType::es, static_cast<std::uint8_t>(0x21 + n % 3),
                              least, static_cast<std::uint16_t>(n + 1)});
  }
  return schedule;
}

void expect_one_of_many(IsaScene& scene) {
  expect_item_of(scene, many_items());
}

// Beyond 2^32 nanoseconds and 2^16 milliseconds, for longer than 2^15 octet durations.
IsaSchedule items_of_minutes() {
  return {.version = 1,
          .period = {},
          .items = {{5 * kernel::kSecond, IsaType::es, 0x21, Priority::normal, 40'000},
                    {70 * kernel::kSecond, IsaType::et, 0x22, Priority::normal, 0},
                    {20 * 60 * kernel::kSecond, IsaType::es, 0x23, Priority::urgent, 65'535}}};
}

// The third begins after more than 2^32 microseconds.
IsaSchedule one_item_an_hour() {
  return {.version = 1,
          .period = 3'600 * kernel::kSecond,
          .items = {{20 * kOctetAt31250, IsaType::et, kHolderInSchedule, Priority::normal, 0}}};
}

void expect_token_of_hour(IsaScene& scene) {
  const kernel::Time due =
      kernel::kStart + std::int64_t{scene.turn} * 3'600 * kernel::kSecond + 20 * kOctetAt31250;
  scene.answer = expect_next(scene.bench, scene.judge, due + 2 * scene.bench.slot(), "delegation_missing",
                             "the token of this hour");
  expect_begins(scene.judge, scene.answer, due - scene.bench.slot(), "delegation_early",
                due + scene.bench.slot(), "delegation_late");
}

IsaSchedule one_item_once() {
  return {.version = 1,
          .period = {},
          .items = {{60 * kOctetAt31250, IsaType::et, kHolderInSchedule, Priority::normal, 0}}};
}

kernel::Time due_in_period(unsigned period) {
  return kernel::kStart + (std::int64_t{period} * kOctetsOfPeriod + kItemInPeriod) * kOctetAt31250;
}

void expect_token_of_period(IsaScene& scene, unsigned period) {
  IsaBench& bench = scene.bench;
  const kernel::Time due = due_in_period(period);
  scene.answer = expect_next(bench, scene.judge, due + 2 * bench.slot(), "delegation_missing",
                             "the token of this period");
  scene.judge.expect(is_type(scene.answer, bench.rules().codes.et), "delegation_wrong",
                     [&] { return Mismatch{{"an ET"}, scene.answer.text(), scene.answer.begin}; });
  expect_begins(scene.judge, scene.answer, due - bench.slot(), "delegation_early", due + bench.slot(),
                "delegation_late");
}

void expect_own_data(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  const DrivenDlpdu du = expect_next(bench, scene.judge, bench.now() + bench.octets(60), "own_data_not_sent",
                                     "a DU of the scheduler's user");
  scene.judge.expect(is_type(du, bench.rules().codes.du) && du.rest() == scene.submitted.back(),
                     "own_data_not_sent",
                     [&] { return Mismatch{{"a DU with the data of its user"}, du.text(), du.begin}; });
}

}  // namespace

std::vector<IsaCase> isa_schedule_cases() {
  using namespace isa_chart;
  const IsaStep returned = stimulus<IsaScene>("its holder returns it at once", [](IsaScene& scene) {
    scene.reply(scene.bench.ee(kHolderInSchedule));
  });
  const IsaStep own_data =
      expected<IsaScene>("the data of the scheduler's user within 60 octet durations", expect_own_data);
  using link_sources::isa_paper;
  using link_sources::own;
  return {
      on_chart(
          must_in_time("fieldbus_dll/isa_las/schedule/each_item_has_its_time", "ISA-29",
                       "The scheduler delegates its token in the order and at the times of its schedule.",
                       isa_paper("the link active scheduler passes the delegated token in scheduled order"),
                       {{"schedule_late", "delegation_late"},
                        {"schedule_early", "delegation_early"},
                        {"items_skipped", "delegation_missing"},
                        {"delegates_urgent_only", "delegation_wrong"},
                        {"duration_sent_little_endian", "delegation_wrong"}},
                       {{own("within one V(ST) of its time"), {"delegation_early", "delegation_late"}}}),
          {{},
           {repeat({10, 10},
                   {expected<IsaScene>("the ten tokens of the schedule, each within V(ST) of its time",
                                       expect_item),
                    stimulus<IsaScene>(
                        "its holder returns it at once",
                        [](IsaScene& scene) { scene.reply(scene.bench.ee(scene.answer.octet(1))); })}),
            silence("delegation_not_in_schedule", "the schedule is over")}},
          {.schedule = ten_items()}),
      on_chart(must_in_time("fieldbus_dll/isa_las/schedule/a_token_that_comes_back_is_not_waited_for",
                            "ISA-30", "A token that comes back early ends its duration.",
                            isa_paper("EE: the use of the token has ended"),
                            {{"waits_out_duration", "next_too_late"}}),
               {{},
                {delegated("the ES for 400 octet durations"),
                 stimulus<IsaScene>("its holder returns it at once",
                                    [](IsaScene& scene) { scene.reply(scene.bench.ee(kHolderInSchedule)); }),
                 expected<IsaScene>("the next token, which is due, V(MID) to V(MID) and V(ST) after the EE",
                                    expect_without_wait)}},
               {.schedule = overdue_second(), .change = with_long_reply_wait}),
      on_chart(
          must_in_time("fieldbus_dll/isa_las/schedule/goes_round", "ISA-29",
                       "The scheduler delegates its token in the order and at the times of its schedule.",
                       isa_paper("the link active scheduler passes the delegated token in scheduled order"),
                       {{"period_doubled", "delegation_missing"}},
                       {{own("the period of a schedule; within one V(ST) of its time"),
                         {"delegation_missing", "delegation_early", "delegation_late"}}}),
          {{4, 100},
           {expected<IsaScene>("an ET in each period of 200 octet durations, within V(ST) of its time",
                               [](IsaScene& scene) { expect_token_of_period(scene, scene.round); }),
            returned}},
          {.schedule = one_item_a_period()}),
      on_chart(
          must_in_time("fieldbus_dll/isa_las/schedule/its_own_data_goes_between", "ISA-29",
                       "What the scheduler's own user submits goes between the items of the schedule.",
                       own("the scheduler's own data, where it ends before the next item"),
                       {{"own_data_kept", "own_data_not_sent"}, {"own_data_over_due", "delegation_wrong"}}),
          {{2, 20},
           {expected<IsaScene>("the token of a period, in time",
                               [](IsaScene& scene) { expect_token_of_period(scene, 2 * scene.round); }),
            returned, submit({Priority::normal}, kShort), own_data,
            stimulus<IsaScene>("all but 40 octet durations pass until the next token",
                               [](IsaScene& scene) {
                                 scene.bench.run_until(due_in_period(2 * scene.round + 1) -
                                                       scene.bench.octets(kLeft));
                               }),
            submit({Priority::urgent}, kLong),
            expected<IsaScene>("the token of the next period, in time",
                               [](IsaScene& scene) { expect_token_of_period(scene, 2 * scene.round + 1); }),
            returned, own_data}},
          {.schedule = one_item_a_period()}),
      on_chart(
          must_in_time("fieldbus_dll/isa_las/schedule/many_items_of_a_long_period", "ISA-29",
                       "The scheduler delegates its token in the order and at the times of its schedule.",
                       isa_paper("the link active scheduler passes the delegated token in scheduled order"),
                       {{"sixteen_items", "delegation_missing"}, {"period_of_32_bits", "delegation_early"}},
                       {{own("within one V(ST) of its time"),
                         {"delegation_missing", "delegation_early", "delegation_late"}}}),
          {{},
           {repeat({kManyItems + 3, kManyItems + 3},
                   {expected<IsaScene>("the tokens of a schedule of 300 items, and three of its next "
                                       "period, which begins after 5 s, each within V(ST) of its time",
                                       expect_one_of_many),
                    stimulus<IsaScene>(
                        "its holder returns it at once",
                        [](IsaScene& scene) { scene.reply(scene.bench.ee(scene.answer.octet(1))); })})}},
          {.schedule = many_items()}),
      on_chart(must_in_time(
                   "fieldbus_dll/isa_las/schedule/items_of_minutes_have_their_time", "ISA-29",
                   "The scheduler delegates its token in the order and at the times of its schedule.",
                   isa_paper("the link active scheduler passes the delegated token in scheduled order"),
                   {{"items_in_32_bits", "delegation_early"}, {"duration_of_15_bits", "delegation_wrong"}},
                   {{own("within one V(ST) of its time"),
                     {"delegation_missing", "delegation_early", "delegation_late"}}}),
               {{},
                {repeat({3, 3}, {expected<IsaScene>(
                                     "the tokens that are due after 5 s, 70 s and 20 min, two of them for "
                                     "40000 and 65535 octet durations",
                                     [](IsaScene& scene) { expect_item_of(scene, items_of_minutes()); }),
                                 stimulus<IsaScene>("its holder returns it at once",
                                                    [](IsaScene& scene) {
                                                      scene.reply(scene.bench.ee(scene.answer.octet(1)));
                                                    })})}},
               {.schedule = items_of_minutes()}),
      on_chart(
          must_in_time("fieldbus_dll/isa_las/schedule/goes_round_for_hours", "ISA-29",
                       "The scheduler delegates its token in the order and at the times of its schedule.",
                       isa_paper("the link active scheduler passes the delegated token in scheduled order"),
                       {{"clock_of_32_bits", "delegation_missing"}},
                       {{own("within one V(ST) of its time"),
                         {"delegation_missing", "delegation_early", "delegation_late"}}}),
          {{},
           {repeat({3, 3},
                   {expected<IsaScene>("an ET each hour, within V(ST) of its time", expect_token_of_hour),
                    returned})}},
          {.schedule = one_item_an_hour()}),
      on_chart(
          must_case("fieldbus_dll/isa_las/schedule/what_comes_after_its_end", "ISA-29",
                    "When its schedule is over, the scheduler sends what its user submits, and a TL begins "
                    "it again.",
                    own("the end of a schedule"),
                    {{"no_data_after_its_schedule", "own_data_not_sent"},
                     {"no_schedule_after_its_schedule", "schedule_not_run"}}),
          {{},
           {delegated("the token of the schedule"), returned, wait(300), submit({Priority::normal}, kShort),
            own_data, wait(300),
            send("a TL to the station",
                 [](IsaScene& scene) {
                   return Octets{scene.bench.rules().codes.tl, scene.bench.address(), 0x0F, 0, 1};
                 }),
            expected<IsaScene>("the token of its schedule within 80 octet durations",
                               [](IsaScene& scene) {
                                 const kernel::Time last = scene.sent + scene.bench.octets(80);
                                 auto one = scene.bench.next(last);
                                 while (one && !is_type(*one, scene.bench.rules().codes.et))
                                   one = scene.bench.next(last);
                                 scene.judge.expect(one.has_value(), "schedule_not_run",
                                                    "the ET of its schedule", "none");
                               })}},
          {.schedule = one_item_once()}),
  };
}

}  // namespace fieldproof::conformance
