#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// ET: the token for one frame.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

Octets queue_some(IsaBench& bench, CaseJudge& judge, Priority priority) {
  return expect_submitted(bench, judge, IsaService::unit_data, priority, 2 + bench.random().below(30));
}

TokenUse use_et(IsaBench& bench, CaseJudge& judge, Priority least) {
  const kernel::Time end = bench.send(bench.et(least));
  return expect_token_use(bench, judge, end);
}

void one_frame_is_sent(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const Octets data = queue_some(bench, judge, Priority::normal);
    const TokenUse use = use_et(bench, judge, Priority::normal);
    expect_data(judge, use, {data}, "no_data_frame", "more_than_one_frame");
    judge.expect(use.data[0].octet(1) == IsaBench::kPeer && priority_of(use.data[0]) == Priority::normal,
                 "dlpdu_wrong", "DU normal to 22", use.data[0].text());
    expect_end_reason(judge, use, EndReason::single_frame_done);
  }
}

void the_others_stay_queued(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(1, 10); ++n) {
    std::vector<Octets> queued;
    for (int i = 0; i < 3; ++i) queued.push_back(queue_some(bench, judge, Priority::normal));
    for (const Octets& data : queued) {
      expect_data(judge, use_et(bench, judge, Priority::normal), {data}, "queued_data_lost",
                  "more_than_one_frame");
    }
    expect_data(judge, use_et(bench, judge, Priority::normal), {}, "", "sent_twice");
  }
}

void an_empty_queue_returns_the_token(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    for (const Priority least : {Priority::urgent, Priority::normal, Priority::time_available}) {
      const TokenUse use = use_et(bench, judge, least);
      expect_data(judge, use, {}, "", "unexpected_dlpdu");
      expect_end_reason(judge, use, EndReason::nothing_to_send);
    }
  }
}

void less_urgent_frames_wait(IsaBench& bench, CaseJudge& judge) {
  const Octets normal = queue_some(bench, judge, Priority::normal);
  const Octets available = queue_some(bench, judge, Priority::time_available);
  expect_data(judge, use_et(bench, judge, Priority::urgent), {}, "", "lower_priority_sent");
  expect_data(judge, use_et(bench, judge, Priority::normal), {normal}, "no_data_frame",
              "more_than_one_frame");
  expect_data(judge, use_et(bench, judge, Priority::normal), {}, "", "lower_priority_sent");
  expect_data(judge, use_et(bench, judge, Priority::time_available), {available}, "no_data_frame",
              "more_than_one_frame");
}

void the_most_urgent_is_sent(IsaBench& bench, CaseJudge& judge) {
  const Octets available = queue_some(bench, judge, Priority::time_available);
  const Octets normal = queue_some(bench, judge, Priority::normal);
  const Octets urgent = queue_some(bench, judge, Priority::urgent);
  const TokenUse use = use_et(bench, judge, Priority::normal);
  judge.expect(use.data.size() == 1 && use.data[0].rest() == urgent, "not_most_urgent", [&] {
    return Mismatch{{"the urgent DLSDU"}, use.data.empty() ? "nothing" : use.data[0].text()};
  });
  judge.expect(priority_of(use.data[0]) == Priority::urgent, "dlpdu_wrong", "priority urgent",
               use.data[0].text());
}

}  // namespace

std::vector<IsaCase> isa_single_token_cases() {
  using link_sources::isa_paper;
  return {
      {{.id = "fieldbus_dll/isa_dle/single_token/one_frame_is_sent",
        .purpose = "ISA-01",
        .requirement = "Under an ET a station sends one frame and returns the token by EE.",
        .reference = isa_paper("delegated token for a single frame"),
        .stimulus = "A DLSDU is submitted, an ET of its priority comes.",
        .expected = "One DU with it, then an EE, and silence.",
        .tags = {"must"},
        .catches = {{"no_frame_under_et", "no_data_frame"},
                    {"source_of_scheduler", "source_wrong"},
                    {"end_to_everybody", "dlpdu_wrong"},
                    {"end_sent_twice", "talks_behind_end"}}},
       one_frame_is_sent},
      {{.id = "fieldbus_dll/isa_dle/single_token/the_others_stay_queued",
        .purpose = "ISA-02",
        .requirement = "Under an ET a station sends one frame; what else is queued waits for the next token.",
        .reference = isa_paper("delegated token for a single frame"),
        .stimulus = "Three DLSDUs, then four ETs.",
        .expected = "One DU with each, in order; nothing with the fourth.",
        .tags = {"must"},
        .catches = {{"et_sends_all", "more_than_one_frame"}, {"queue_lost_behind_et", "queued_data_lost"}}},
       the_others_stay_queued},
      {{.id = "fieldbus_dll/isa_dle/single_token/an_empty_queue_returns_the_token",
        .purpose = "ISA-03",
        .requirement = "A station without data returns the token within V(RR).",
        .reference = isa_paper("EE: the use of the token has ended"),
        .stimulus = "ETs of each priority, nothing submitted.",
        .expected = "An EE alone, begun within V(RR).",
        .tags = {"must"},
        .catches = {{"no_end_when_empty", "token_not_returned"},
                    {"answers_behind_rr", "answers_too_late"},
                    {"end_reason_always_done", "end_reason_wrong"}}},
       an_empty_queue_returns_the_token},
      {{.id = "fieldbus_dll/isa_dle/single_token/lower_priorities_wait",
        .purpose = "ISA-04",
        .requirement = "Only data whose priority is at least that of the token is sent.",
        .reference = isa_paper("priority of the delegated token"),
        .stimulus = "Normal and time-available data; tokens urgent, normal, normal, time-available.",
        .expected = "Nothing, the normal one, nothing, the time-available one.",
        .tags = {"must"},
        .catches = {{"priority_inverted", "lower_priority_sent"},
                    {"priority_ignored", "lower_priority_sent"}}},
       less_urgent_frames_wait},
      {{.id = "fieldbus_dll/isa_dle/single_token/the_most_urgent_is_sent",
        .purpose = "ISA-05",
        .requirement = "Data of the higher priority is sent first.",
        .reference = isa_paper("higher priority first"),
        .stimulus = "Data of all priorities is submitted, the least urgent first; an ET.",
        .expected = "The urgent one.",
        .tags = {"must"},
        .catches = {{"fifo_across_priorities", "not_most_urgent"}}},
       the_most_urgent_is_sent},
  };
}

}  // namespace fieldproof::conformance
