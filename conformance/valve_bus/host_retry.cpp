#include <fmt/format.h>

#include "conformance/valve_bus/host_scene.hpp"

// What becomes of a read that is not answered, or wrongly, or too late.
namespace fieldproof::conformance {
namespace {

using valve_bus::HostCounters;
using valve_bus::HostErrorKind;

// The node is polled again as long after the last poll as the time-out is.
HostStep polled_again_in_time() {
  return expected(
      "the host polls the node again after the time-out, within 5 %, where it knows of a start bit when its "
      "character is over",
      [](HostScene& scene) {
        scene.poll = expect_retry_in_time(scene.bench, scene.judge, scene.request, scene.poll.end);
      });
}

void expect_error_in_time(HostScene& scene) {
  const kernel::Time limit = scene.poll.end + latest_repetition(scene.bench);
  const auto told = scene.bench.next_told(scene.bench.observation_timeout());
  scene.judge.expect(told && told->when <= limit, "error_late", [&] {
    return Mismatch{{fmt::format("an error at {} at the latest", kernel::describe(limit))},
                    told ? text_of(*told) : std::string("nothing was reported")};
  });
  const auto* error = std::get_if<valve_bus::HostError>(&told->what);
  scene.judge.expect(error != nullptr && *error == valve_bus::HostError{scene.id, HostErrorKind::no_response},
                     "error_wrong", fmt::format("an error of {:02X}: no response", scene.id), text_of(*told));
}

// The other node is read next.
void answer_late(HostScene& scene) {
  scene.bench.order(scene.bench.read_of(scene.other));
  scene.answer(host_chart::right_octets(scene), scene.bench.late_turnaround_time());
}

void expect_other_polled(HostScene& scene) {
  expect_old_if_known(scene.bench, scene.judge, scene.id);
  expect_request(scene.bench, scene.judge, scene.bench.read_of(scene.other));
}

void serve_other(HostScene& scene) {
  const valve_bus::Response response = scene.bench.random_response();
  scene.bench.answer(response, scene.bench.turnaround_time() + scene.bench.bits(1));
  expect_response(scene.bench, scene.judge, scene.other, response);
}

// One of the ways in which a response can be wrong, another one in each round and attempt.
HostStep wrong_answer(unsigned attempt) {
  return stimulus("the node answers with a wrong check, two octets, or a wrong stop bit",
                  [attempt](HostScene& scene) {
                    scene.octets = host_chart::right_octets(scene);
                    const unsigned way = (scene.round + attempt) % 3;
                    if (way == 0) ++scene.octets.back();
                    if (way == 1) scene.octets.pop_back();
                    line::Levels levels = scene.levels(scene.bench.rules().characters);
                    if (way == 2) levels.flip(scene.bench.levels_of(0).size() - 1);  // the first stop bit
                    scene.bench.answer_levels(levels, scene.bench.turnaround_time());
                  });
}

HostCase silent_node_case(unsigned dip, std::string_view rate, std::vector<MustCatch> catches) {
  using namespace host_chart;
  return on_chart(
      {.id = fmt::format("valve_bus/host/retry/silent_node_is_polled_three_times_at_{}", rate),
       .purpose = "RH-08",
       .requirement = "A node that does not answer within a delimiter and 3 ms is polled again, three "
                      "times in all; then an error is reported to the PC.",
       .reference = valve_sources::own("time-out and attempts"),
       .tags = {"must", "timing"},
       .catches = std::move(catches),
       .not_applicable = for_settable_dip()},
      {{2, 50},
       {read(), stimulus(fmt::format("no node answers, at {} bit/s", rate), [](HostScene&) {}),
        polled_again_in_time(), polled_again_in_time(), not_polled_again(),
        expected("after the last time-out the PC gets an error: no response", expect_error_in_time),
        counted(&HostCounters::timeouts, 3, "time-outs"),
        nothing_reported(kernel::kMillisecond, "data_of_silence_told", "nothing was known")}},
      {.dip = dip});
}

}  // namespace

std::vector<HostCase> host_retry_cases() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("time-out and attempts");
  return {
      silent_node_case(0, "375000",
                       {{"two_attempts", "no_retry"},
                        {"four_attempts", "polled_too_often"},
                        {"time_out_short", "time_out_too_short"},
                        {"time_out_long", "time_out_too_long"}}),
      silent_node_case(4, "20833", {{"time_out_fixed", "time_out_too_short"}}),

      on_chart({.id = "valve_bus/host/retry/response_just_in_time_is_taken",
                .purpose = "RH-09",
                .requirement = "A response that begins 5 % before the time-out is taken.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"time_out_short", "response_not_told"}}},
               {{3, 100},
                {read(),
                 answer("the node answers rightly at 0.95 times the time-out", right_octets,
                        [](HostScene& scene) { return earliest_repetition(scene.bench); }),
                 reported()}}),
      on_chart(
          {.id = "valve_bus/host/retry/late_response_is_drained",
           .purpose = "RH-09",
           .requirement = "A response that begins after the last time-out is counted, not reported, "
                          "and not taken for the response of the node that is polled next.",
           .reference = own,
           .tags = {"must", "timing", "hazard"},
           .catches = {{"takes_late_response", "late_response_told"},
                       {"late_not_counted", "late_not_counted"}}},
          {{3, 100},
           {read(),
            polled_again(),
            polled_again(),
            stimulus("the node answers after the time-out of the last poll, while the host rests, with a "
                     "read of another node waiting",
                     answer_late),
            error(HostErrorKind::no_response, "late_response_told"),
            expected("the host polls the other node", expect_other_polled),
            nothing_reported([](HostScene& scene) { return scene.bench.turnaround_time(); },
                             "late_response_told", "the other node has not answered yet"),
            counted(&HostCounters::late, 1, "late responses", "late_not_counted"),
            {"the other node answers rightly", "the PC gets its data", serve_other}}}),

      on_chart({.id = "valve_bus/host/retry/third_attempt_is_taken",
                .purpose = "RH-16",
                .requirement = "After two wrong responses a right one is reported; retries and wrong "
                               "responses are counted for this node.",
                .reference = own,
                .tags = {"must"},
                .catches = {{"two_attempts", "no_retry"},
                            {"bad_response_not_repeated", "no_retry"},
                            {"counters_shared", "counters_wrong"}}},
               {{6, 200},
                {read(), wrong_answer(1), polled_again(), wrong_answer(2), polled_again(), response(),
                 reported(), counted(&HostCounters::retries, 2, "retries"),
                 counted(&HostCounters::rejected, 2, "rejected responses")}}),
      on_chart(
          {.id = "valve_bus/host/retry/three_wrong_responses_are_an_error",
           .purpose = "RH-17",
           .requirement = "After three wrong responses an error is reported to the PC, and what was known "
                          "of the node, marked as old.",
           .reference = own,
           .tags = {"must"},
           .catches = {{"old_told_as_new", "old_data_told_as_new"},
                       {"old_forgotten", "old_data_not_told"},
                       {"four_attempts", "polled_too_often"}}},
          {{3, 100},
           {served_read(), read(), wrong_answer(0), polled_again(), wrong_answer(1), polled_again(),
            wrong_answer(2), not_polled_again(), error(HostErrorKind::bad_response, "wrong_response_told"),
            old_data(), nothing_reported(kernel::kMillisecond, "told_twice", "it has been reported")}}),
  };
}

}  // namespace fieldproof::conformance
