#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"

// PN: who is there; and rules that cannot be.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

template <unsigned silence, unsigned response_slots, unsigned slot>
void times_of_link(fieldbus_dll::FfConfiguration& configuration) {
  configuration.rules.link.inter_pdu_delay_octets = silence;
  configuration.rules.link.response_delay_slots = response_slots;
  configuration.rules.link.slot_time_octets = slot;
}

void a_probe_is_answered(FfBench& bench, CaseJudge& judge) {
  bench.wait(bench.octets(50));
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const kernel::Time end = bench.send({bench.rules().codes.pn, bench.node()});
    const DrivenDlpdu pr = expect_next(bench, judge, "no_probe_response", "a PR");
    const Octets wanted{bench.rules().codes.pr, bench.node()};
    judge.expect(pr.octets == wanted, "dlpdu_wrong",
                 [&] { return Mismatch{{"PR with the station's node"}, pr.text(), pr.begin}; });
    expect_begins(judge, pr, end + bench.least_gap(), "answers_too_early", end + bench.response_delay(),
                  "answers_too_late");
    expect_silence(bench, judge, "talks_behind_answer", "one PR is sent");
  }
}

void probes_of_others_are_left(FfBench& bench, CaseJudge& judge) {
  for (unsigned node = 0; node < 256; node += static_cast<unsigned>(bench.volume(7, 1))) {
    if (node == bench.node()) continue;
    bench.send({bench.rules().codes.pn, static_cast<std::uint8_t>(node)});
    expect_silence(bench, judge, "answers_others", fmt::format("the PN is for node {:02X}", node));
  }
  expect_serves(bench, judge);
}

// An activation of another and of everybody, a live list, data for the user.
std::vector<Octets> what_activates_nothing(FfBench& bench) {
  using fieldbus_dll::address_of;
  const fieldbus_dll::FfAddress scheduler = address_of(FfBench::kScheduler);
  const auto kind = static_cast<std::uint8_t>(fieldbus_dll::SpduKind::activation);
  const Octets list = fieldbus_dll::live_list_spdu(1, std::vector<bool>(256, true));
  return {bench.activation(0x22), bench.dt1(Priority::normal, fieldbus_dll::kEverybody, scheduler, {kind}),
          bench.dt1(Priority::normal, fieldbus_dll::kEverybody, scheduler, list),
          bench.dt1(Priority::normal, address_of(bench.node()), scheduler, list),
          bench.dt1(Priority::normal, address_of(bench.node(), 0x30), FfBench::kPeersAddress, {kind})};
}

void nothing_is_sent_before_activation(FfBench& bench, CaseJudge& judge) {
  const Octets data = expect_submitted(bench, judge, Priority::urgent, 6);
  bench.wait(bench.octets(50));
  bench.send(bench.pt(Priority::time_available, 500));
  expect_silence(bench, judge, "uses_token_offline", "the station is not in the live list");
  bench.send(bench.cd(FfBench::kPublished));
  expect_silence(bench, judge, "answers_offline", "the station is not in the live list");
  bench.send({bench.rules().codes.pn, bench.node()});
  bench.listen();
  for (const Octets& other : what_activates_nothing(bench)) {
    bench.send(other);
    bench.wait(bench.octets(20));
    bench.send(bench.pt(Priority::time_available, 500));
    expect_silence(bench, judge, "uses_token_offline", "what was sent is no activation of the station");
  }
  bench.send(bench.activation(bench.node()));
  expect_silence(bench, judge, "talks_behind_answer", "an activation is not answered");
  const kernel::Time end = bench.send(bench.pt(Priority::time_available, 500));
  expect_dlsdus(judge, expect_token_used(bench, judge, end), {data}, "not_activated", "sent_twice");
}

void impossible_rules_are_refused(FfBench& bench, CaseJudge& judge) {
  judge.expect(!bench.has_started(), "impossible_rules_taken", "V(MID) above (V(MRD) - 1) x V(ST) is refused",
               "the station has started");
  bench.wait(bench.octets(50));
  bench.send({bench.rules().codes.pn, bench.node()});
  expect_silence(bench, judge, "impossible_rules_taken", "the station has not started");
}

}  // namespace

