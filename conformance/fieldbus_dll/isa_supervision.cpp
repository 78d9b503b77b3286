#include <fmt/format.h>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// A scheduler whose token does not come back as it should.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaSchedule;
using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;

constexpr std::uint8_t kHolder = 0x21;
constexpr std::uint8_t kOther = 0x23;

// A token, and a second one that is due while the first is out.
IsaSchedule two_items(IsaType first, std::uint16_t duration = 0) {
  return {.version = 1,
          .period = {},
          .items = {{20 * kOctetAt31250, first, kHolder, Priority::time_available, duration},
                    {30 * kOctetAt31250, IsaType::et, 0x22, Priority::normal, 0}}};
}

DrivenDlpdu expect_first(IsaBench& bench, CaseJudge& judge) {
  return expect_next(bench, judge, "delegation_missing", "the first item of the schedule");
}

Octets du_of_holder(IsaBench& bench, std::size_t size) {
  Octets octets{bench.control(bench.rules().codes.du, Priority::normal), 0x22, kHolder};
  for (const std::uint8_t octet : bench.numbered_data(size)) octets.push_back(octet);
  return octets;
}

// The second token begins in this span.
void expect_second(IsaBench& bench, CaseJudge& judge, kernel::Time earliest, kernel::Time latest) {
  const DrivenDlpdu second = expect_next(bench, judge, latest + bench.octets(1'000), "not_reclaimed",
                                         "the token is reclaimed and the next item delegated");
  expect_begins(judge, second, earliest, "reclaimed_early", latest, "reclaimed_late");
}

void who_says_nothing_loses_the_token(IsaBench& bench, CaseJudge& judge) {
  const DrivenDlpdu first = expect_first(bench, judge);
  const kernel::Time over = first.end + bench.reply_wait();
  expect_second(bench, judge, over, over + bench.slot());
}

void who_talks_too_long_is_not_talked_into(IsaBench& bench, CaseJudge& judge) {
  const DrivenDlpdu first = expect_first(bench, judge);
  const kernel::Time end = bench.send_at(first.end + bench.least_gap(), du_of_holder(bench, 100));
  const auto next = bench.next(end + bench.observation_timeout());
  judge.expect(next.has_value(), "not_reclaimed", "the token is reclaimed", "the scheduler was silent");
  expect_begins(judge, *next, end, "talks_into_holder", kernel::kNever - kLinkRounding, "");
  expect_begins(judge, *next, end + bench.least_gap(), "gap_too_short",
                end + bench.least_gap() + bench.slot(), "reclaimed_late");
}

void who_keeps_the_token_loses_it_with_its_duration(IsaBench& bench, CaseJudge& judge) {
  constexpr int kDuration = 100;
  const DrivenDlpdu first = expect_first(bench, judge);
  bench.run_until(bench.send_at(first.end + bench.least_gap(), du_of_holder(bench, 6)));
  const kernel::Time over = first.end + bench.octets(kDuration) + bench.slot();
  expect_second(bench, judge, over, over + bench.octets(1));
}

void the_end_of_another_is_none(IsaBench& bench, CaseJudge& judge) {
  const DrivenDlpdu first = expect_first(bench, judge);
  kernel::Time at = bench.send_at(first.end + bench.least_gap(), du_of_holder(bench, 6));
  bench.run_until(at);
  at = bench.send_at(at + bench.least_gap(), bench.ee(kOther));
  const kernel::Time back = first.end + bench.octets(70);
  const auto next = bench.next(back);
  judge.expect(!next.has_value(), "end_of_other_taken", [&] {
    return Mismatch{{"silence: the holder has not returned its token"}, next->text(), next->begin};
  });
  at = bench.send_at(back, bench.ee(kHolder));
  bench.run_until(at);
  expect_second(bench, judge, at + bench.least_gap(), at + bench.least_gap() + bench.slot());
}

void a_holder_may_wait_for_a_reply(IsaBench& bench, CaseJudge& judge) {
  const DrivenDlpdu first = expect_first(bench, judge);
  const Octets cd{bench.control(bench.rules().codes.cd, Priority::normal), 0x22, kHolder};
  const kernel::Time compelled = bench.send_at(first.end + bench.least_gap(), cd);
  bench.run_until(compelled);
  const kernel::Time resumed = compelled + bench.reply_wait() + bench.octets(1);
  const auto next = bench.next(resumed);
  judge.expect(!next.has_value(), "talks_into_token", [&] {
    return Mismatch{{"silence: the holder waits for a reply"}, next->text(), next->begin};
  });
  const kernel::Time back = bench.send_at(resumed, bench.ee(kHolder));
  bench.run_until(back);
  expect_second(bench, judge, back + bench.least_gap(), back + bench.least_gap() + bench.slot());
}

}  // namespace

