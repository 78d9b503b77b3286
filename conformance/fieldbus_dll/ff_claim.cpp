#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"

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

// Somebody is on the line until some instant; gives it.
kernel::Time speak(FfBench& bench) {
  return bench.send({bench.rules().codes.idle});
}

DrivenDlpdu expect_claim(FfBench& bench, CaseJudge& judge, kernel::Time silent_since) {
  const kernel::Time claim = silent_since + claim_silence(bench);
  const kernel::Duration delay = bench.octets(bench.rules().claim_delay_octets + 1);
  const DrivenDlpdu cl = expect_next(bench, judge, claim + 20 * bench.slot(), "no_claim", "a CL");
  judge.expect(cl.octets == Octets{bench.rules().codes.cl, bench.node()}, "no_claim",
               [&] { return Mismatch{{"a CL with the node of the station"}, cl.text(), cl.begin}; });
  expect_begins(judge, cl, claim, "claim_early", claim + delay, "claim_late");
  return cl;
}

void a_silent_link_is_claimed(FfBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(30));
  const kernel::Time end = speak(bench);
  expect_claim(bench, judge, end);
  bool has_compelled = false;
  bool has_passed = false;
  for (const DrivenDlpdu& one : bench.serve(bench.now() + bench.octets(800))) {
    has_compelled |= is_cd(bench, one);
    has_passed |= is_pt(bench, one);
  }
  judge.expect(has_compelled && has_passed, "link_not_run", "CDs and PTs after the CL", "none");
}

void the_macrocycle_goes_on(FfBench& bench, CaseJudge& judge) {
  const auto& schedule = bench.configuration().schedule;
  const kernel::Duration macrocycle = schedule.macrocycle * fieldbus_dll::kTick;
  // Link time, which the station has not counted from its own start.
  const std::uint32_t told = 7 * schedule.macrocycle + 1'234;
  bench.wait(bench.octets(30));
  const kernel::Time end =
      bench.send({bench.rules().codes.td, 0, 0, 0, 0, static_cast<std::uint8_t>(told >> 8),
                  static_cast<std::uint8_t>(told & 0xFF)});
  const kernel::Duration into = (told % schedule.macrocycle) * fieldbus_dll::kTick;
  const kernel::Duration at = schedule.items[0].at * fieldbus_dll::kTick;
  expect_claim(bench, judge, end);
  std::size_t compelled = 0;
  for (const DrivenDlpdu& one : bench.serve(bench.now() + bench.volume(4, 40) * macrocycle)) {
    if (!is_cd(bench, one)) continue;
    const kernel::Duration late = (one.begin + kLinkRounding - end + into + macrocycle - at) % macrocycle;
    judge.expect(late <= bench.octets(bench.rules().scheduling_overhead_octets) + 2 * kLinkRounding,
                 "macrocycle_lost", [&] {
                   return Mismatch{{"the CD at its place in the macrocycle, as link time says"},
                                   fmt::format("{} after it", kernel::describe(late)),
                                   one.begin};
                 });
    ++compelled;
  }
  judge.expect(compelled > 2, "link_not_run", "a CD in each macrocycle", fmt::format("{}", compelled));
}

