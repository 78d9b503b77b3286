#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "conformance/fieldbus_dll/ff_scene.hpp"

// Who is the scheduler: CL, TL, and two of them.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr std::uint8_t kMaster = 0x14;
constexpr unsigned kSlot = 5;
constexpr std::uint16_t kVersion = 0x0304;

void standby(FfConfiguration& configuration) {
  configuration.node = kMaster;
  configuration.rules.link.slot_time_octets = kSlot;
  configuration.rules.link.response_delay_slots = 5;
  configuration.begins_as_scheduler = false;
  configuration.live = {0x11};
  configuration.schedule = {
      .version = kVersion, .macrocycle = 3'200, .items = {{1'600, 0x1120, Priority::normal}}};
}

void scheduler(FfConfiguration& configuration) {
  standby(configuration);
  configuration.begins_as_scheduler = true;
}

kernel::Duration claim_silence(const FfBench& bench) {
  return bench.octets(std::int64_t{bench.node()} * bench.link().slot_time_octets);
}

Octets transfer_to(const FfBench& bench, std::uint8_t node) {
  return {bench.rules().codes.tl, node, kVersion >> 8, kVersion & 0xFF};
}

Octets idle_of_another(FfScene& scene) {
  return {scene.bench.rules().codes.idle};
}

void expect_claim(FfScene& scene) {
  FfBench& bench = scene.bench;
  const kernel::Time claim = scene.sent + claim_silence(bench);
  const DrivenDlpdu cl = expect_next(bench, scene.judge, claim + 20 * bench.slot(), "no_claim", "a CL");
  scene.judge.expect(cl.octets == Octets{bench.rules().codes.cl, bench.node()}, "no_claim",
                     [&] { return Mismatch{{"a CL with the node of the station"}, cl.text(), cl.begin}; });
  expect_begins(scene.judge, cl, claim, "claim_early",
                claim + bench.octets(bench.rules().claim_delay_octets + 1), "claim_late");
}

// In ticks, which the station has not counted from its own start.
std::uint32_t link_time(const FfBench& bench) {
  return 7 * bench.configuration().schedule.macrocycle + 1'234;
}

Octets some_link_time(FfScene& scene) {
  const std::uint32_t ticks = link_time(scene.bench);
  return {scene.bench.rules().codes.td,           0, 0, 0, 0, static_cast<std::uint8_t>(ticks >> 8),
          static_cast<std::uint8_t>(ticks & 0xFF)};
}

void expect_macrocycle_goes_on(FfScene& scene) {
  const auto& schedule = scene.bench.configuration().schedule;
  const kernel::Duration macrocycle = schedule.macrocycle * fieldbus_dll::kTick;
  const kernel::Duration into = (link_time(scene.bench) % schedule.macrocycle) * fieldbus_dll::kTick;
  const kernel::Duration at = schedule.items[0].at * fieldbus_dll::kTick;
  std::size_t compelled = 0;
  for (const DrivenDlpdu& one : scene.driven) {
    if (!is_cd(scene.bench, one)) continue;
    const kernel::Duration late =
        (one.begin + kLinkRounding - scene.sent + into + macrocycle - at) % macrocycle;
    scene.judge.expect(
        late <= scene.bench.octets(scene.bench.rules().scheduling_overhead_octets) + 2 * kLinkRounding,
        "macrocycle_lost", [&] {
          return Mismatch{{"the CD at its place in the macrocycle, as link time gives it"},
                          fmt::format("{} after it", kernel::describe(late)),
                          one.begin};
        });
    ++compelled;
  }
  scene.judge.expect(compelled > 2, "link_not_run", "a CD in each macrocycle", fmt::format("{}", compelled));
}

Octets list_of_two(FfScene& scene) {
  std::vector<bool> live(256);
  live[0x12] = live[0x15] = true;
  return scene.bench.dt1(Priority::normal, fieldbus_dll::kEverybody,
                         fieldbus_dll::address_of(FfBench::kScheduler),
                         fieldbus_dll::live_list_spdu(9, live));
}

