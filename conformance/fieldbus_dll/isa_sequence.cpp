#include <fmt/format.h>

#include "conformance/fieldbus_dll/isa_scene.hpp"

// ES: the token for a duration; what is sent under it, and in which order.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::Priority;

constexpr unsigned kAmpleDuration = 5'000;  // octet durations: more than all that is queued needs

IsaStep next_is(std::size_t number) {
  return expected<IsaScene>(fmt::format("DLSDU {} next", number), [number](IsaScene& scene) {
    const DrivenDlpdu one = expect_next(scene.bench, scene.judge, "frames_missing", "the next DLSDU");
    scene.judge.expect(one.rest() == scene.submitted.at(number - 1), "not_most_urgent", [&] {
      return Mismatch{{"after the frame that is being sent, the urgent one"}, one.text(), one.begin};
    });
  });
}

}  // namespace

std::vector<IsaCase> isa_sequence_cases() {
  using namespace isa_chart;
  using enum Priority;
  using link_sources::isa_paper;
  return {
      on_chart(
          must_case("fieldbus_dll/isa_dle/sequence/all_is_sent_by_priority", "ISA-06",
                    "Under an ES a station sends what it has, the higher priority first, and returns the "
                    "token by EE.",
                    isa_paper("delegated token for a duration; higher priority first"),
                    {{"fifo_across_priorities", "wrong_order"}, {"es_sends_one", "frames_missing"}}),
          {{1, 10},
           {submit({time_available, normal, urgent, time_available, normal, urgent}, 20),
            es(time_available, kAmpleDuration),
            used({3, 6, 2, 5, 1, 4}, {"frames_missing", "frames_missing", "wrong_order"}),
            end_reason(EndReason::nothing_to_send)}}),
      on_chart(must_case("fieldbus_dll/isa_dle/sequence/lower_priorities_wait", "ISA-07",
                         "Only data whose priority is at least that of the token is sent.",
                         isa_paper("priority of the delegated token"),
                         {{"priority_inverted", "data_wrong"}, {"priority_ignored", "lower_priority_sent"}}),
               {{},
                {submit({urgent, normal, time_available}, 10), es(normal, kAmpleDuration),
                 used({1, 2}, {"frames_missing", "lower_priority_sent"}), es(time_available, kAmpleDuration),
                 used({3}, {"frames_missing", "sent_twice"})}}),
      on_chart(must_in_time(
                   "fieldbus_dll/isa_dle/sequence/what_is_not_used_is_returned", "ISA-10",
                   "A station returns the token as soon as it needs it no more.",
                   isa_paper("EE: the use of the token has ended"),
                   {{"no_end_of_sequence", "token_not_returned"}, {"rests_before_end", "answers_too_late"}}),
               {{2, 20},
                {submit({normal}, 2, 101), es(time_available, kAmpleDuration),
                 used({1}, {"frames_missing", "sent_twice"})}}),
      on_chart(must_case("fieldbus_dll/isa_dle/sequence/what_is_urgent_goes_next", "ISA-11",
                         "What becomes urgent while a frame is being sent is sent next.",
                         isa_paper("higher priority first"), {{"finishes_a_priority", "not_most_urgent"}}),
               {{2, 10},
                {submit({time_available, time_available}, 40), es(time_available, kAmpleDuration),
                 expected<IsaScene>("a DLPDU begins",
                                    [](IsaScene& scene) {
                                      scene.judge.expect(
                                          scene.bench.next_begins(scene.bench.now() +
                                                                  scene.bench.observation_timeout()),
                                          "frames_missing", "the first DLSDU", "silence");
                                    }),
                 stimulus<IsaScene>("5 to 34 octets of it pass",
                                    [](IsaScene& scene) {
                                      scene.bench.wait(scene.bench.octets(
                                          5 + static_cast<std::int64_t>(scene.bench.random().below(30))));
                                    }),
                 submit({urgent}, 10), next_is(1), next_is(3), next_is(2),
                 says("the token returned", "token_not_returned")}}),
  };
}

}  // namespace fieldproof::conformance