void who_was_told_to_be_live_gets_the_token(FfBench& bench, CaseJudge& judge) {
  std::vector<bool> live(256);
  live[0x12] = live[0x15] = true;
  bench.wait(bench.octets(30));
  const kernel::Time end = bench.send(bench.dt1(Priority::normal, fieldbus_dll::kEverybody,
                                                fieldbus_dll::address_of(FfBench::kScheduler),
                                                fieldbus_dll::live_list_spdu(9, live)));
  expect_claim(bench, judge, end);
  std::set<unsigned> passed;
  for (const DrivenDlpdu& one : bench.serve(bench.now() + bench.octets(1'200))) {
    if (is_pt(bench, one)) passed.insert(one.octet(1));
  }
  judge.expect(passed == std::set<unsigned>{0x12, 0x15}, "live_list_not_kept", [&] {
    return Mismatch{{"PTs for 12 and 15, as the live list says"},
                    fmt::format("for {:02X}", fmt::join(passed, " "))};
  });
}

void the_lower_master_is_left_the_link(FfBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 10); ++n) {
    bench.wait(bench.octets(20));
    const kernel::Time end = speak(bench);
    const kernel::Time other = end + bench.octets(0x13 * std::int64_t{kSlot});
    bench.run_until(bench.send_at(other, {bench.rules().codes.cl, 0x13}));
    // The other one is the scheduler now, and probes.
    for (int i = 0; i < 6; ++i) {
      bench.run_until(bench.send_at(bench.now() + bench.octets(60), {bench.rules().codes.pn, 0x15}));
      judge.expect(!bench.next(bench.now()), "claims_all_the_same", "silence: 13 has claimed the link",
                   "the station spoke");
    }
  }
}

void what_is_heard_in_time_saves_the_link(FfBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(20));
  kernel::Time end = speak(bench);
  for (int n = 0; n < bench.volume(4, 40); ++n) {
    const kernel::Time next = end + claim_silence(bench) - bench.octets(1);
    const bool speaks = bench.next_begins(next);
    judge.expect(!speaks, "claim_early", "silence for V(ST) x V(TN)", "the station spoke");
    end = bench.send_at(next, {bench.rules().codes.idle});
    bench.run_until(end);
  }
  expect_claim(bench, judge, end);
}

void noise_is_activity(FfBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(20));
  kernel::Time end = speak(bench);
  for (int n = 0; n < bench.volume(4, 40); ++n) {
    bench.run_until(end + claim_silence(bench) * 9 / 10);
    line::Levels noise;
    for (int i = 0; i < 40; ++i) noise.append(bench.random().below(2), 1);
    end = bench.send_half_bits(noise);
    judge.expect(!bench.next(bench.now()), "claim_in_noise", "silence: the line is active",
                 "the station spoke");
  }
  expect_claim(bench, judge, end);
}

Octets transfer_to(const FfBench& bench, std::uint8_t node) {
  return {bench.rules().codes.tl, node, kVersion >> 8, kVersion & 0xFF};
}

void a_transfer_is_taken(FfBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(30));
  const kernel::Time end = bench.send(transfer_to(bench, bench.node()));
  const DrivenDlpdu first = expect_next(bench, judge, "transfer_not_taken", "a DLPDU of the new scheduler");
  expect_begins(judge, first, end + bench.least_gap(), "answers_too_early", end + bench.response_delay(),
                "answers_too_late");
  bool has_compelled = false;
  for (const DrivenDlpdu& one : bench.serve(bench.now() + bench.octets(900)))
    has_compelled |= is_cd(bench, one);
  judge.expect(has_compelled, "schedule_not_run", "the CD of its schedule", "none");
}

void a_wrong_transfer_is_none(FfBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(30));
  Octets wrong = with_frame_check(transfer_to(bench, bench.node()));
  wrong.back() ^= 1;
  bench.send_half_bits(half_bits_of_frame(wrong));
  judge.expect(!bench.next(), "acts_on_wrong_check", "silence: the check of the TL is wrong",
               "the station spoke");
  bench.send(transfer_to(bench, 0x15));
  judge.expect(!bench.next(), "takes_transfer_of_others", "silence: the TL is for 15", "the station spoke");
  Octets older = transfer_to(bench, bench.node());
  older.back() ^= 1;
  bench.send(older);
  judge.expect(!bench.next(), "takes_other_schedule",
               "silence: the TL is for another version of the schedule", "the station spoke");
}

// Whoever else is the scheduler speaks now and then.
void expect_silent_in_standby(FfBench& bench, CaseJudge& judge) {
  for (int i = 0; i < 6; ++i) {
    const auto one = bench.next(bench.now() + bench.octets(60));
    judge.expect(!one.has_value(), "two_schedulers",
                 [&] { return Mismatch{{"silence: another is the scheduler"}, one->text(), one->begin}; });
    speak(bench);
  }
}

