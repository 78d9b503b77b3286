#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// The IUT holds a token and compels another station: who has the line, and when again.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

// The IUT has a long token, has just sent a CD to the peer, and has a DLSDU to send after it.
struct Compelled {
  DrivenDlpdu cd;
  Octets behind;
};

Compelled compel(IsaBench& bench, CaseJudge& judge) {
  judge.expect(bench.submit(IsaService::compel, Priority::normal, {}), "data_refused", "a CD is accepted",
               "it was refused");
  const Octets behind = bench.numbered_data(6);
  bench.submit_unit_data(Priority::normal, behind);
  bench.send(bench.es(Priority::time_available, 5'000));
  const DrivenDlpdu cd = expect_next(bench, judge, "no_compelling", "a CD to the peer");
  const Octets wanted{bench.control(bench.rules().codes.cd, Priority::normal), IsaBench::kPeer,
                      bench.address()};
  judge.expect(cd.octets == wanted, "dlpdu_wrong", [&] {
    return Mismatch{{fmt::format("CD: {:02X}", fmt::join(wanted, " "))}, cd.text(), cd.begin};
  });
  bench.user().deliveries.clear();
  return {cd, behind};
}

void expect_goes_on(IsaBench& bench, CaseJudge& judge, const Octets& behind) {
  const DrivenDlpdu next = expect_next(bench, judge, "does_not_go_on", "the DLSDU after the CD");
  judge.expect(next.rest() == behind, "does_not_go_on",
               [&] { return Mismatch{{"the DLSDU after the CD"}, next.text(), next.begin}; });
}

void a_late_reply_is_waited_for(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 20); ++n) {
    const Compelled compelled = compel(bench, judge);
    const Octets reply = bench.numbered_data(2 + bench.random().below(100));
    const kernel::Time end = bench.send_at(compelled.cd.end + bench.reply_wait() - bench.octets(1),
                                           bench.dt(Priority::normal, reply));
    const bool talks = bench.next_begins(end);
    judge.expect(!talks, "talks_into_reply", "silence while the reply is on the line",
                 "the station began to drive");
    judge.expect(bench.user().was_delivered(reply), "reply_not_taken", "the reply is delivered",
                 "it was not");
    expect_goes_on(bench, judge, compelled.behind);
    bench.listen();
  }
}

void a_missing_reply_costs_rr(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 20); ++n) {
    const Compelled compelled = compel(bench, judge);
    const kernel::Time over = compelled.cd.end + bench.reply_wait();
    const DrivenDlpdu next = expect_next(bench, judge, "does_not_go_on", "the DLSDU after the CD");
    expect_begins(judge, next, over, "resumes_early", over + bench.octets(1), "resumes_late");
    judge.expect(next.rest() == compelled.behind, "does_not_go_on",
                 [&] { return Mismatch{{"the DLSDU after the CD"}, next.text(), next.begin}; });
    bench.listen();
  }
}

void a_reply_behind_rr_is_none(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 20); ++n) {
    const Compelled compelled = compel(bench, judge);
    const Octets reply = bench.numbered_data(20);
    const kernel::Time begin = compelled.cd.end + bench.reply_wait() + bench.octets(2);
    const kernel::Time end = bench.send_at(begin, bench.dt(Priority::normal, reply));
    const auto next = bench.next(end);
    judge.expect(!next || next->begin <= begin, "talks_into_reply", [&] {
      return Mismatch{
          {fmt::format("the station begins before {}, or when the reply is over", kernel::describe(begin))},
          next->text(),
          next->begin};
    });
    bench.run_until(end);
    bench.listen();
    judge.expect(!bench.user().was_delivered(reply), "late_reply_taken",
                 "a reply that begins after V(RR) is none", "it was delivered");
  }
}

