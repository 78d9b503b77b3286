#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// Who is the scheduler: TL, and two of them.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaSchedule;
using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;

constexpr int kPeriod = 200;
constexpr std::uint8_t kServed = 0x21;
constexpr std::uint8_t kHeir = 0x11;
constexpr std::uint8_t kLower = 0x0F;
constexpr std::uint16_t kVersion = 0x0102;

IsaSchedule periodic() {
  return {.version = kVersion,
          .period = kPeriod * kOctetAt31250,
          .items = {{20 * kOctetAt31250, IsaType::et, kServed, Priority::normal, 0}}};
}

IsaSchedule late_items() {
  return {.version = 1,
          .period = {},
          .items = {{60 * kOctetAt31250, IsaType::et, kServed, Priority::normal, 0},
                    {130 * kOctetAt31250, IsaType::es, 0x22, Priority::normal, 40}}};
}

bool is_scheduling(const IsaBench& bench, const DrivenDlpdu& dlpdu) {
  const auto& codes = bench.rules().codes;
  return is_type(dlpdu, codes.et) || is_type(dlpdu, codes.es) || is_type(dlpdu, codes.tl);
}

// A period of the schedule in which the holder returns its token.
void serve_one(IsaBench& bench, CaseJudge& judge) {
  const DrivenDlpdu et = expect_next(bench, judge, bench.now() + (kPeriod + 40) * kOctetAt31250,
                                     "delegation_missing", "the item of the schedule");
  bench.run_until(bench.send_at(et.end + bench.least_gap(), bench.ee(kServed)));
}

void expect_no_scheduler(IsaBench& bench, CaseJudge& judge, std::string_view why) {
  const kernel::Time end = bench.now() + 3 * kPeriod * kOctetAt31250;
  while (const auto one = bench.next(end)) {
    judge.expect(!is_scheduling(bench, *one), "two_schedulers", [&] {
      return Mismatch{{fmt::format("no ET, ES or TL: {}", why)}, one->text(), one->begin};
    });
  }
}

void a_link_master_takes_over(IsaBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(300));
  const kernel::Time end = bench.send({bench.rules().codes.tl, bench.address(), kLower, 0, 1});
  const DrivenDlpdu first = expect_next(bench, judge, "not_taken", "a DLPDU of the new scheduler");
  expect_begins(judge, first, end + bench.least_gap(), "answers_too_early", end + bench.reply_wait(),
                "taken_late");
  std::vector<DrivenDlpdu> tokens;
  if (is_scheduling(bench, first)) tokens.push_back(first);
  while (const auto one = bench.next(end + bench.octets(400))) {
    if (is_scheduling(bench, *one)) tokens.push_back(*one);
  }
  judge.expect(tokens.size() == 2 && is_type(tokens[0], bench.rules().codes.et) &&
                   is_type(tokens[1], bench.rules().codes.es),
               "schedule_not_run", [&] {
                 return Mismatch{{"the ET and the ES of its schedule"},
                                 fmt::format("{} tokens", tokens.size())};
               });
}

void a_wrong_transfer_is_none_for_a_dle(IsaBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(300));
  Octets wrong = with_frame_check(Octets{bench.rules().codes.tl, bench.address(), kLower, 0, 1});
  wrong.back() ^= 1;
  bench.send_half_bits(half_bits_of_frame(wrong));
  expect_no_scheduler(bench, judge, "the check of the TL is wrong");
  bench.send({bench.rules().codes.tl, kHeir, kLower, 0, 1});
  expect_no_scheduler(bench, judge, "the TL is for another");
}

void a_dle_in_standby_uses_tokens(IsaBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(300));
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const Octets data = bench.numbered_data(8);
    judge.expect(bench.submit_unit_data(Priority::normal, data), "data_refused", "data is accepted",
                 "it was not");
    const kernel::Time end = bench.send(bench.et(Priority::normal));
    const DrivenDlpdu du = expect_next(bench, judge, "token_not_used", "a DU");
    expect_begins(judge, du, end + bench.least_gap(), "answers_too_early", end + bench.reply_wait(),
                  "answers_too_late");
    judge.expect(is_type(du, bench.rules().codes.du) && du.rest() == data, "token_not_used",
                 [&] { return Mismatch{{"a DU with the data of its user"}, du.text(), du.begin}; });
    bench.listen();
  }
}

DrivenDlpdu expect_transfer(IsaBench& bench, CaseJudge& judge) {
  serve_one(bench, judge);
  // So late that the next item of the schedule is due while the TL is on the line.
  bench.run_until(kernel::kStart + (kPeriod + 14) * kOctetAt31250);
  bench.order_transfer(kHeir);
  const DrivenDlpdu tl = expect_next(bench, judge, "no_transfer", "a TL");
  const Octets wanted{bench.rules().codes.tl, kHeir, bench.address(), kVersion >> 8, kVersion & 0xFF};
  judge.expect(tl.octets == wanted, "transfer_wrong", [&] {
    return Mismatch{{fmt::format("{:02X}", fmt::join(wanted, " "))}, tl.text(), tl.begin};
  });
  return tl;
}

void what_is_not_taken_is_retaken(IsaBench& bench, CaseJudge& judge) {
  const DrivenDlpdu tl = expect_transfer(bench, judge);
  const kernel::Time over = tl.end + bench.reply_wait();
  const DrivenDlpdu next =
      expect_next(bench, judge, over + 2 * kPeriod * kOctetAt31250, "not_retaken", "the schedule goes on");
  expect_begins(judge, next, over, "retaken_early", over + (kPeriod + 40) * kOctetAt31250, "not_retaken");
  judge.expect(is_scheduling(bench, next), "not_retaken", "the next item of the schedule", next.text());
}