// The TL for 15 that the user orders.
DrivenDlpdu expect_transfer_made(FfBench& bench, CaseJudge& judge) {
  const auto answers = [&](const DrivenDlpdu& one) { return bench.returned(one); };
  bench.serve(bench.now() + bench.octets(300), answers);
  bench.order_transfer(0x15);
  const kernel::Time latest = bench.now() + bench.octets(600);
  for (;;) {
    const DrivenDlpdu one = expect_next(bench, judge, latest, "not_transferred", "a TL for 15");
    if (one.octets == transfer_to(bench, 0x15)) return one;
    if (const auto reply = answers(one))
      bench.run_until(bench.send_at(one.end + bench.least_gap(), reply->octets));
  }
}

void a_transfer_that_is_not_taken_is_taken_back(FfBench& bench, CaseJudge& judge) {
  const DrivenDlpdu tl = expect_transfer_made(bench, judge);
  const kernel::Time over = tl.end + bench.response_delay();
  const DrivenDlpdu next = expect_next(bench, judge, over + 40 * bench.slot(), "not_taken_back",
                                       "the scheduler goes on: its heir says nothing");
  expect_begins(judge, next, over, "taken_back_early", over + 2 * bench.slot(), "not_taken_back");
  bool has_compelled = is_cd(bench, next);
  for (const DrivenDlpdu& one : bench.serve(bench.now() + bench.octets(900)))
    has_compelled |= is_cd(bench, one);
  judge.expect(has_compelled, "schedule_not_run", "the CD of its schedule", "none");
}

void a_transfer_is_made_when_it_is_ordered(FfBench& bench, CaseJudge& judge) {
  expect_transfer_made(bench, judge);
  bench.wait(bench.least_gap());
  bench.send({bench.rules().codes.pn, 0x16});
  expect_silent_in_standby(bench, judge);
}

void a_link_master_in_standby_is_a_device(FfBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(30));
  bench.send({bench.rules().codes.pn, bench.node()});
  const DrivenDlpdu pr = expect_next(bench, judge, "not_a_device", "a PR");
  judge.expect(pr.octets == Octets{bench.rules().codes.pr, bench.node()}, "not_a_device",
               [&] { return Mismatch{{"a PR"}, pr.text(), pr.begin}; });
  bench.wait(bench.least_gap());
  bench.send(bench.activation(bench.node()));
  bench.wait(bench.octets(20));
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const Octets data = expect_submitted(bench, judge, Priority::urgent, 6);
    const kernel::Time end = bench.send(bench.pt(Priority::normal, 280));
    expect_dlsdus(judge, expect_token_used(bench, judge, end), {data}, "not_a_device", "sent_twice");
  }
}

template <typename Say>
void expect_leaves(FfBench& bench, CaseJudge& judge, Say say) {
  bench.serve(bench.now() + bench.octets(700));
  // In the middle of a silence of the IUT's own.
  const kernel::Time latest = bench.now() + bench.octets(2'000);
  while (const auto one = bench.next(latest)) {
    if (is_of(*one, bench.rules().codes.pn)) break;
    bench.answer_one(*one);
  }
  bench.wait(bench.least_gap());
  say();
  expect_silent_in_standby(bench, judge);
}

void a_second_scheduler_is_left_the_link(FfBench& bench, CaseJudge& judge) {
  expect_leaves(bench, judge, [&] { bench.send({bench.rules().codes.cl, 0x13}); });
}

void a_second_token_is_left_the_link(FfBench& bench, CaseJudge& judge) {
  expect_leaves(bench, judge, [&] {
    Octets pt = bench.pt(Priority::normal, 280);
    pt[1] = 0x15;
    bench.send(pt);
  });
}

}  // namespace

