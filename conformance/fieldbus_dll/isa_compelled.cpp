#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// The IUT is compelled by a CD.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

Octets offer(IsaBench& bench, CaseJudge& judge, Priority priority) {
  return expect_submitted(bench, judge, IsaService::reply_data, priority, 2 + bench.random().below(50));
}

// A DT to the peer with this data, whose frame begins within V(FD).
DrivenDlpdu expect_reply(IsaBench& bench, CaseJudge& judge, kernel::Time cd_end, const Octets& data,
                         std::string_view reason_for_other_data) {
  const DrivenDlpdu dt = expect_next(bench, judge, "no_reply", "a DT");
  expect_begins(judge, dt, cd_end + bench.least_gap(), "answers_too_early", cd_end + bench.reply_forming(),
                "reply_too_late");
  const auto sighting = [&](std::string expected) {
    return [&, expected] { return Mismatch{{expected}, dt.text(), dt.begin}; };
  };
  judge.expect(is_type(dt, bench.rules().codes.dt) && dt.octet(1) == IsaBench::kPeer, "dlpdu_wrong",
               sighting("DT to the station that compelled"));
  judge.expect(is_final(dt), "not_final", sighting("F = 1: the reply token is returned"));
  judge.expect(dt.rest() == data, reason_for_other_data,
               sighting(fmt::format("DLSDU [{:02X}]", fmt::join(data, " "))));
  return dt;
}

void data_is_sent(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 30); ++n) {
    const Octets data = offer(bench, judge, Priority::normal);
    const kernel::Time end = bench.send(bench.cd(Priority::normal));
    expect_reply(bench, judge, end, data, "data_wrong");
    expect_silence(bench, judge, "talks_behind_reply", "one DT is sent");
  }
}

void what_comes_behind_fd_is_kept(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 10); ++n) {
    bench.user().works_on_reply = true;
    const kernel::Time end = bench.send(bench.cd(Priority::normal));
    bench.run_until(end + bench.reply_forming() + bench.octets(2));
    const Octets data = offer(bench, judge, Priority::normal);
    bench.user().works_on_reply = false;
    expect_silence(bench, judge, "reply_too_late", "V(FD) is over");
    const kernel::Time again = bench.send(bench.cd(Priority::normal));
    expect_reply(bench, judge, again, data, "late_data_lost");
    bench.wait(bench.reply_wait());
  }
}

void what_comes_within_fd_is_sent(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 10); ++n) {
    bench.user().works_on_reply = true;
    const kernel::Time end = bench.send(bench.cd(Priority::normal));
    bench.run_until(end + bench.reply_forming() - bench.octets(2));
    const Octets data = offer(bench, judge, Priority::normal);
    bench.user().works_on_reply = false;
    expect_reply(bench, judge, end, data, "data_wrong");
    bench.wait(bench.reply_wait());
  }
}

void no_data_is_an_empty_reply(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 10); ++n) {
    for (const Priority least : {Priority::urgent, Priority::normal, Priority::time_available}) {
      const kernel::Time end = bench.send(bench.cd(least));
      expect_reply(bench, judge, end, {}, "data_wrong");
      bench.wait(bench.reply_wait());
    }
  }
}

void lower_priorities_are_kept(IsaBench& bench, CaseJudge& judge) {
  const Octets normal = offer(bench, judge, Priority::normal);
  kernel::Time end = bench.send(bench.cd(Priority::urgent));
  expect_reply(bench, judge, end, {}, "lower_priority_sent");
  bench.wait(bench.reply_wait());
  const Octets urgent = offer(bench, judge, Priority::urgent);
  for (const Octets& data : {urgent, normal}) {
    end = bench.send(bench.cd(Priority::normal));
    expect_reply(bench, judge, end, data, "data_wrong");
    bench.wait(bench.reply_wait());
  }
}

}  // namespace

std::vector<IsaCase> isa_compelled_cases() {
  using link_sources::isa_paper;
  using link_sources::own;
  const PartialSource forming{own("V(FD) is 24 octets, from the end of the CD"), {"reply_too_late"}};
  return {
      {{.id = "fieldbus_dll/isa_dle/compelled/data_is_sent",
        .purpose = "ISA-22",
        .requirement = "A station that is compelled sends its data in one DT and returns the reply token.",
        .reference = isa_paper("reply token"),
        .details = {forming},
        .stimulus = "A DLSDU is submitted, a CD comes.",
        .expected = "A final DT with it, begun between V(MID) and V(FD).",
        .tags = {"must", "timing"},
        .catches = {{"short_silence", "answers_too_early"},
                    {"reply_not_final", "not_final"},
                    {"reply_to_scheduler", "dlpdu_wrong"},
                    {"replies_twice", "talks_behind_reply"}}},
       data_is_sent},
      {{.id = "fieldbus_dll/isa_dle/compelled/what_comes_behind_fd_is_kept",
        .purpose = "ISA-23",
        .requirement = "A station whose reply is not there within V(FD) is silent.",
        .reference = isa_paper("VC(FD): the time to form a reply"),
        .details = {forming, {own("what was too late answers the next CD"), {"late_data_lost"}}},
        .stimulus = "A CD; the user says that it works on the reply and submits it after V(FD).",
        .expected = "Silence; the data answers the next CD.",
        .tags = {"must", "timing"},
        .catches = {{"replies_late", "reply_too_late"}, {"late_reply_lost", "late_data_lost"}}},
       what_comes_behind_fd_is_kept},
      {{.id = "fieldbus_dll/isa_dle/compelled/what_comes_within_fd_is_sent",
        .purpose = "ISA-23",
        .requirement = "A reply that is there within V(FD) is sent.",
        .reference = isa_paper("VC(FD): the time to form a reply"),
        .details = {forming},
        .stimulus = "A CD; the user says that it works on the reply and submits it two octets before V(FD).",
        .expected = "A DT with it, begun within V(FD).",
        .tags = {"must", "timing"},
        .catches = {{"does_not_wait_for_user", "data_wrong"}}},
       what_comes_within_fd_is_sent},
      {{.id = "fieldbus_dll/isa_dle/compelled/no_data_is_an_empty_reply",
        .purpose = "ISA-24",
        .requirement = "A station that is compelled and has nothing to send sends an empty DT.",
        .reference = own("a CD without data"),
        .details = {forming},
        .stimulus = "CDs of each priority, nothing submitted.",
        .expected = "A final DT without data.",
        .tags = {"must"},
        .catches = {{"no_data_no_reply", "no_reply"}}},
       no_data_is_an_empty_reply},
      {{.id = "fieldbus_dll/isa_dle/compelled/lower_priorities_are_kept",
        .purpose = "ISA-25",
        .requirement = "A reply has at least the priority of the CD.",
        .reference = own("priority of a CD"),
        .details = {forming},
        .stimulus = "Normal data, a CD urgent; then urgent data, too, and CDs normal.",
        .expected = "An empty DT; the urgent data, the normal data.",
        .tags = {"must"},
        .catches = {{"reply_ignores_priority", "lower_priority_sent"}}},
       lower_priorities_are_kept},
  };
}

}  // namespace fieldproof::conformance
