#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_scene.hpp"

// PT: what a device sends under a token, and how it returns it.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

constexpr unsigned kAmple = 3'000;     // octet durations: more than all that is queued needs
constexpr std::size_t kDt1Header = 5;  // with short addresses

// In octet durations, a begun one counted.
unsigned in_whole_octets(const FfBench& bench, kernel::Duration duration) {
  const kernel::Duration one = bench.octets(1);
  return static_cast<unsigned>((duration + one - kLinkRounding) / one);
}

// Was the one DT1 that waits sent? A station may begin a little sooner or later than it did before: what
// counts is whether the DT1 ends within the duration, from where it began to send.
bool fit_is_judged(FfBench& bench, CaseJudge& judge, unsigned duration, std::size_t size) {
  const kernel::Time end = bench.send(bench.pt(Priority::normal, duration));
  const kernel::Time over = end + bench.octets(duration);
  const std::vector<DrivenDlpdu> sent = expect_token_used(bench, judge, end);
  const DrivenDlpdu& last = bench.driven().back();
  const auto sighting = [&] {
    return Mismatch{{fmt::format("a DT1 that ends until {}, and is sent then", kernel::describe(over))},
                    fmt::format("{} from {} to {}", last.text(), kernel::describe(last.begin),
                                kernel::describe(last.end)),
                    last.begin};
  };
  if (!sent.empty()) judge.expect(last.end <= over + kLinkRounding, "sends_what_does_not_fit", sighting);
  const bool has_room = last.begin + bench.frame(kDt1Header + size) <= over + kLinkRounding;
  judge.expect(!sent.empty() || !has_room, "exact_fit_not_sent", sighting);
  return !sent.empty();
}

void measure_latency(FfScene& scene) {
  scene.latency = scene.answer.begin - scene.sent;
  scene.judge.measure("start latency", "octets", static_cast<double>(scene.latency / scene.bench.octets(1)));
}

void expect_exact_fit(FfScene& scene) {
  FfBench& bench = scene.bench;
  const Octets& data = scene.submitted.back();
  const unsigned fit = in_whole_octets(bench, scene.latency + bench.frame(kDt1Header + data.size()));
  const bool has_room_for_rt = fit - 1 >= in_whole_octets(bench, scene.latency + bench.frame(1));
  bool is_sent = has_room_for_rt && fit_is_judged(bench, scene.judge, fit - 1, data.size());
  if (!is_sent) is_sent = fit_is_judged(bench, scene.judge, fit, data.size());
  if (is_sent) return;
  scene.sent = bench.send(bench.pt(Priority::normal, 2 * fit));
  scene.expect_used({data}, {"frames_missing", "sent_twice"});
}

// Short frames, too: of those some end just after a duration.
void expect_nothing_behind_duration(FfScene& scene) {
  FfBench& bench = scene.bench;
  const std::uint64_t longest = scene.round % 6 == 0 ? 250 : 12;
  const auto duration = static_cast<unsigned>(32 + bench.random().below(4 * longest));
  for (int i = 0; i < 8; ++i)
    bench.submit(Priority::time_available, bench.numbered_data(2 + bench.random().below(longest)));
  scene.sent = bench.send(bench.pt(Priority::time_available, duration));
  scene.expect_none_after("PT", duration);
}

void expect_all_in_turn(FfScene& scene) {
  std::vector<Octets>& left = scene.submitted;
  for (int tokens = 0; !left.empty(); ++tokens) {
    scene.judge.expect(tokens < 12, "queued_data_lost", "each token takes at least one DT1", "some are left");
    const kernel::Time end = scene.bench.send(scene.bench.pt(Priority::normal, 250));
    const std::vector<DrivenDlpdu> sent = expect_token_used(scene.bench, scene.judge, end);
    scene.judge.expect(!sent.empty() && sent.size() <= left.size(), "frames_missing", "at least one DT1",
                       "none");
    const auto last = left.begin() + static_cast<std::ptrdiff_t>(sent.size());
    expect_dlsdus(scene.judge, sent, dlsdu_of, {left.begin(), last},
                  {"frames_missing", "sent_twice", "wrong_order"});
    left.erase(left.begin(), last);
  }
}

}  // namespace