std::vector<FfCase> ff_claim_cases() {
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  return {
      {{.id = "fieldbus_dll/ff_las/claim/a_silent_link_is_claimed",
        .purpose = "FF-29",
        .requirement = "A link master claims the link when nothing was received for V(ST) x V(TN).",
        .reference = vendors("V(ST) x V(TN), V(MICD)"),
        .stimulus = "Silence.",
        .expected = "A CL within V(MICD) and an octet; then CDs and tokens.",
        .tags = {"must", "timing"},
        .catches = {{"claims_after_one_slot", "claim_early"},
                    {"never_claims", "no_claim"},
                    {"claims_a_slot_late", "claim_late"}}},
       a_silent_link_is_claimed,
       {.change = standby}},
      {{.id = "fieldbus_dll/ff_las/claim/the_macrocycle_goes_on",
        .purpose = "FF-29",
        .requirement = "Who claims the link runs the schedule by the link time that was sent.",
        .reference = memory("link time and macrocycle"),
        .stimulus = "A TD, then silence.",
        .expected = "A CL; each CD at its place in the macrocycle, at most V(MSO) later.",
        .tags = {"must", "timing"},
        .catches = {{"schedule_from_the_claim", "macrocycle_lost"}}},
       the_macrocycle_goes_on,
       {.change = standby}},
      {{.id = "fieldbus_dll/ff_las/claim/who_was_told_to_be_live_gets_the_token",
        .purpose = "FF-24",
        .requirement = "Who claims the link knows the live nodes from the live list that was sent.",
        .reference = memory("live list of a link master"),
        .details = {{own("how a live list is sent"), {"live_list_not_kept"}}},
        .stimulus = "A live list with 12 and 15, then silence.",
        .expected = "A CL; PTs for 12 and 15.",
        .tags = {"must"},
        .catches = {{"told_live_list_ignored", "live_list_not_kept"}}},
       who_was_told_to_be_live_gets_the_token,
       {.change = standby}},
      {{.id = "fieldbus_dll/ff_las/claim/the_lower_master_is_left_the_link",
        .purpose = "FF-30",
        .requirement = "Of two link masters the one with the smaller V(ST) x V(TN) has the link.",
        .reference = vendors("V(ST) x V(TN)"),
        .stimulus = "13 claims the link a slot time earlier.",
        .expected = "Silence.",
        .tags = {"must"},
        .catches = {{"claims_after_one_slot", "claims_all_the_same"},
                    {"frames_do_not_save_the_link", "claims_all_the_same"}}},
       the_lower_master_is_left_the_link,
       {.change = standby}},
      {{.id = "fieldbus_dll/ff_las/claim/what_is_heard_in_time_saves_the_link",
        .purpose = "FF-31",
        .requirement = "Before V(ST) x V(TN) is over no link is claimed.",
        .reference = vendors("V(ST) x V(TN)"),
        .stimulus = "Silences of an octet less.",
        .expected = "No CL; one when the silence lasts.",
        .tags = {"must", "timing"},
        .catches = {{"claims_a_slot_early", "claim_early"}}},
       what_is_heard_in_time_saves_the_link,
       {.change = standby}},
      {{.id = "fieldbus_dll/ff_las/claim/noise_is_activity",
        .purpose = "FF-32",
        .requirement = "Activity that is no frame keeps a link master from claiming, too.",
        .reference = own("noise is activity"),
        .stimulus = "Noise after 90 % of V(ST) x V(TN).",
        .expected = "No CL; one when the silence lasts.",
        .tags = {"must", "timing"},
        .catches = {{"noise_does_not_save_the_link", "claim_in_noise"}}},
       noise_is_activity,
       {.change = standby}},
      {{.id = "fieldbus_dll/ff_las/transfer/is_taken",
        .purpose = "FF-33",
        .requirement = "A TL makes a link master the scheduler within V(MRD) x V(ST).",
        .reference = memory("TL"),
        .details = {{own("version of the schedule in a TL"), {"schedule_not_run"}}},
        .stimulus = "A TL with the version of its schedule.",
        .expected = "A DLPDU in time, then the schedule.",
        .tags = {"must", "timing"},
        .catches = {{"transfer_ignored", "transfer_not_taken"}, {"schedule_not_begun", "schedule_not_run"}}},
       a_transfer_is_taken,
       {.change = standby}},
      {{.id = "fieldbus_dll/ff_las/transfer/a_wrong_one_is_none",
        .purpose = "FF-33",
        .requirement = "A TL with a wrong check, for another, or for another schedule is none.",
        .reference = memory("TL"),
        .details = {{own("version of the schedule in a TL"), {"takes_other_schedule"}}},
        .stimulus = "A TL whose last bit is wrong, a TL for 15, one with another version.",
        .expected = "Silence.",
        .tags = {"must"},
        .catches = {{"transfer_not_checked", "acts_on_wrong_check"},
                    {"takes_transfer_of_others", "takes_transfer_of_others"},
                    {"schedule_version_ignored", "takes_other_schedule"}}},
       a_wrong_transfer_is_none,
       {.change = standby}},
      {{.id = "fieldbus_dll/ff_las/transfer/is_made_when_ordered",
        .purpose = "FF-33",
        .requirement =
            "A scheduler that is ordered to hands the link over by TL, and leaves when another sends.",
        .reference = memory("TL"),
        .details = {{own("version of the schedule in a TL"), {"not_transferred"}}},
        .stimulus = "The user orders a transfer to 15; then another probes.",
        .expected = "A TL for 15; silence.",
        .tags = {"must"},
        .catches = {{"order_ignored", "not_transferred"}, {"stays_behind_transfer", "two_schedulers"}}},
       a_transfer_is_made_when_it_is_ordered,
       {.change = scheduler}},
      {{.id = "fieldbus_dll/ff_las/transfer/what_is_not_taken_is_taken_back",
        .purpose = "FF-33",
        .requirement = "A scheduler whose heir says nothing goes on after V(MRD) x V(ST).",
        .reference = memory("TL"),
        .details = {{own("V(MRD) x V(ST) supervises a TL"), {"taken_back_early", "not_taken_back"}}},
        .stimulus = "The user orders a transfer to 15, which is silent.",
        .expected =
            "A TL for 15; the schedule goes on within two slot times after V(MRD) x V(ST), not before.",
        .tags = {"must", "timing"},
        .catches = {{"never_retakes", "not_taken_back"}}},
       a_transfer_that_is_not_taken_is_taken_back,
       {.change = scheduler}},
      {{.id = "fieldbus_dll/ff_las/claim/a_link_master_in_standby_is_a_device",
        .purpose = "FF-03",
        .requirement = "A link master that is not the scheduler answers probes and uses tokens as a device.",
        .reference = memory("link masters that are not the scheduler"),
        .stimulus = "PN, activation, and PTs with data waiting.",
        .expected = "A PR, the data.",
        .tags = {"must"},
        .catches = {{"deaf_in_standby", "not_a_device"}}},
       a_link_master_in_standby_is_a_device,
       {.change = standby}},
      {{.id = "fieldbus_dll/ff_las/claim/a_second_scheduler_is_left_the_link",
        .purpose = "FF-34",
        .requirement = "A scheduler that receives the CL of another leaves.",
        .reference = memory("two schedulers"),
        .stimulus = "A CL of 13.",
        .expected = "Silence.",
        .tags = {"must"},
        .catches = {{"stays_behind_claim", "two_schedulers"}, {"never_leaves", "two_schedulers"}}},
       a_second_scheduler_is_left_the_link,
       {.change = scheduler}},
      {{.id = "fieldbus_dll/ff_las/claim/a_second_token_is_left_the_link",
        .purpose = "FF-34",
        .requirement = "A scheduler that receives the PT of another leaves.",
        .reference = memory("two schedulers"),
        .stimulus = "A PT of another for 15.",
        .expected = "Silence.",
        .tags = {"must"},
        .catches = {{"never_leaves", "two_schedulers"}}},
       a_second_token_is_left_the_link,
       {.change = scheduler}},
  };
}

}  // namespace fieldproof::conformance
