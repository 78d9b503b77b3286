#include "conformance/fieldbus_dll/ff_scene.hpp"

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

}  // namespace

std::vector<FfCase> ff_probe_cases() {
  using namespace ff_chart;
  using enum Priority;
  const auto probed = [](const std::string& where) {
    return Chart<FfScene>{{2, 20},
                          {wait(50), pn(where), probe_response("no_probe_response"),
                           silence("talks_behind_answer", "one PR is sent")}};
  };
  const FfStep long_pt = pt(time_available, 500);
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  return {
      on_chart(must_in_time("fieldbus_dll/ff_device/probe/is_answered", "FF-01",
                            "A station that is not in the live list answers a PN within V(MRD) x V(ST).",
                            memory("PN and PR"),
                            {{"mute_after_activation", "no_probe_response"},
                             {"no_probe_response", "no_probe_response"},
                             {"answers_late", "answers_too_late"}}),
               probed(""), {.is_live = false}),
      on_chart(must_in_time("fieldbus_dll/ff_device/probe/is_answered_after_a_longer_silence", "FF-01",
                            "V(MID) is that of the link.", vendors("V(MID), V(MRD), V(ST)"),
                            {{"mute_after_activation", "no_probe_response"},
                             {"silence_of_the_usual_link", "answers_too_early"}}),
               probed(" on a link with V(MID) 20, V(MRD) 3 and V(ST) 10"),
               {.change = times_of_link<20, 3, 10>, .is_live = false}),
      on_chart(must_in_time("fieldbus_dll/ff_device/probe/is_answered_within_a_shorter_time", "FF-01",
                            "V(MRD) and V(ST) are those of the link.", vendors("V(MID), V(MRD), V(ST)"),
                            {{"mute_after_activation", "no_probe_response"},
                             {"answers_in_the_usual_time", "answers_too_late"}}),
               probed(" on a link with V(MID) 5, V(MRD) 4 and V(ST) 5"),
               {.change = times_of_link<5, 4, 5>, .is_live = false}),
      on_chart(must_case("fieldbus_dll/ff_device/probe/others_are_left", "FF-02",
                         "A station answers no PN for another.", memory("PN and PR"),
                         {{"mute_after_activation", "does_not_recover"},
                          {"answers_for_all_nodes", "answers_others"}}),
               {{},
                {repeat({36, 255}, {send("a PN for another node, each in its turn",
                                         [](FfScene& scene) {
                                           return Octets{scene.bench.rules().codes.pn, scene.other_node()};
                                         }),
                                    silence("answers_others", "the PN is for another node")}),
                 serves()}}),
      on_chart(
          must_case("fieldbus_dll/ff_device/probe/nothing_is_sent_before_activation", "FF-01",
                    "A station uses no token before it is activated.", own("activation of a node"),
                    {{"mute_after_activation", "token_not_returned"},
                     {"live_from_the_start", "uses_token_offline"},
                     {"activated_by_anything", "uses_token_offline"},
                     {"activated_by_broadcast", "uses_token_offline"},
                     {"activated_by_its_users_data", "uses_token_offline"},
                     {"answers_cd_offline", "answers_offline"}}),
          {{},
           {submit({urgent}, 6), wait(50), long_pt,
            silence("uses_token_offline", "the station is not in the live list"), cd(),
            silence("answers_offline", "it is not in the live list"), pn(),
            probe_response("no_probe_response"),
            repeat({5, 5},
                   {send("an activation of another, then of everybody, live lists for all and for the "
                         "station, data for its user",
                         [](FfScene& scene) { return what_activates_nothing(scene.bench).at(scene.turn); }),
                    wait(20), long_pt,
                    silence("uses_token_offline", "what was sent is no activation of the station")}),
            activation(), silence("talks_behind_answer", "an activation is not answered"), long_pt,
            used({1}, {"not_activated", "sent_twice"})}},
          {.is_live = false}),
      asked_with(
          {.is_live = false},
          on_chart(must_case("fieldbus_dll/ff_device/probe/impossible_rules_are_refused", "FF-36",
                             "V(MID) is at most (V(MRD) - 1) x V(ST).", vendors("range of V(MID)"),
                             {{"impossible_rules_taken", "impossible_rules_taken"},
                              {"refuses_once", "impossible_rules_taken"}}),
                   {{},
                    {require(
                         "a station with V(MID) an octet above (V(MRD) - 1) x V(ST) does not start",
                         [](FfScene& scene) { return !scene.bench.has_started(); }, "impossible_rules_taken"),
                     wait(50), pn(), silence("impossible_rules_taken", "the station has not started"),
                     stimulus<FfScene>("its supply goes and comes",
                                       [](FfScene& scene) {
                                         scene.bench.set_supply(false);
                                         scene.bench.set_supply(true);
                                       }),
                     require(
                         "it does not start now either",
                         [](FfScene& scene) { return !scene.bench.has_started(); }, "impossible_rules_taken"),
                     wait(50), pn(), silence("impossible_rules_taken", "the station has not started")}},
                   {.change =
                        [](fieldbus_dll::FfConfiguration& configuration) {
                          configuration.rules.link.inter_pdu_delay_octets = 25;
                        },
                    .is_live = false})),
  };
}

}  // namespace fieldproof::conformance