std::vector<FfCase> ff_token_cases() {
  using namespace ff_chart;
  using enum Priority;
  const Chart<FfScene> all_in_order{
      {1, 10},
      {submit({time_available, normal, urgent, time_available, normal, urgent}, 12),
       pt(time_available, kAmple),
       used({3, 6, 2, 5, 1, 4}, {"frames_missing", "sent_twice", "wrong_order"})}};
  const LinkStep unused = used({}, {"", "unexpected_dlpdu"});
  const FfStep ample =
      repeat({2, 2}, {pt(time_available, kAmple), says("data, or RT", "token_not_returned")});
  using link_sources::ff_paper;
  using link_sources::memory;
  using link_sources::own;
  return {
      on_chart(must_case("fieldbus_dll/ff_device/token/only_what_is_urgent_enough_is_sent", "FF-03",
                         "Under a PT a station sends data whose priority is at least that of the PT.",
                         ff_paper("priority of the token"),
                         {{"mute_after_activation", "token_not_returned"},
                          {"priority_ignored", "lower_priority_sent"},
                          {"priority_inverted", "data_wrong"},
                          {"sends_to_another", "dlpdu_wrong"},
                          {"sends_as_another", "dlpdu_wrong"}}),
               {{},
                {submit({urgent, normal, time_available}, 10), pt(normal, 1'000),
                 used({1, 2}, {"frames_missing", "lower_priority_sent"}), pt(urgent, 1'000),
                 used({}, {"", "lower_priority_sent"}), pt(time_available, 1'000),
                 used({3}, {"frames_missing", "sent_twice"})}}),
      on_chart(must_case("fieldbus_dll/ff_device/token/all_is_sent_in_order", "FF-04",
                         "Data of the higher priority is sent first, of one priority as submitted.",
                         ff_paper("three priorities"),
                         {{"mute_after_activation", "token_not_returned"},
                          {"fifo_across_priorities", "wrong_order"},
                          {"one_frame_a_token", "frames_missing"}}),
               all_in_order),
      on_chart(
          must_in_time("fieldbus_dll/ff_device/token/an_empty_queue_returns_the_token", "FF-05",
                       "A token that is not used is returned within V(MRD) x V(ST).",
                       ff_paper("RT: the token returns to the scheduler"),
                       {{"mute_after_activation", "token_not_returned"},
                        {"no_return_when_empty", "token_not_returned"},
                        {"marked_token_unknown", "token_not_returned"},
                        {"answers_late", "answers_too_late"}}),
          {{2, 20}, {pt(urgent, 280), unused, pt(normal, 280), unused, pt(time_available, 280), unused}}),
      on_chart(
          must_in_time(
              "fieldbus_dll/ff_device/token/what_fits_exactly_is_sent_and_no_more", "FF-06",
              "A DT1 is sent when it ends within the duration of the PT.", ff_paper("duration of the token"),
              {{"mute_after_activation", "token_not_returned"},
               {"duration_in_bits", "token_not_returned"},
               {"fit_is_strict", "exact_fit_not_sent"},
               {"duration_from_begin_of_pt", "exact_fit_not_sent"},
               {"overhead_not_charged", "sends_what_does_not_fit"}},
              {{own("the duration begins with the end of the PT and holds whole frames; the last DT1 "
                    "returns the token"),
                {"exact_fit_not_sent", "sends_what_does_not_fit"}}}),
          {{},
           {submit({normal}, 8), pt(normal, 500), used({1}, {"frames_missing", "sent_twice"}),
            stimulus<FfScene>("the time until it begins is measured", measure_latency),
            repeat({3, 30},
                   {submit({normal}, 20, 119),
                    FfStep{"a PT for an octet less than a DT1 with it needs, then one for exactly that",
                           "the DT1 when it ends within the duration, else a RT", expect_exact_fit}})}}),
      on_chart(must_in_time("fieldbus_dll/ff_device/token/nothing_is_sent_behind_the_duration", "FF-07",
                            "A station sends nothing after the duration of its token.",
                            ff_paper("duration of the token"),
                            {{"mute_after_activation", "token_not_returned"},
                             {"overhead_not_charged", "talks_behind_duration"},
                             {"duration_ignored", "talks_behind_duration"},
                             {"duration_in_two_octets", "talks_behind_duration"}}),
               {{60, 300},
                {{"eight DLSDUs of random lengths, a PT for a random duration",
                  "the last frame ends within the duration", expect_nothing_behind_duration},
                 ample}}),
      on_chart(
          must_case(
              "fieldbus_dll/ff_device/token/what_does_not_fit_is_sent_next_time", "FF-08",
              "Data that does not fit waits for the next token, in order.", memory("use of a token"),
              {{"mute_after_activation", "token_not_returned"}, {"queue_lost_with_token", "frames_missing"}}),
          {{},
           {submit(std::vector(12, normal), 60),
            FfStep{"PTs normal for 250 octet durations, until all is sent",
                   "at least one DT1 under each, all in order, and each token returned",
                   expect_all_in_turn}}}),
      on_chart(must_case("fieldbus_dll/ff_device/token/is_returned_once", "FF-09",
                         "A token is returned by F in the last DT1 or by RT, not by both.",
                         memory("final use, RT"),
                         {{"mute_after_activation", "token_not_returned"},
                          {"returns_twice", "token_returned_twice"},
                          {"never_final", "token_not_returned"}}),
               all_in_order),
      on_chart(must_case("fieldbus_dll/ff_device/token/others_are_left", "FF-10",
                         "A station uses no token of another.", ff_paper("the token is passed to a node"),
                         {{"mute_after_activation", "does_not_recover"},
                          {"answers_for_all_nodes", "uses_token_of_others"}}),
               {{},
                {submit({urgent}, 6),
                 repeat({36, 255}, {send("a PT for another node, each in its turn",
                                         [](FfScene& scene) {
                                           Octets pt = scene.bench.pt(time_available, 500);
                                           pt[1] = scene.other_node();
                                           return pt;
                                         }),
                                    silence("uses_token_of_others", "the PT is for another node")}),
                 serves()}}),
      on_chart(
          must_case("fieldbus_dll/ff_device/token/the_longest_is_sent_and_no_longer", "FF-39",
                    "A DLSDU has at most 64, 128, 256 octets when it is urgent, normal, time-available.",
                    memory("the longest DLSDU of each priority"),
                    {{"mute_after_activation", "token_not_returned"},
                     {"urgent_as_long_as_normal", "too_long_taken"}}),
          {{3, 3},
           {submit_longest(), pt(time_available, kAmple), used({1}, {"longest_not_sent", "too_long_sent"})}}),
  };
}

}  // namespace fieldproof::conformance
