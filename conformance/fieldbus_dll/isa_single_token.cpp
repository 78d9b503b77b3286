#include "conformance/fieldbus_dll/isa_scene.hpp"

// ET: the token for one frame.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::Priority;

}  // namespace

std::vector<IsaCase> isa_single_token_cases() {
  using namespace isa_chart;
  using enum Priority;
  const auto some = [](const std::vector<Priority>& priorities) { return submit(priorities, 2, 31); };
  const DlsduReasons one_frame{"no_data_frame", "more_than_one_frame"};
  const DlsduReasons queued{"queued_data_lost", "more_than_one_frame"};
  const DlsduReasons lower{"", "lower_priority_sent"};
  const IsaStep unused =
      repeat({}, {used({}, {"", "unexpected_dlpdu"}), end_reason(EndReason::nothing_to_send)});
  using link_sources::isa_paper;
  return {
      on_chart(must_case("fieldbus_dll/isa_dle/single_token/one_frame_is_sent", "ISA-01",
                         "Under an ET a station sends one frame and returns the token by EE.",
                         isa_paper("delegated token for a single frame"),
                         {{"no_frame_under_et", "no_data_frame"},
                          {"source_of_scheduler", "source_wrong"},
                          {"end_to_everybody", "dlpdu_wrong"},
                          {"end_sent_twice", "talks_behind_end"}}),
               {{2, 20},
                {some({normal}), et(normal), used({1}, one_frame),
                 require(
                     "a DU normal to 22",
                     [](IsaScene& scene) {
                       return scene.answer.octet(1) == IsaBench::kPeer && priority_of(scene.answer) == normal;
                     },
                     "dlpdu_wrong"),
                 end_reason(EndReason::single_frame_done)}}),
      on_chart(
          must_case("fieldbus_dll/isa_dle/single_token/the_others_stay_queued", "ISA-02",
                    "Under an ET a station sends one frame; what else is queued waits for the next token.",
                    isa_paper("delegated token for a single frame"),
                    {{"et_sends_all", "more_than_one_frame"}, {"queue_lost_behind_et", "queued_data_lost"}}),
          {{1, 10},
           {some({normal, normal, normal}), et(normal), used({1}, queued), et(normal), used({2}, queued),
            et(normal), used({3}, queued), et(normal), used({}, {"", "sent_twice"})}}),
      on_chart(must_case("fieldbus_dll/isa_dle/single_token/an_empty_queue_returns_the_token", "ISA-03",
                         "A station without data returns the token within V(RR).",
                         isa_paper("EE: the use of the token has ended"),
                         {{"no_end_when_empty", "token_not_returned"},
                          {"answers_behind_rr", "answers_too_late"},
                          {"end_reason_always_done", "end_reason_wrong"}}),
               {{2, 20}, {et(urgent), unused, et(normal), unused, et(time_available), unused}}),
      on_chart(
          must_case(
              "fieldbus_dll/isa_dle/single_token/lower_priorities_wait", "ISA-04",
              "Only data whose priority is at least that of the token is sent.",
              isa_paper("priority of the delegated token"),
              {{"priority_inverted", "lower_priority_sent"}, {"priority_ignored", "lower_priority_sent"}}),
          {{},
           {some({normal, time_available}), et(urgent), used({}, lower), et(normal), used({1}, one_frame),
            et(normal), used({}, lower), et(time_available), used({2}, one_frame)}}),
      on_chart(must_case("fieldbus_dll/isa_dle/single_token/the_most_urgent_is_sent", "ISA-05",
                         "Data of the higher priority is sent first.", isa_paper("higher priority first"),
                         {{"fifo_across_priorities", "not_most_urgent"}}),
               {{},
                {some({time_available, normal, urgent}), et(normal),
                 used({3}, {"not_most_urgent", "not_most_urgent", "not_most_urgent"}),
                 require(
                     "its priority urgent",
                     [](IsaScene& scene) { return priority_of(scene.answer) == urgent; }, "dlpdu_wrong")}}),
  };
}

}  // namespace fieldproof::conformance