void a_cd_in_place_of_a_reply_is_not_answered(IsaBench& bench, CaseJudge& judge) {
  constexpr std::uint8_t kThird = 0x23;
  for (int n = 0; n < bench.volume(2, 10); ++n) {
    const Compelled compelled = compel(bench, judge);
    bench.submit(IsaService::reply_data, Priority::normal, bench.numbered_data(4));
    Octets cd = bench.cd(Priority::normal);
    cd[2] = kThird;
    bench.run_until(bench.send_at(compelled.cd.end + bench.least_gap(), cd));
    for (const DrivenDlpdu& one : bench.listen()) {
      judge.expect(!is_type(one, bench.rules().codes.dt), "answers_while_waiting", [&] {
        return Mismatch{{"no DT: the station waits for a reply itself"}, one.text(), one.begin};
      });
    }
    // Whatever was left of the token and of the data is gone by then.
    bench.send(bench.cd(Priority::normal));
    bench.listen();
    bench.send(bench.es(Priority::time_available, 5'000));
    bench.listen();
  }
  expect_serves(bench, judge);
}

}  // namespace

std::vector<IsaCase> isa_compelling_cases() {
  using link_sources::isa_paper;
  using link_sources::own;
  return {
      {{.id = "fieldbus_dll/isa_dle/compelling/a_late_reply_is_waited_for",
        .purpose = "ISA-19",
        .requirement = "A reply that begins within V(RR) is taken, and the token holder goes on after it.",
        .reference = isa_paper("VC(RR): the time for which a reply is waited for"),
        .stimulus = "An ES; the IUT compels the peer, which begins to reply an octet before V(RR) is over.",
        .expected = "The reply is delivered, and the next DLSDU follows it.",
        .tags = {"must", "timing"},
        .catches = {{"rr_runs_through_reply", "talks_into_reply"},
                    {"reply_wait_without_slots", "talks_into_reply"},
                    {"reply_ends_token", "does_not_go_on"}}},
       a_late_reply_is_waited_for},
      {{.id = "fieldbus_dll/isa_dle/compelling/a_missing_reply_costs_rr",
        .purpose = "ISA-20",
        .requirement = "Without a reply the token holder goes on when V(RR) is over, not before.",
        .reference = isa_paper("VC(RR): the time for which a reply is waited for"),
        .details = {{own("V(RR) is V(MRD) x V(ST), 32 octets, from the end of the CD"),
                     {"resumes_early", "resumes_late"}}},
        .stimulus = "An ES; the IUT compels the peer, which is silent.",
        .expected = "The next DLSDU within an octet after V(RR).",
        .tags = {"must", "timing"},
        .catches = {{"reply_wait_without_slots", "resumes_early"},
                    {"reply_wait_a_tenth_longer", "resumes_late"},
                    {"missing_reply_ends_token", "does_not_go_on"}}},
       a_missing_reply_costs_rr},
      {{.id = "fieldbus_dll/isa_dle/compelling/a_reply_behind_rr_is_none",
        .purpose = "ISA-21",
        .requirement = "A reply that begins after V(RR) is none, and nothing is sent into it.",
        .reference = isa_paper("VC(RR): the time for which a reply is waited for"),
        .details = {{own("late replies are discarded"), {"late_reply_taken"}}},
        .stimulus = "An ES; the IUT compels the peer, which begins to reply two octets after V(RR).",
        .expected = "The IUT has begun before, or begins after the reply; the reply is not delivered.",
        .tags = {"must", "timing"},
        .catches = {{"reply_wait_a_tenth_longer", "late_reply_taken"},
                    {"deaf_and_late", "talks_into_reply"}}},
       a_reply_behind_rr_is_none},
      {{.id = "fieldbus_dll/isa_dle/compelling/a_cd_in_place_of_a_reply_is_not_answered",
        .purpose = "ISA-26",
        .requirement = "Who waits for a reply does not answer a CD: two would have the line.",
        .reference = own("another DLPDU in place of a reply"),
        .stimulus = "An ES; the IUT compels the peer; a third station compels the IUT.",
        .expected = "No DT.",
        .tags = {"must"},
        .catches = {{"answers_while_waiting", "answers_while_waiting"}}},
       a_cd_in_place_of_a_reply_is_not_answered},
  };
}

}  // namespace fieldproof::conformance