std::vector<FfCase> ff_probe_cases() {
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  return {
      {{.id = "fieldbus_dll/ff_device/probe/is_answered",
        .purpose = "FF-01",
        .requirement = "A station that is not in the live list answers a PN within V(MRD) x V(ST).",
        .reference = memory("PN and PR"),
        .stimulus = "PNs for the station.",
        .expected = "One PR each, begun between V(MID) and V(MRD) x V(ST).",
        .tags = {"must", "timing"},
        .catches = {{"mute_after_activation", "no_probe_response"},
                    {"no_probe_response", "no_probe_response"},
                    {"answers_late", "answers_too_late"}}},
       a_probe_is_answered,
       {.is_live = false}},
      {{.id = "fieldbus_dll/ff_device/probe/is_answered_after_a_longer_silence",
        .purpose = "FF-01",
        .requirement = "V(MID) is that of the link.",
        .reference = vendors("V(MID), V(MRD), V(ST)"),
        .stimulus = "PNs on a link with V(MID) 20, V(MRD) 3 and V(ST) 10.",
        .expected = "One PR each, begun between 20 and 30 octet durations after the PN.",
        .tags = {"must", "timing"},
        .catches = {{"mute_after_activation", "no_probe_response"},
                    {"silence_of_the_usual_link", "answers_too_early"}}},
       a_probe_is_answered,
       {.change = times_of_link<20, 3, 10>, .is_live = false}},
      {{.id = "fieldbus_dll/ff_device/probe/is_answered_within_a_shorter_time",
        .purpose = "FF-01",
        .requirement = "V(MRD) and V(ST) are those of the link.",
        .reference = vendors("V(MID), V(MRD), V(ST)"),
        .stimulus = "PNs on a link with V(MID) 5, V(MRD) 4 and V(ST) 5.",
        .expected = "One PR each, begun between 5 and 20 octet durations after the PN.",
        .tags = {"must", "timing"},
        .catches = {{"mute_after_activation", "no_probe_response"},
                    {"answers_in_the_usual_time", "answers_too_late"}}},
       a_probe_is_answered,
       {.change = times_of_link<5, 4, 5>, .is_live = false}},
      {{.id = "fieldbus_dll/ff_device/probe/others_are_left",
        .purpose = "FF-02",
        .requirement = "A station answers no PN for another.",
        .reference = memory("PN and PR"),
        .stimulus = "PNs for other nodes.",
        .expected = "Silence.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "does_not_recover"},
                    {"answers_for_all_nodes", "answers_others"}}},
       probes_of_others_are_left},
      {{.id = "fieldbus_dll/ff_device/probe/nothing_is_sent_before_activation",
        .purpose = "FF-01",
        .requirement = "A station uses no token before it is activated.",
        .reference = own("activation of a node"),
        .stimulus = "A PT and a CD to a station that was not activated; a PN; what activates others, live "
                    "lists, data, "
                    "each with a PT; an activation, a PT.",
        .expected = "Silence; a PR; silence; the data.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"live_from_the_start", "uses_token_offline"},
                    {"activated_by_anything", "uses_token_offline"},
                    {"activated_by_broadcast", "uses_token_offline"},
                    {"activated_by_its_users_data", "uses_token_offline"},
                    {"answers_cd_offline", "answers_offline"}}},
       nothing_is_sent_before_activation,
       {.is_live = false}},
      {{.id = "fieldbus_dll/ff_device/probe/impossible_rules_are_refused",
        .purpose = "FF-36",
        .requirement = "V(MID) is at most (V(MRD) - 1) x V(ST).",
        .reference = vendors("range of V(MID)"),
        .stimulus = "A station with V(MID) an octet above.",
        .expected = "It does not start and says nothing.",
        .tags = {"must"},
        .catches = {{"impossible_rules_taken", "impossible_rules_taken"}}},
       impossible_rules_are_refused,
       {.change =
            [](fieldbus_dll::FfConfiguration& configuration) {
              configuration.rules.link.inter_pdu_delay_octets = 25;
            },
        .is_live = false}},
  };
}

}  // namespace fieldproof::conformance