void what_is_taken_is_left(IsaBench& bench, CaseJudge& judge) {
  const DrivenDlpdu tl = expect_transfer(bench, judge);
  const Octets sign{bench.control(bench.rules().codes.du, Priority::time_available), bench.rules().everybody,
                    kHeir};
  bench.run_until(bench.send_at(tl.end + 2 * bench.least_gap(), sign));
  expect_no_scheduler(bench, judge, "the heir has taken the link");
}

void the_lower_address_keeps_the_link(IsaBench& bench, CaseJudge& judge) {
  serve_one(bench, judge);
  bench.wait(bench.octets(40));
  bench.send({bench.control(bench.rules().codes.et, Priority::normal), 0x22, kHeir});
  const auto next = bench.next(bench.now() + 2 * kPeriod * kOctetAt31250);
  judge.expect(next && is_scheduling(bench, *next), "left_to_higher",
               "the schedule goes on: the other has the higher address", "the scheduler is gone");
  bench.run_until(bench.send_at(next->end + bench.least_gap(), bench.ee(kServed)));
  bench.wait(bench.octets(40));
  bench.send({bench.control(bench.rules().codes.et, Priority::normal), 0x22, kLower});
  expect_no_scheduler(bench, judge, "one with a lower address is the scheduler");
}

}  // namespace

std::vector<IsaCase> isa_transfer_cases() {
  using link_sources::isa_paper;
  using link_sources::own;
  return {
      {{.id = "fieldbus_dll/isa_las/transfer/a_link_master_takes_over",
        .purpose = "ISA-35",
        .requirement = "A TL makes a link master the scheduler.",
        .reference = isa_paper("TL: the scheduling token goes to another link master"),
        .details = {{own("the first DLPDU within V(RR)"), {"taken_late"}},
                    {own("its schedule begins with the TL"), {"schedule_not_run"}}},
        .stimulus = "A TL to the IUT, whose schedule has an item after 60 octets and one after 130.",
        .expected = "A DLPDU within V(RR); then both items.",
        .tags = {"must"},
        .catches = {{"ignores_transfer", "not_taken"},
                    {"shows_itself_late", "taken_late"},
                    {"schedule_not_begun", "schedule_not_run"}}},
       a_link_master_takes_over,
       {.schedule = late_items(), .is_scheduler = false}},
      {{.id = "fieldbus_dll/isa_las/transfer/a_wrong_one_is_none",
        .purpose = "ISA-35",
        .requirement = "A TL with a wrong check or for another makes a link master no scheduler.",
        .reference = isa_paper("there is one scheduler"),
        .stimulus = "A TL whose last bit is wrong, a TL for another.",
        .expected = "No ET, ES or TL.",
        .tags = {"must"},
        .catches = {{"takes_transfer_of_others", "two_schedulers"}}},
       a_wrong_transfer_is_none_for_a_dle,
       {.schedule = late_items(), .is_scheduler = false}},
      {{.id = "fieldbus_dll/isa_las/transfer/in_standby_it_uses_tokens",
        .purpose = "ISA-35",
        .requirement = "A link master that is not the scheduler uses tokens as every station.",
        .reference = isa_paper("link masters that are not the scheduler"),
        .stimulus = "Data, and an ET to the IUT.",
        .expected = "The data, begun within V(RR).",
        .tags = {"must"},
        .catches = {{"deaf_in_standby", "token_not_used"}}},
       a_dle_in_standby_uses_tokens,
       {.schedule = late_items(), .is_scheduler = false}},
      {{.id = "fieldbus_dll/isa_las/transfer/what_is_not_taken_is_retaken",
        .purpose = "ISA-36",
        .requirement = "A scheduler whose heir says nothing takes the link back when V(RR) is over.",
        .reference = isa_paper("there is one scheduler"),
        .details = {{own("V(RR) supervises a TL"), {"retaken_early", "not_retaken"}}},
        .stimulus = "The IUT hands the link over; the heir is silent.",
        .expected = "A TL with the version of the schedule; the schedule goes on, not before V(RR) is over.",
        .tags = {"must"},
        .catches = {{"never_retakes", "not_retaken"},
                    {"retakes_early", "retaken_early"},
                    {"transfer_without_version", "transfer_wrong"}}},
       what_is_not_taken_is_retaken,
       {.schedule = periodic()}},
      {{.id = "fieldbus_dll/isa_las/transfer/what_is_taken_is_left",
        .purpose = "ISA-37",
        .requirement = "A scheduler that has handed the link over is one no more.",
        .reference = isa_paper("there is one scheduler"),
        .stimulus = "The IUT hands the link over; the heir sends a DU.",
        .expected = "No ET, ES or TL in three periods of the schedule.",
        .tags = {"must"},
        .catches = {{"keeps_schedule_behind_transfer", "two_schedulers"}}},
       what_is_taken_is_left,
       {.schedule = periodic()}},
      {{.id = "fieldbus_dll/isa_las/transfer/the_lower_address_keeps_the_link",
        .purpose = "ISA-38",
        .requirement = "Of two schedulers the one with the lower address stays.",
        .reference = own("two schedulers"),
        .stimulus = "An ET from a higher address, then one from a lower.",
        .expected = "The schedule goes on after the first; no ET, ES or TL after the second.",
        .tags = {"must"},
        .catches = {{"never_yields", "two_schedulers"}, {"always_yields", "left_to_higher"}}},
       the_lower_address_keeps_the_link,
       {.schedule = periodic()}},
  };
}

}  // namespace fieldproof::conformance
