#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_scene.hpp"

// The circulation of the token: order, probes, and the priority that the rotation time steers.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr std::int64_t kNodes = 4;

// Four nodes return their tokens at once: a circulation is four tokens and a probe that nobody answers, in
// octet durations 4 (PT 9, silence 8, RT 6, silence 8) and PN 7, V(MRD) x V(ST) 32.
constexpr std::int64_t kFastRotation = kNodes * 31 + 39;

template <std::int64_t target_octets>
void four_nodes(FfConfiguration& configuration) {
  configuration.live = {0x11, 0x12, 0x13, 0x14};
  configuration.rules.target_rotation = target_octets * kOctetAt31250;
}

bool begins_circulation(const FfBench& bench, const DrivenDlpdu& dlpdu) {
  return is_pt(bench, dlpdu) && has_final_use(dlpdu);
}

std::string_view priority_text(Priority priority) {
  return fieldbus_dll::text_of(priority);
}

void each_circulation_probes(FfBench& bench, CaseJudge& judge) {
  const auto& rules = bench.rules();
  // Holders have much to say.
  const auto busy = [&](const DrivenDlpdu& one) -> std::optional<FfBench::Reply> {
    if (!is_pt(bench, one)) return bench.returned(one);
    return FfBench::Reply{bench.dt1(Priority::urgent, 0x1030, fieldbus_dll::address_of(one.octet(1), 1),
                                    Octets(40, 0x55), true)};
  };
  std::uint8_t last = 0;
  std::size_t probes = 0;
  std::size_t wraps = 0;
  bool has_probed = true;
  for (const DrivenDlpdu& one :
       bench.serve(kernel::kStart + bench.octets(bench.volume(40'000, 100'000)), busy)) {
    if (begins_circulation(bench, one)) {
      judge.expect(has_probed, "no_probe",
                   [&] { return Mismatch{{"a PN between two circulations"}, one.text(), one.begin}; });
      has_probed = false;
    }
    if (!is_of(one, rules.codes.pn)) continue;
    has_probed = true;
    ++probes;
    const std::uint8_t node = one.octet(1);
    const bool is_unpolled = node >= rules.first_unpolled && node < rules.first_unpolled + rules.unpolled;
    judge.expect(!is_unpolled, "probes_unpolled", [&] {
      return Mismatch{{fmt::format("no PN for {:02X} to {:02X}", rules.first_unpolled,
                                   rules.first_unpolled + rules.unpolled - 1)},
                      one.text(),
                      one.begin};
    });
    const bool is_live = node >= 0x10 && node <= 0x14;
    judge.expect(!is_live, "probes_live_node",
                 [&] { return Mismatch{{"no PN for a live node"}, one.text(), one.begin}; });
    const bool is_ascending = node > last;
    if (!is_ascending) ++wraps;
    judge.expect(is_ascending || node == 0x15, "probes_out_of_order", [&] {
      return Mismatch{{fmt::format("the next address after {:02X}", last)}, one.text(), one.begin};
    });
    last = node;
  }
  judge.measure("probes", "", static_cast<double>(probes));
  judge.expect(wraps >= 2, "probes_do_not_begin_anew", "the addresses are probed again and again",
               fmt::format("{} probes, {} times from the beginning", probes, wraps));
}

template <std::uint8_t first, std::uint8_t last>
void polled_are(FfConfiguration& configuration) {
  configuration.live = {0x11, 0x12};
  configuration.rules.first_node = first;
  configuration.rules.last_node = last;
}

void expect_probes_of(FfScene& scene, std::initializer_list<int> wanted) {
  auto next = wanted.begin();
  std::size_t probes = 0;
  for (const DrivenDlpdu& one : scene.driven) {
    if (!is_of(one, scene.bench.rules().codes.pn)) continue;
    scene.judge.expect(one.octet(1) == *next, "probes_out_of_order", [&] {
      return Mismatch{{fmt::format("PN for node {:02X}", *next)}, one.text(), one.begin};
    });
    if (++next == wanted.end()) next = wanted.begin();
    ++probes;
  }
  scene.judge.expect(probes > wanted.size(), "no_probe", "PNs, again and again", fmt::format("{}", probes));
}

