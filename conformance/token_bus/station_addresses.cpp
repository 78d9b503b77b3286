#include <fmt/format.h>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// An address is compared whole, wherever it stands: each kind of frame with each address that differs in one
// bit, of 16 and of 48 bits.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::own;
using token_sources::standard;

constexpr std::uint64_t kFarAbove = 0x0212'3456'78F0;
constexpr std::uint64_t kFarBelow = 0x0000'0000'0004;
constexpr std::uint64_t kFarNext = 0x0413'5577'9900;

struct Width {
  std::string name;
  unsigned addresses;  // beside its own, and groups
  TokenNeeds needs;
};

std::vector<Width> widths() {
  return {{"of_16_bits", 3, {}}, {"of_48_bits", 11, with([](token_bus::Rules& rules) {
                                    rules.address_length = token_bus::AddressLength::bits_48;
                                  })}};
}

std::uint64_t other_of_turn(const TokenScene& scene) {
  const auto beside = addresses_beside(scene.bench);
  return scene.turn < beside.size() ? beside[scene.turn]
                                    : groups_beside(scene.bench).at(scene.turn - beside.size());
}

TokenStep of_each(const std::string& text, std::uint8_t control, Octets data) {
  return send(text + " beside its own, in its turn", [control, data = std::move(data)](TokenScene& scene) {
    scene.bench.wait(scene.bench.octets(8));
    return scene.bench.data_frame(control, other_of_turn(scene), TokenBench::kAbove, data);
  });
}

TokenStep from_each() {
  return send("each address beside its own sends data to the station, in its turn", [](TokenScene& scene) {
    scene.bench.wait(scene.bench.octets(8));
    return scene.bench.data_frame(0x62, scene.bench.address(), other_of_turn(scene),
                                  scene.bench.numbered_data(4));
  });
}

TokenStep names_to_each() {
  return send("0004 names 0002 as the successor of each address beside its own", [](TokenScene& scene) {
    scene.bench.wait(scene.bench.octets(8));
    return scene.bench.frame(TokenControl::set_successor, other_of_turn(scene), TokenBench::kBelow, 0x0002);
  });
}

std::vector<TokenCase> cases_of_width(const Width& width) {
  const unsigned all = width.addresses + 3;
  const unsigned individual = width.addresses;
  const auto case_of = [&](const std::string& id, const std::string& requirement,
                           std::vector<MustCatch> catches, std::vector<TokenStep> steps) {
    return on_chart(token_must("addresses/" + id + "_" + width.name, "", requirement, standard("addresses"),
                               std::move(catches)),
                    {{}, std::move(steps)}, width.needs);
  };
  return {
      case_of("tokens_for_others", "A token for any other address, or for a group, is not taken.",
              {{width.addresses > 3 ? "token_by_16_bits" : "token_by_its_low_octet", "acts_for_another"},
               {"token_of_a_group_taken", "acts_for_another"}},
              {joined(),
               repeat({all, all}, {of_each("a token for an address", 0x10, {}),
                                   silence(2 * 28, "acts_for_another", "it is another's token")}),
               serves()}),
      case_of(
          "data_for_others",
          "Data for any other address, of whatever kind, are neither delivered nor answered.",
          {{width.addresses > 3 ? "data_by_32_bits" : "data_by_their_low_octet", "delivered_unasked"}},
          {joined(),
           stimulus<TokenScene>("its user has a response ready",
                                [](TokenScene& scene) { scene.bench.set_response({1}); }),
           repeat(
               {individual, individual},
               {of_each("data for an address", 0x62, {1, 2}), delivered("nothing is delivered", 0),
                of_each("a request with response for an address", 0x72, {1, 2}),
                delivered("nothing is delivered", 0), silence(2 * 28, "responds_unasked", "another is asked"),
                of_each("a response for an address", 0x6A, {1, 2}), delivered("nothing is delivered", 0)}),
           wait(8), serves()}),
      case_of("data_from_others",
              "A frame from any other address is no sign of a second one with its own: it is received.",
              {{width.addresses > 3 ? "source_by_16_bits" : "source_by_its_low_octet", "not_delivered"}},
              {joined(), repeat({individual, individual}, {from_each(), delivered("they are delivered", 1)}),
               wait(8), serves()}),
      case_of("successors_of_others", "set_successor for any other address, or a group, is not for it.",
              {{width.addresses > 3 ? "successor_by_16_bits" : "successor_by_its_low_octet", "token_wrong"}},
              {joined(), repeat({all, all}, {names_to_each()}), wait(8), token(), passes_on()}),
  };
}

TokenStep long_event_causes() {
  return stimulus<TokenScene>(
      "0212345678F0 solicits the station and passes it the token; then it names 041355779900 as its "
      "successor",
      [](TokenScene& scene) {
        scene.bench.wait(scene.bench.octets(8));
        scene.send(scene.bench.frame(TokenControl::solicit_1, kFarBelow, kFarAbove));
        scene.expect_frame({TokenControl::set_successor, kFarAbove}, scene.at_once(), "set_successor",
                           "answer_missing", "answer_wrong");
        scene.bench.wait(scene.bench.octets(8));
        scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), kFarAbove));
        scene.expect_frame({TokenControl::token, kFarBelow}, scene.at_once(), "the token", "token_missing",
                           "token_wrong");
        scene.bench.wait(scene.bench.octets(8));
        scene.send(
            scene.bench.frame(TokenControl::set_successor, scene.bench.address(), kFarAbove, kFarNext));
      });
}

}  // namespace

std::vector<TokenCase> token_address_cases() {
  std::vector<TokenCase> all;
  for (const Width& width : widths()) {
    const auto some = cases_of_width(width);
    all.insert(all.end(), some.begin(), some.end());
  }
  all.push_back(on_chart(token_must("addresses/events_name_all_of_an_address", "",
                                    "An event names the station that it is about by all of its address.",
                                    own("events"), {{"events_of_16_bits", "not_reported"}}),
                         {{},
                          {long_event_causes(), reported("it", token_bus::EventKind::joined, kFarAbove),
                           reported("its new successor", token_bus::EventKind::successor_changed, kFarNext)}},
                         widths()[1].needs));
  return all;
}

}  // namespace fieldproof::conformance