std::vector<IsaCase> isa_supervision_cases() {
  using link_sources::isa_paper;
  using link_sources::own;
  const PartialSource times{own("V(RR) is 32 octets, VC(UC) the duration and V(ST)"),
                            {"reclaimed_early", "reclaimed_late"}};
  return {
      {{.id = "fieldbus_dll/isa_las/supervision/who_says_nothing_loses_the_token",
        .purpose = "ISA-31",
        .requirement = "A token whose holder says nothing is taken back when V(RR) is over.",
        .reference = isa_paper("duration guarded on both sides"),
        .details = {times},
        .stimulus = "An ES for 500 octets, silence; the next item is due.",
        .expected = "The next token within V(ST) after V(RR), not before.",
        .tags = {"must", "timing"},
        .catches = {{"reclaims_by_uc_only", "reclaimed_late"}, {"reclaims_early", "reclaimed_early"}}},
       who_says_nothing_loses_the_token,
       {.schedule = two_items(IsaType::es, 500)}},
      {{.id = "fieldbus_dll/isa_las/supervision/a_single_frame_that_does_not_come",
        .purpose = "ISA-31",
        .requirement = "A token for one frame whose holder says nothing is taken back when V(RR) is over.",
        .reference = own("V(RR) supervises an ET, too"),
        .details = {times},
        .stimulus = "An ET, silence; the next item is due.",
        .expected = "The next token within V(ST) after V(RR), not before.",
        .tags = {"must", "timing"},
        .catches = {{"single_token_for_ever", "not_reclaimed"}, {"reclaims_early", "reclaimed_early"}}},
       who_says_nothing_loses_the_token,
       {.schedule = two_items(IsaType::et)}},
      {{.id = "fieldbus_dll/isa_las/supervision/who_talks_too_long_is_not_talked_into",
        .purpose = "ISA-32",
        .requirement = "A holder that is still sending when its duration is over is not disturbed.",
        .reference = own("VC(UC) that runs out on a busy line"),
        .stimulus = "An ES for 40 octets; the holder sends a frame of 108; the next item is due.",
        .expected = "The next token V(MID) after that frame.",
        .tags = {"must", "timing"},
        .catches = {{"reclaims_into_holder", "talks_into_holder"}}},
       who_talks_too_long_is_not_talked_into,
       {.schedule = two_items(IsaType::es, 40)}},
      {{.id = "fieldbus_dll/isa_las/supervision/who_keeps_the_token_loses_it_with_its_duration",
        .purpose = "ISA-33",
        .requirement = "A token that is not returned is taken back when its duration is over.",
        .reference = isa_paper("VC(UC) at the scheduler"),
        .details = {times},
        .stimulus = "An ES for 100 octets; the holder sends one frame and falls silent.",
        .expected = "The next token within an octet after VC(UC), not before.",
        .tags = {"must", "timing"},
        .catches = {{"no_supervision", "not_reclaimed"},
                    {"supervises_without_margin", "reclaimed_early"},
                    {"supervises_long", "reclaimed_late"}}},
       who_keeps_the_token_loses_it_with_its_duration,
       {.schedule = two_items(IsaType::es, 100)}},
      {{.id = "fieldbus_dll/isa_las/supervision/the_end_of_another_is_none",
        .purpose = "ISA-34",
        .requirement = "Only the holder can return a token.",
        .reference = own("EE of another"),
        .stimulus = "An ES; an EE of a third station while the holder has it, then its own.",
        .expected = "The next token after the second EE.",
        .tags = {"must"},
        .catches = {{"end_of_anybody_taken", "end_of_other_taken"}}},
       the_end_of_another_is_none,
       {.schedule = two_items(IsaType::es, 200)}},
      {{.id = "fieldbus_dll/isa_las/supervision/a_holder_may_wait_for_a_reply",
        .purpose = "ISA-31",
        .requirement = "A holder of a token for one frame may compel with it, and waits for the reply before "
                       "it returns the token.",
        .reference = own("a CD is a frame, its reply is none of the holder's"),
        .stimulus =
            "An ET; the holder compels a station that is silent, and returns the token an octet after "
            "V(RR).",
        .expected = "Silence until then, the next token after the EE.",
        .tags = {"must", "timing"},
        .catches = {{"forgets_reply_wait", "talks_into_token"}}},
       a_holder_may_wait_for_a_reply,
       {.schedule = two_items(IsaType::et)}},
  };
}

}  // namespace fieldproof::conformance
