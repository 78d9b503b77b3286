#include <fmt/format.h>

#include "conformance/fieldbus_dll/isa_scene.hpp"

// A link whose numbers are not the usual ones: each changes what is sent, received or refused.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

constexpr std::uint8_t kOtherEverybody = 0xFE;
constexpr std::uint8_t kFirst = 0x10;
constexpr std::uint8_t kLast = 0x30;

template <unsigned octets>
void with_preamble(IsaConfiguration& configuration) {
  configuration.rules.link.preamble_octets = octets;
}
void with_other_everybody(IsaConfiguration& configuration) {
  configuration.rules.everybody = kOtherEverybody;
}
void with_few_addresses(IsaConfiguration& configuration) {
  configuration.rules.first_address = kFirst;
  configuration.rules.last_address = kLast;
}
void with_impossible_silence(IsaConfiguration& configuration) {
  const fieldbus_dll::LinkRules& link = configuration.rules.link;
  const unsigned silence = (link.response_delay_slots - 1) * link.slot_time_octets + 1;
  configuration.rules.link.inter_pdu_delay_octets = silence;
  // Who started all the same would have time to reply.
  configuration.rules.reply_forming_octets = 2 * silence;
  configuration.rules.reply_wait_octets = 3 * silence;
}

IsaStep du_to(std::uint8_t destination) {
  return isa_chart::send(fmt::format("a DU of 22 to {:02X}", destination), [destination](IsaScene& scene) {
    Octets octets{scene.bench.control(scene.bench.rules().codes.du, Priority::normal), destination,
                  IsaBench::kPeer};
    for (const std::uint8_t octet : scene.fresh(6)) octets.push_back(octet);
    return octets;
  });
}

IsaStep cd_of(std::uint8_t source) {
  return isa_chart::send(fmt::format("a CD of {:02X}", source), [source](IsaScene& scene) {
    return Octets{scene.bench.control(scene.bench.rules().codes.cd, Priority::normal), scene.bench.address(),
                  source};
  });
}

IsaStep empty_reply_to(std::uint8_t node) {
  return isa_chart::answer<IsaScene>(
      fmt::format("a DT to {:02X}", node), "no_reply", [node](const IsaScene& scene, const DrivenDlpdu& one) {
        return is_type(one, scene.bench.rules().codes.dt) && one.octet(1) == node;
      });
}

IsaStep not_delivered() {
  return isa_chart::require(
      "it is not delivered", [](IsaScene& scene) { return scene.bench.user().deliveries.empty(); },
      "invalid_data_delivered");
}

// A DU to it.
IsaStep submitted_to(std::uint8_t node, bool is_address) {
  const std::string what = fmt::format("a DU to {:02X}", node);
  return {"the user submits " + what, is_address ? "it is accepted" : "it is refused",
          [what, node, is_address](IsaScene& scene) {
            const Octets data = scene.bench.numbered_data(6);
            const bool is_taken = scene.bench.submit(IsaService::unit_data, Priority::normal, data, node);
            if (is_address) {
              scene.judge.expect(is_taken, "data_refused", what + " is accepted", "it was refused");
              scene.submitted.push_back(data);
            } else {
              scene.judge.expect(!is_taken, "unknown_address_taken", what + " is refused", "it was taken");
            }
          }};
}

template <unsigned octets>
IsaCase sent_with_preamble() {
  using namespace isa_chart;
  return on_chart(
      must_case(fmt::format("fieldbus_dll/isa_dle/settings/preambles_of_{}_are_sent", octets), "ISA-39",
                "A station sends as many octets of preamble as its link has.",
                link_sources::line("preamble and delimiters"),
                {{"preamble_of_the_usual_link", "frame_length_wrong"}}),
      {{},
       {cd(Priority::normal), says("a DT", "no_reply"), submit({Priority::normal, Priority::urgent}, 10),
        es(Priority::normal, 1'000), used({2, 1}, {"no_data_frame", "sent_twice"}), preambles(octets)}},
      {.change = with_preamble<octets>});
}

}  // namespace

std::vector<IsaCase> isa_link_settings_cases() {
  using namespace isa_chart;
  using enum Priority;
  using link_sources::own;
  using link_sources::vendors;
  return {
      sent_with_preamble<4>(),
      sent_with_preamble<8>(),
      on_chart(must_case("fieldbus_dll/isa_dle/settings/everybody_is_that_of_the_link", "ISA-28",
                         "The destination of a DU to everybody is that of the link.",
                         own("the address of everybody is a setting"),
                         {{"everybody_of_the_usual_link", "broadcast_not_delivered"}}),
               {{},
                {du_to(kOtherEverybody), wait(20), delivered("it", "broadcast_not_delivered"), du_to(0xFF),
                 wait(20), not_delivered(), submitted_to(kOtherEverybody, true), submitted_to(0xFF, false),
                 es(normal, 500), used({1}, {"no_data_frame", "sent_twice"})}},
               {.change = with_other_everybody}),
      on_chart(must_case("fieldbus_dll/isa_dle/settings/addresses_are_those_of_the_link", "ISA-18",
                         "Addresses are those from the first to the last of the link.",
                         own("first and last address are settings"),
                         {{"first_address_of_the_usual_link", "acts_on_unknown"},
                          {"last_address_of_the_usual_link", "acts_on_unknown"},
                          {"first_address_is_none", "no_reply"},
                          {"last_address_is_none", "no_reply"}}),
               {{},
                {cd_of(0x05),
                 silence("acts_on_unknown", "05 is no address of this link"),
                 cd_of(kFirst - 1),
                 silence("acts_on_unknown", "0F is no address of this link"),
                 cd_of(kFirst),
                 empty_reply_to(kFirst),
                 wait(32),
                 cd_of(kLast),
                 empty_reply_to(kLast),
                 wait(32),
                 cd_of(kLast + 1),
                 silence("acts_on_unknown", "31 is no address of this link"),
                 cd_of(0xF0),
                 silence("acts_on_unknown", "F0 is no address of this link"),
                 submitted_to(kFirst - 1, false),
                 submitted_to(kFirst, true),
                 submitted_to(kLast, true),
                 submitted_to(kLast + 1, false),
                 es(normal, 500),
                 used({1, 2}, {"no_data_frame", "sent_twice"})}},
               {.change = with_few_addresses}),
      asked_with(
          {}, on_chart(
                  must_case("fieldbus_dll/isa_dle/settings/impossible_ones_are_refused", "ISA-41",
                            "V(MID) is at most (V(MRD) - 1) x V(ST).", vendors("range of V(MID)"),
                            {{"impossible_rules_taken", "impossible_rules_taken"},
                             {"impossible_once_only", "impossible_rules_taken"}}),
                  {{},
                   {require(
                        "a station with V(MID) an octet above (V(MRD) - 1) x V(ST) does not start",
                        [](IsaScene& scene) { return !scene.bench.has_started(); }, "impossible_rules_taken"),
                    cd(normal), silence("impossible_rules_taken", "the station has not started"),
                    stimulus<IsaScene>("its supply goes and comes",
                                       [](IsaScene& scene) {
                                         scene.bench.set_supply(false);
                                         scene.bench.wait(scene.bench.octets(100));
                                         scene.bench.set_supply(true);
                                       }),
                    require(
                        "it does not start then", [](IsaScene& scene) { return !scene.bench.has_started(); },
                        "impossible_rules_taken"),
                    cd(normal), silence("impossible_rules_taken", "the station has not started")}},
                  {.change = with_impossible_silence})),
  };
}

}  // namespace fieldproof::conformance