std::set<unsigned> nodes_with_tokens(const FfScene& scene) {
  std::set<unsigned> passed;
  for (const DrivenDlpdu& one : scene.driven)
    if (is_pt(scene.bench, one)) passed.insert(one.octet(1));
  return passed;
}

void expect_tokens_of_two(FfScene& scene) {
  const std::set<unsigned> passed = nodes_with_tokens(scene);
  scene.judge.expect(passed == std::set<unsigned>{0x12, 0x15}, "live_list_not_kept", [&] {
    return Mismatch{{"PTs for 12 and 15, as the live list has them"},
                    fmt::format("for {:02X}", fmt::join(passed, " "))};
  });
}

void expect_tokens_of_settings(FfScene& scene) {
  const std::set<unsigned> passed = nodes_with_tokens(scene);
  scene.judge.expect(passed == std::set<unsigned>{0x11}, "live_list_outlasts_supply", [&] {
    return Mismatch{{"PTs for 11, as its settings have it"},
                    fmt::format("for {:02X}", fmt::join(passed, " "))};
  });
}

void lose_supply(FfScene& scene) {
  scene.bench.set_supply(false);
  scene.bench.wait(scene.bench.octets(20));
  scene.bench.set_supply(true);
  scene.sent = scene.bench.now();
  while (scene.bench.next(scene.bench.now())) {
  }
}

void expect_silence_before_claim(FfScene& scene) {
  const kernel::Time next = scene.sent + claim_silence(scene.bench) - scene.bench.octets(1);
  scene.judge.expect(!scene.bench.next_begins(next), "claim_early", "silence for V(ST) x V(TN)",
                     "the station spoke");
  scene.sent = scene.bench.send_at(next, idle_of_another(scene));
  scene.bench.run_until(scene.sent);
}

line::Levels some_noise(FfScene& scene) {
  line::Levels noise;
  for (int n = 0; n < 40; ++n) noise.append(scene.bench.random().below(2), 1);
  return noise;
}

void expect_transfer_made(FfScene& scene) {
  scene.bench.order_transfer(0x15);
  const kernel::Time latest = scene.bench.now() + scene.bench.octets(600);
  for (;;) {
    scene.answer = expect_next(scene.bench, scene.judge, latest, "not_transferred", "a TL for 15");
    if (scene.answer.octets == transfer_to(scene.bench, 0x15)) return;
    scene.judge.expect(!is_of(scene.answer, scene.bench.rules().codes.tl), "not_transferred", [&] {
      return Mismatch{
          {"a TL for 15 with the version of its schedule"}, scene.answer.text(), scene.answer.begin};
    });
    scene.bench.answer_one(scene.answer);
  }
}

void expect_taken_back(FfScene& scene) {
  const kernel::Time over = scene.answer.end + scene.bench.response_delay();
  const DrivenDlpdu next = expect_next(scene.bench, scene.judge, over + 40 * scene.bench.slot(),
                                       "not_taken_back", "the scheduler goes on: its heir says nothing");
  expect_begins(scene.judge, next, over, "taken_back_early", over + 2 * scene.bench.slot(), "not_taken_back");
}

// In the middle of a silence of the IUT's own.
void serve_until_probe(FfScene& scene) {
  const kernel::Time latest = scene.bench.now() + scene.bench.octets(2'000);
  for (;;) {
    const auto one = scene.bench.next(latest);
    if (!one) {
      scene.judge.inconclusive(
          "precondition_not_met",
          {{"a scheduler that probes, before another takes over"}, "it has stopped by itself"});
    }
    if (is_of(*one, scene.bench.rules().codes.pn)) break;
    scene.bench.answer_one(*one);
  }
  scene.bench.wait(scene.bench.least_gap());
}

}  // namespace