// With nobody to probe.
void expect_idles(FfScene& scene) {
  std::size_t idles = 0;
  bool has_idled = true;
  for (const DrivenDlpdu& one : scene.driven) {
    if (is_of(one, scene.bench.rules().codes.idle)) {
      has_idled = true;
      ++idles;
    }
    if (!begins_circulation(scene.bench, one)) continue;
    scene.judge.expect(has_idled, "no_idle", [&] {
      return Mismatch{{"an IDLE between two circulations: there is nobody to probe"}, one.text(), one.begin};
    });
    has_idled = false;
  }
  scene.judge.expect(idles > 5, "no_idle", "an IDLE in the place of each probe", fmt::format("{}", idles));
}

Octets data_from(const FfBench& bench, std::uint8_t node, bool is_final) {
  return bench.dt1(Priority::urgent, fieldbus_dll::address_of(FfBench::kScheduler, 0x30),
                   fieldbus_dll::address_of(node, 1), Octets(20, 0x55), is_final);
}

// What the first token of each circulation said, and when.
struct Circulation {
  Priority priority;
  kernel::Time begin;
};

// Of nodes that return their tokens at once, those from `first_late` on so much later.
std::vector<Circulation> circulations(FfBench& bench, std::size_t count, kernel::Duration later,
                                      std::uint8_t first_late = 0x14) {
  std::vector<Circulation> all;
  const auto answers = [&](const DrivenDlpdu& one) -> std::optional<FfBench::Reply> {
    auto reply = bench.returned(one);
    if (begins_circulation(bench, one)) all.push_back({priority_in(one), one.begin});
    if (reply && is_pt(bench, one) && one.octet(1) >= first_late) reply->later = later;
    return reply;
  };
  const kernel::Time end = bench.now() + bench.octets(static_cast<std::int64_t>(count) * 2 * kFastRotation);
  while (all.size() < count && bench.now() < end)
    bench.serve(std::min(end, bench.now() + bench.octets(20)), answers);
  return all;
}

void expect_priorities(CaseJudge& judge, const std::vector<Circulation>& found,
                       const std::vector<Priority>& wanted, std::string_view reason) {
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    judge.expect(n < found.size() && found[n].priority == wanted[n], reason, [&] {
      return Mismatch{{fmt::format("circulation {} with priority {}", n + 1, priority_text(wanted[n]))},
                      n < found.size() ? std::string(priority_text(found[n].priority)) : "no circulation"};
    });
  }
}

void expect_tokens_in_turn(FfScene& scene) {
  std::uint8_t next = 0x11;
  std::size_t tokens = 0;
  for (const DrivenDlpdu& one : scene.driven) {
    if (!is_pt(scene.bench, one)) continue;
    scene.judge.expect(one.octet(1) == next, "order_wrong", [&] {
      return Mismatch{{fmt::format("PT for node {:02X}", next)}, one.text(), one.begin};
    });
    scene.judge.expect(has_final_use(one) == (next == 0x11), "begin_not_marked", [&] {
      return Mismatch{{"the first token of a circulation marked, and no other"}, one.text(), one.begin};
    });
    next = next == 0x14 ? 0x11 : static_cast<std::uint8_t>(next + 1);
    ++tokens;
  }
  scene.judge.expect(tokens > 20, "no_token", "tokens", fmt::format("{}", tokens));
}

void expect_token_of_12(FfScene& scene) {
  const kernel::Time latest = scene.bench.now() + scene.bench.octets(10 * kFastRotation);
  for (;;) {
    scene.answer = expect_next(scene.bench, scene.judge, latest, "no_token", "a PT for 12");
    if (is_pt(scene.bench, scene.answer) && scene.answer.octet(1) == 0x12) return;
    scene.bench.answer_one(scene.answer);
  }
}

