#include <fmt/format.h>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// ES: the token for a duration; what is sent under it, and in which order.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

constexpr unsigned kAmpleDuration = 5'000;  // octet durations: more than all that is queued needs

Octets queue_sized(IsaBench& bench, CaseJudge& judge, Priority priority, std::size_t size) {
  return expect_submitted(bench, judge, IsaService::unit_data, priority, size);
}

TokenUse use_es(IsaBench& bench, CaseJudge& judge, Priority least) {
  const kernel::Time end = bench.send(bench.es(least, kAmpleDuration));
  return expect_token_use(bench, judge, end);
}

void all_is_sent_by_priority(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(1, 10); ++n) {
    std::vector<Octets> available, normal, urgent;
    for (int i = 0; i < 2; ++i) {
      available.push_back(queue_sized(bench, judge, Priority::time_available, 20));
      normal.push_back(queue_sized(bench, judge, Priority::normal, 20));
      urgent.push_back(queue_sized(bench, judge, Priority::urgent, 20));
    }
    std::vector<Octets> in_order = urgent;
    in_order.insert(in_order.end(), normal.begin(), normal.end());
    in_order.insert(in_order.end(), available.begin(), available.end());
    const TokenUse use = use_es(bench, judge, Priority::time_available);
    judge.expect(use.data.size() == in_order.size(), "frames_missing",
                 [&] { return Mismatch{{"all six DLSDUs"}, fmt::format("{}", use.data.size())}; });
    for (std::size_t i = 0; i < in_order.size(); ++i) {
      judge.expect(use.data[i].rest() == in_order[i], "wrong_order", [&] {
        return Mismatch{{"two urgent, two normal, two time-available, each pair as submitted"},
                        use.data[i].text(),
                        use.data[i].begin,
                        fmt::format("data DLPDU {}", i + 1)};
      });
    }
    expect_end_reason(judge, use, EndReason::nothing_to_send);
  }
}

void lower_priorities_wait(IsaBench& bench, CaseJudge& judge) {
  const Octets urgent = queue_sized(bench, judge, Priority::urgent, 10);
  const Octets normal = queue_sized(bench, judge, Priority::normal, 10);
  const Octets available = queue_sized(bench, judge, Priority::time_available, 10);
  expect_data(judge, use_es(bench, judge, Priority::normal), {urgent, normal}, "frames_missing",
              "lower_priority_sent");
  expect_data(judge, use_es(bench, judge, Priority::time_available), {available}, "frames_missing",
              "sent_twice");
}

void what_is_not_used_is_returned(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const Octets data = queue_sized(bench, judge, Priority::normal, 2 + bench.random().below(100));
    const TokenUse use = use_es(bench, judge, Priority::time_available);
    expect_data(judge, use, {data}, "frames_missing", "sent_twice");
  }
}

void what_is_urgent_goes_next(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 10); ++n) {
    const Octets first = queue_sized(bench, judge, Priority::time_available, 40);
    const Octets second = queue_sized(bench, judge, Priority::time_available, 40);
    bench.send(bench.es(Priority::time_available, kAmpleDuration));
    const bool has_begun = bench.next_begins(bench.now() + bench.observation_timeout());
    judge.expect(has_begun, "frames_missing", "the first DLSDU", "silence");
    bench.wait(bench.octets(5 + static_cast<std::int64_t>(bench.random().below(30))));
    const Octets urgent = queue_sized(bench, judge, Priority::urgent, 10);
    const std::vector<Octets> in_order{first, urgent, second};
    for (const Octets& data : in_order) {
      const DrivenDlpdu one = expect_next(bench, judge, "frames_missing", "the next DLSDU");
      judge.expect(one.rest() == data, "not_most_urgent", [&] {
        return Mismatch{{"after the frame that is being sent, the urgent one"}, one.text(), one.begin};
      });
    }
    bench.listen();
  }
}

}  // namespace

std::vector<IsaCase> isa_sequence_cases() {
  using link_sources::isa_paper;
  return {
      {{.id = "fieldbus_dll/isa_dle/sequence/all_is_sent_by_priority",
        .purpose = "ISA-06",
        .requirement = "Under an ES a station sends what it has, the higher priority first, and returns the "
                       "token by EE.",
        .reference = isa_paper("delegated token for a duration; higher priority first"),
        .stimulus = "Two DLSDUs of each priority, a long ES.",
        .expected = "Two urgent, two normal, two time-available, an EE.",
        .tags = {"must"},
        .catches = {{"fifo_across_priorities", "wrong_order"}, {"es_sends_one", "frames_missing"}}},
       all_is_sent_by_priority},
      {{.id = "fieldbus_dll/isa_dle/sequence/lower_priorities_wait",
        .purpose = "ISA-07",
        .requirement = "Only data whose priority is at least that of the token is sent.",
        .reference = isa_paper("priority of the delegated token"),
        .stimulus = "Data of all priorities; a long ES normal, then one time-available.",
        .expected = "Urgent and normal under the first, the rest under the second.",
        .tags = {"must"},
        .catches = {{"priority_inverted", "data_wrong"}, {"priority_ignored", "lower_priority_sent"}}},
       lower_priorities_wait},
      {{.id = "fieldbus_dll/isa_dle/sequence/what_is_not_used_is_returned",
        .purpose = "ISA-10",
        .requirement = "A station returns the token as soon as it needs it no more.",
        .reference = isa_paper("EE: the use of the token has ended"),
        .stimulus = "One DLSDU, a long ES.",
        .expected = "The EE between V(MID) and V(RR) after the DU.",
        .tags = {"must", "timing"},
        .catches = {{"no_end_of_sequence", "token_not_returned"}, {"rests_before_end", "answers_too_late"}}},
       what_is_not_used_is_returned},
      {{.id = "fieldbus_dll/isa_dle/sequence/what_is_urgent_goes_next",
        .purpose = "ISA-11",
        .requirement = "What becomes urgent while a frame is being sent is sent next.",
        .reference = isa_paper("higher priority first"),
        .stimulus = "An ES with two time-available DLSDUs; an urgent one while the first is on the line.",
        .expected = "The first, the urgent one, the second.",
        .tags = {"must"},
        .catches = {{"finishes_a_priority", "not_most_urgent"}}},
       what_is_urgent_goes_next},
  };
}

}  // namespace fieldproof::conformance