std::vector<FfCase> ff_claim_cases() {
  using namespace ff_chart;
  const FfStep idle = repeat({}, {wait(30), send("an IDLE of another, then silence", idle_of_another)});
  const FfStep claimed = expected<FfScene>(
      "a CL with the station's node when V(ST) x V(TN) is over, within V(MICD) and an octet", expect_claim);
  const auto silent_yet = [](const std::string& why, const std::string& reason) {
    return require(why, [](FfScene& scene) { return !scene.bench.next(scene.bench.now()); }, reason);
  };
  const FfStep compels = has_driven("the CD of its schedule", is_cd, "schedule_not_run");
  const FfStep transferred{"the user orders a transfer to 15", "a TL for it", expect_transfer_made};
  const FfStep left = repeat(
      {6, 6},
      {require(
           "silence for 60 octet durations: another is the scheduler",
           [](FfScene& scene) { return !scene.bench.next(scene.bench.now() + scene.bench.octets(60)); },
           "two_schedulers"),
       send("an IDLE of it", idle_of_another)});
  const FfStep busy = repeat(
      {}, {serve({700, 700}), stimulus<FfScene>("then until it probes, and V(MID)", serve_until_probe)});
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  return {
      on_chart(must_in_time("fieldbus_dll/ff_las/claim/a_silent_link_is_claimed", "FF-29",
                            "A link master claims the link when nothing was received for V(ST) x V(TN).",
                            vendors("V(ST) x V(TN), V(MICD)"),
                            {{"claims_after_one_slot", "claim_early"},
                             {"never_claims", "no_claim"},
                             {"claims_a_slot_late", "claim_late"}}),
               {{},
                {idle, claimed, serve({800, 800}), has_driven("CDs after the CL", is_cd, "link_not_run"),
                 has_driven("PTs after it", is_pt, "link_not_run")}},
               {.change = standby}),
      on_chart(
          must_in_time("fieldbus_dll/ff_las/claim/the_macrocycle_goes_on", "FF-29",
                       "Who claims the link runs the schedule by the link time that was sent.",
                       memory("link time and macrocycle"), {{"schedule_from_the_claim", "macrocycle_lost"}}),
          {{},
           {wait(30), send("a TD", some_link_time), claimed, serve({1'600, 16'000}),
            expected<FfScene>(
                "each CD at its place in the macrocycle that link time gives, V(MSO) later at most",
                expect_macrocycle_goes_on)}},
          {.change = standby}),
      on_chart(
          must_case("fieldbus_dll/ff_las/claim/who_was_told_to_be_live_gets_the_token", "FF-24",
                    "Who claims the link knows the live nodes from the live list that was sent.",
                    memory("live list of a link master"), {{"told_live_list_ignored", "live_list_not_kept"}},
                    {{own("how a live list is sent"), {"live_list_not_kept"}}}),
          {{},
           {wait(30), send("a live list with 12 and 15", list_of_two), claimed, serve({1'200, 1'200}),
            expected<FfScene>("PTs for 12 and 15, and for no others", expect_tokens_of_two)}},
          {.change = standby}),
      on_chart(must_case("fieldbus_dll/ff_las/claim/what_was_told_is_gone_with_the_supply", "FF-24",
                         "Without supply a link master forgets who is live.", own("what outlasts the supply"),
                         {{"live_list_outlasts_supply", "live_list_outlasts_supply"}}),
               {{2, 10},
                {wait(30), send("a live list with 12 and 15", list_of_two),
                 stimulus<FfScene>("its supply goes and comes", lose_supply), claimed, serve({800, 800}),
                 expected<FfScene>("PTs for 11, and for no others", expect_tokens_of_settings)}},
               {.change = standby}),
      on_chart(
          must_case("fieldbus_dll/ff_las/claim/each_supply_begins_with_the_scheduler", "FF-29",
                    "Who begins as the scheduler is it whenever its supply comes.",
                    own("what outlasts the supply"), {{"begins_once", "not_begun_anew"}}),
          {{2, 10},
           {serve({300, 300}), stimulus<FfScene>("its supply goes and comes", lose_supply), serve({60, 60}),
            has_driven(
                "a DLPDU before it could have claimed the link",
                [](const FfBench&, const DrivenDlpdu&) { return true; }, "not_begun_anew")}},
          {.change = scheduler}),
      on_chart(must_case("fieldbus_dll/ff_las/claim/the_lower_master_is_left_the_link", "FF-30",
                         "Of two link masters the one with the smaller V(ST) x V(TN) has the link.",
                         vendors("V(ST) x V(TN)"),
                         {{"claims_after_one_slot", "claims_all_the_same"},
                          {"frames_do_not_save_the_link", "claims_all_the_same"}}),
               {{2, 10},
                {idle,
                 stimulus<FfScene>("a CL of 13 when its V(ST) x V(TN) is over",
                                   [](FfScene& scene) {
                                     scene.bench.run_until(scene.bench.send_at(
                                         scene.sent + scene.bench.octets(0x13 * std::int64_t{kSlot}),
                                         {scene.bench.rules().codes.cl, 0x13}));
                                   }),
                 repeat({6, 6}, {stimulus<FfScene>("it probes 60 octet durations later",
                                                   [](FfScene& scene) {
                                                     scene.bench.run_until(scene.bench.send_at(
                                                         scene.bench.now() + scene.bench.octets(60),
                                                         {scene.bench.rules().codes.pn, 0x15}));
                                                   }),
                                 silent_yet("silence: 13 has claimed the link", "claims_all_the_same")})}},
               {.change = standby}),
      on_chart(must_in_time("fieldbus_dll/ff_las/claim/what_is_heard_in_time_saves_the_link", "FF-31",
                            "Before V(ST) x V(TN) is over no link is claimed.", vendors("V(ST) x V(TN)"),
                            {{"claims_a_slot_early", "claim_early"}}),
               {{},
                {idle,
                 repeat({4, 40}, {FfStep{"an IDLE an octet before V(ST) x V(TN) is over",
                                         "silence until then", expect_silence_before_claim}}),
                 claimed}},
               {.change = standby}),
      on_chart(must_in_time("fieldbus_dll/ff_las/claim/noise_is_activity", "FF-32",
                            "Activity that is no frame keeps a link master from claiming, too.",
                            own("noise is activity"), {{"noise_does_not_save_the_link", "claim_in_noise"}}),
               {{},
                {idle,
                 repeat({4, 40}, {stimulus<FfScene>("90 % of V(ST) x V(TN) pass",
                                                    [](FfScene& scene) {
                                                      scene.bench.run_until(
                                                          scene.sent + claim_silence(scene.bench) * 9 / 10);
                                                    }),
                                  drive("noise of 20 bits", some_noise),
                                  silent_yet("silence: the line is active", "claim_in_noise")}),
                 claimed}},
               {.change = standby}),
      on_chart(must_in_time(
                   "fieldbus_dll/ff_las/transfer/is_taken", "FF-33",
                   "A TL makes a link master the scheduler within V(MRD) x V(ST).", memory("TL"),
                   {{"transfer_ignored", "transfer_not_taken"}, {"schedule_not_begun", "schedule_not_run"}},
                   {{own("version of the schedule in a TL"), {"schedule_not_run"}}}),
               {{},
                {wait(30),
                 send("a TL with the version of its schedule",
                      [](FfScene& scene) { return transfer_to(scene.bench, scene.bench.node()); }),
                 answer<FfScene>("a DLPDU of the new scheduler", "transfer_not_taken", nullptr),
                 serve({900, 900}), compels}},
               {.change = standby}),
      on_chart(
          must_case("fieldbus_dll/ff_las/transfer/a_wrong_one_is_none", "FF-33",
                    "A TL with a wrong check, for another, or for another schedule is none.", memory("TL"),
                    {{"transfer_not_checked", "acts_on_wrong_check"},
                     {"takes_transfer_of_others", "takes_transfer_of_others"},
                     {"schedule_version_ignored", "takes_other_schedule"}},
                    {{own("version of the schedule in a TL"), {"takes_other_schedule"}}}),
          {{},
           {wait(30),
            drive("a TL whose last bit is wrong",
                  [](FfScene& scene) {
                    return half_bits_of_frame(with_wrong_bits(
                        with_frame_check(transfer_to(scene.bench, scene.bench.node())), {47}));
                  }),
            silence("acts_on_wrong_check", "the check of the TL is wrong"),
            send("a TL for 15", [](FfScene& scene) { return transfer_to(scene.bench, 0x15); }),
            silence("takes_transfer_of_others", "the TL is for 15"),
            send("a TL for another version of the schedule",
                 [](FfScene& scene) {
                   return with_wrong_bits(transfer_to(scene.bench, scene.bench.node()), {31});
                 }),
            silence("takes_other_schedule", "the TL is for another version")}},
          {.change = standby}),
      on_chart(must_case(
                   "fieldbus_dll/ff_las/transfer/is_made_when_ordered", "FF-33",
                   "A scheduler that is ordered to hands the link over by TL, and leaves when another sends.",
                   memory("TL"),
                   {{"order_ignored", "not_transferred"}, {"stays_behind_transfer", "two_schedulers"}},
                   {{own("version of the schedule in a TL"), {"not_transferred"}}}),
               {{},
                {serve({300, 300}), transferred, wait(8),
                 send("a PN of 15 for 16",
                      [](FfScene& scene) { return Octets{scene.bench.rules().codes.pn, 0x16}; }),
                 left}},
               {.change = scheduler}),
      on_chart(
          must_in_time("fieldbus_dll/ff_las/transfer/what_is_not_taken_is_taken_back", "FF-33",
                       "A scheduler whose heir says nothing goes on after V(MRD) x V(ST).", memory("TL"),
                       {{"never_retakes", "not_taken_back"}},
                       {{own("V(MRD) x V(ST) supervises a TL"), {"taken_back_early", "not_taken_back"}}}),
          {{},
           {serve({300, 300}), transferred,
            expected<FfScene>("15 is silent: a DLPDU within two slot times after V(MRD) x V(ST), not before",
                              expect_taken_back),
            serve({900, 900}), compels}},
          {.change = scheduler}),
      on_chart(
          must_case("fieldbus_dll/ff_las/claim/a_link_master_in_standby_is_a_device", "FF-03",
                    "A link master that is not the scheduler answers probes and uses tokens as a device.",
                    memory("link masters that are not the scheduler"), {{"deaf_in_standby", "not_a_device"}}),
          {{},
           {wait(30), pn(), probe_response("not_a_device", "not_a_device"), wait(8), activation(), wait(20),
            repeat({2, 20}, {submit({Priority::urgent}, 6), pt(Priority::normal, 280),
                             used({0}, {"not_a_device", "sent_twice"})})}},
          {.change = standby}),
      on_chart(
          must_case("fieldbus_dll/ff_las/claim/a_second_scheduler_is_left_the_link", "FF-34",
                    "A scheduler that receives the CL of another leaves.", memory("two schedulers"),
                    {{"stays_behind_claim", "two_schedulers"}, {"never_leaves", "two_schedulers"}}),
          {{},
           {busy,
            send("a CL of 13", [](FfScene& scene) { return Octets{scene.bench.rules().codes.cl, 0x13}; }),
            left}},
          {.change = scheduler}),
      on_chart(must_case("fieldbus_dll/ff_las/claim/a_second_token_is_left_the_link", "FF-34",
                         "A scheduler that receives the PT of another leaves.", memory("two schedulers"),
                         {{"never_leaves", "two_schedulers"}}),
               {{},
                {busy,
                 send("a PT of another for 15",
                      [](FfScene& scene) {
                        Octets pt = scene.bench.pt(Priority::normal, 280);
                        pt[1] = 0x15;
                        return pt;
                      }),
                 left}},
               {.change = scheduler}),
  };
}

}  // namespace fieldproof::conformance