void expect_stopped(FfScene& scene) {
  FfBench& bench = scene.bench;
  const kernel::Time over = scene.answer.end + bench.octets(duration_in(scene.answer));
  const kernel::Time latest = over + bench.slot() + 2 * bench.frame(32);
  std::optional<DrivenDlpdu> next;
  for (kernel::Time end = scene.answer.end; !next && end < latest;) {
    end = bench.send_at(end + 2 * bench.least_gap(), data_from(bench, 0x12, false));
    bench.run_until(end);
    next = bench.next(end + 2 * bench.least_gap() - kLinkRounding);
  }
  scene.judge.expect(next.has_value(), "holder_not_stopped", [&] {
    return Mismatch{{fmt::format("the token of 12 taken back in a silence after {}", kernel::describe(over))},
                    "the station was silent",
                    latest};
  });
  expect_begins(scene.judge, *next, over, "holder_stopped_early", latest, "holder_not_stopped");
}

void expect_wait_for_holder(FfScene& scene) {
  const kernel::Time over = scene.sent + scene.bench.response_delay();
  const DrivenDlpdu next = expect_next(scene.bench, scene.judge, over + 4 * scene.bench.slot(),
                                       "goes_on_late", "the scheduler goes on when the holder says nothing");
  expect_begins(scene.judge, next, over, "takes_return_of_another", over + 2 * scene.bench.slot(),
                "goes_on_late");
}

void expect_steps_back(FfScene& scene) {
  using enum Priority;
  const std::vector<Circulation> slow = circulations(scene.bench, 6, scene.bench.octets(20), 0x11);
  const auto first =
      std::ranges::find_if(slow, [](const Circulation& one) { return one.priority != time_available; });
  scene.judge.expect(slow.end() - first >= 2, "priority_not_raised",
                     "tokens for less than all data, then for urgent data", "tokens for all");
  expect_priorities(scene.judge, {first, slow.end()}, {normal, urgent}, "priority_not_raised");
}

constexpr std::size_t kUntilSettled = 3;

// `latency`: by how much a rotation is shorter than V(TTRT).
void measure_rotation(FfScene& scene) {
  const std::vector<Circulation> fast = circulations(scene.bench, 6, {});
  scene.judge.expect(fast.size() == 6, "no_token", "six circulations", fmt::format("{}", fast.size()));
  const kernel::Duration rotation = fast[5].begin - fast[4].begin;
  scene.latency = scene.bench.rules().target_rotation - rotation;
  if (scene.latency < kernel::Duration{} ||
      scene.bench.least_gap() + scene.latency > scene.bench.response_delay())
    scene.judge.inconclusive(
        "rotation_not_adjustable",
        {{"a rotation that is 0 to 24 octets shorter than V(TTRT)"}, kernel::describe(rotation)});
}

void expect_equal_is_slow(FfScene& scene) {
  const std::vector<Circulation> equal = circulations(scene.bench, 6 + kUntilSettled, scene.latency);
  for (std::size_t n = kUntilSettled; n < equal.size(); ++n) {
    scene.judge.expect(equal[n].priority == Priority::urgent, "equal_rotation_is_fast", [&] {
      return Mismatch{{"a token for urgent data: the rotation before took V(TTRT)"},
                      std::string(priority_text(equal[n].priority)),
                      equal[n].begin};
    });
  }
}

void expect_shorter_is_fast(FfScene& scene) {
  const std::vector<Circulation> faster =
      circulations(scene.bench, 3 + kUntilSettled, scene.latency - scene.bench.octets(1));
  scene.judge.expect(faster.size() == 3 + kUntilSettled && faster.back().priority == Priority::time_available,
                     "priority_not_lowered", "tokens for all data: the rotation is shorter than V(TTRT)",
                     "otherwise");
}

}  // namespace

std::vector<FfCase> ff_circulation_cases() {
  using namespace ff_chart;
  using enum Priority;
  const FfStep token_of_12 =
      expected<FfScene>("a PT for 12; all others are returned at once", expect_token_of_12);
  using link_sources::ff_paper;
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  const PartialSource step{own("one step for each circulation; the first one is urgent"),
                           {"priority_not_lowered", "priority_not_raised"}};
  return {
      on_chart(must_case(
                   "fieldbus_dll/ff_las/circulation/tokens_go_round", "FF-18",
                   "The token is passed to each live node in the order of addresses; the first PT is marked.",
                   ff_paper("token circulation list"),
                   {{"descending_order", "order_wrong"}, {"begin_not_marked", "begin_not_marked"}},
                   {{vendors("the subfield Restart"), {"begin_not_marked"}}}),
               {{},
                {serve({1'500, 20'000}),
                 expected<FfScene>("PTs for 11, 12, 13, 14, again and again, the first one of them marked",
                                   expect_tokens_in_turn)}},
               {.change = four_nodes<1'000>}),
      {{.id = "fieldbus_dll/ff_las/circulation/each_probes",
        .purpose = "FF-23",
        .requirement =
            "Between two circulations an address is probed, in ascending order, without those of V(FUN) "
            "and V(NUN).",
        .reference = vendors("probing, V(FUN), V(NUN)"),
        .stimulus = "Four nodes with much to say.",
        .expected = "A PN between two circulations, for 15 to 24 and DF to F7, from the beginning then.",
        .tags = {"must"},
        .catches = {{"probes_unpolled", "probes_unpolled"},
                    {"no_probe_when_busy", "no_probe"},
                    {"probes_live_nodes", "probes_live_node"},
                    {"probes_descending", "probes_out_of_order"}}},
       each_circulation_probes,
       {.change = four_nodes<1'000>}},
      on_chart(must_case("fieldbus_dll/ff_las/circulation/its_own_data_has_its_turn", "FF-18",
                         "The scheduler itself has a turn in each circulation.",
                         own("the scheduler's own turn"), {{"own_data_kept", "own_data_not_sent"}}),
               {{2, 20},
                {submit({Priority::urgent}, 10), serve({3 * kFastRotation, 3 * kFastRotation}),
                 require(
                     "the data within three rotations",
                     [](FfScene& scene) {
                       return std::ranges::any_of(scene.driven, [&](const DrivenDlpdu& one) {
                         return is_dt1(scene.bench, one) && dlsdu_of(one) == scene.submitted.back();
                       });
                     },
                     "own_data_not_sent")}},
               {.change = four_nodes<1'000>}),
      on_chart(must_in_time("fieldbus_dll/ff_las/circulation/a_fast_rotation_admits_more", "FF-19",
                            "While the rotation is shorter than V(TTRT), data of lower priority is admitted.",
                            ff_paper("ATRT below TTRT"),
                            {{"steers_the_wrong_way", "priority_not_lowered"},
                             {"steps_to_the_extreme", "priority_not_lowered"},
                             {"rotation_counted_twice", "priority_not_lowered"}},
                            {step}),
               {{},
                {FfStep{"the nodes return their tokens at once; V(TTRT) is 1.9 times the shortest rotation",
                        "tokens urgent, normal, time-available, time-available",
                        [](FfScene& scene) {
                          expect_priorities(scene.judge, circulations(scene.bench, 6, {}),
                                            {urgent, normal, time_available, time_available},
                                            "priority_not_lowered");
                        }}}},
               {.change = four_nodes<(19 * kFastRotation) / 10>}),
      on_chart(must_in_time("fieldbus_dll/ff_las/circulation/a_slow_rotation_admits_less", "FF-20",
                            "While the rotation is not shorter than V(TTRT), only urgent data is admitted.",
                            ff_paper("ATRT not below TTRT"),
                            {{"steers_the_wrong_way", "priority_not_raised"},
                             {"target_ignored", "priority_not_raised"}},
                            {step}),
               {{},
                {FfStep{"the nodes return their tokens at once; V(TTRT) is an octet shorter than a rotation",
                        "four tokens for urgent data",
                        [](FfScene& scene) {
                          expect_priorities(scene.judge, circulations(scene.bench, 4, {}),
                                            {urgent, urgent, urgent, urgent}, "priority_not_raised");
                        }}}},
               {.change = four_nodes<kFastRotation - 1>}),
      on_chart(
          must_in_time("fieldbus_dll/ff_las/circulation/slower_rotations_admit_less_step_by_step", "FF-20",
                       "When rotations become slower than V(TTRT), the priority rises one step for each.",
                       ff_paper("ATRT not below TTRT"),
                       {{"steps_back_to_the_extreme", "priority_not_raised"}}, {step}),
          {{},
           {FfStep{"the nodes return their tokens at once, which is faster than V(TTRT)",
                   "tokens urgent, normal, time-available",
                   [](FfScene& scene) {
                     expect_priorities(scene.judge, circulations(scene.bench, 5, {}),
                                       {urgent, normal, time_available}, "priority_not_lowered");
                   }},
            FfStep{"then 20 octet durations later each, which is slower than V(TTRT)",
                   "after tokens for all data one normal, then one urgent", expect_steps_back}}},
          {.change = four_nodes<kFastRotation + 60>}),
      on_chart(
          must_in_time("fieldbus_dll/ff_las/circulation/who_overstays_is_stopped", "FF-18",
                       "A token comes back to the scheduler when its duration is over.",
                       ff_paper("duration of the token"), {{"holder_never_stopped", "holder_not_stopped"}},
                       {{own("the scheduler takes it in a silence of V(MID), a V(ST) after the duration"),
                         {"holder_not_stopped", "holder_stopped_early"}}}),
          {{2, 20},
           {token_of_12, FfStep{"12 sends for ever, with silences of twice V(MID)",
                                "the scheduler sends in a silence within a V(ST) and two frames after "
                                "the duration, not before",
                                expect_stopped}}},
          {.change = four_nodes<1'000>}),
      on_chart(must_in_time("fieldbus_dll/ff_las/circulation/a_return_of_another_is_none", "FF-18",
                            "A token is returned by who holds it.", own("DT1 with F of another"),
                            {{"return_of_anybody_taken", "takes_return_of_another"}}),
               {{2, 20},
                {token_of_12,
                 stimulus<FfScene>("a DT1 with F of 13",
                                   [](FfScene& scene) {
                                     scene.sent =
                                         scene.bench.send_at(scene.answer.end + scene.bench.least_gap(),
                                                             data_from(scene.bench, 0x13, true));
                                     scene.bench.run_until(scene.sent);
                                   }),
                 expected<FfScene>("silence for V(MRD) x V(ST) after it, no more than two slot times more",
                                   expect_wait_for_holder)}},
               {.change = four_nodes<1'000>}),
      on_chart(must_case("fieldbus_dll/ff_las/circulation/probes_begin_with_the_first", "FF-23",
                         "Addresses are probed from the first one to the last one, and anew.", memory("PN"),
                         {{"first_probe_left_out", "probes_out_of_order"}}),
               {{},
                {serve({1'500, 10'000}),
                 expected<FfScene>("PNs for 13, 14, 15, 13 and so on",
                                   [](FfScene& scene) { expect_probes_of(scene, {0x13, 0x14, 0x15}); })}},
               {.change = polled_are<0x13, 0x15>}),
      on_chart(must_case("fieldbus_dll/ff_las/circulation/with_nobody_to_probe_it_idles", "FF-23",
                         "Where all are live an IDLE is sent in the place of a probe.", memory("IDLE"),
                         {{"probes_live_nodes", "no_idle"}}),
               {{},
                {serve({1'500, 10'000}),
                 expected<FfScene>("an IDLE after each circulation of two tokens", expect_idles)}},
               {.change = polled_are<0x10, 0x12>}),
      on_chart(
          must_in_time("fieldbus_dll/ff_las/circulation/an_equal_rotation_is_slow", "FF-21",
                       "A rotation of exactly V(TTRT) admits urgent data only.",
                       ff_paper("ATRT not below TTRT"),
                       {{"equal_rotation_is_fast", "equal_rotation_is_fast"}}, {step}),
          {{},
           {FfStep{"the nodes return their tokens at once",
                   "six circulations, shorter than V(TTRT) by 0 to 24 octet durations", measure_rotation},
            FfStep{"the last node returns its token so late that a rotation takes V(TTRT)",
                   "tokens for urgent data, from the fourth circulation on", expect_equal_is_slow},
            FfStep{"an octet duration sooner", "a token for all data after six circulations",
                   expect_shorter_is_fast}}},
          {.change = four_nodes<kFastRotation + 16>}),
  };
}

}  // namespace fieldproof::conformance
