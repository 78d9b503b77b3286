#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"
#include "conformance/token_bus/station_visits.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"
#include "harness/line/frame_check.hpp"

// Each octet of an address, each priority of a request, each place where there may be noise, each counter.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_bus::Action;
using token_sources::controller;
using token_sources::memory;
using token_sources::own;
using token_sources::standard;

// ---- addresses of 48 bits, no octet of which is 0 ----

constexpr std::uint64_t kLongBefore = 0x7C8D'9EAF'B1C2;
constexpr std::uint64_t kLongAfter = 0x0A1B'2C3D'4E50;
constexpr std::array<std::uint64_t, 3> kLongGroups{0x0000'0000'0003, 0x0100'0000'0001, 0xFFFF'FFFF'FFFF};

TokenNeeds long_own_address() {
  return {.adjust = [](token_bus::StationConfiguration& configuration, kernel::Random&) {
    configuration.rules.address_length = token_bus::AddressLength::bits_48;
    configuration.address = 0x1BE4'2D72'C6B8;
  }};
}

TokenStep joins_long_addresses() {
  return stimulus<TokenScene>(
      "the station joins between two stations whose addresses have six octets",
      [](TokenScene& scene) { scene.join_between(TokenControl::solicit_1, kLongBefore, kLongAfter); });
}

TokenStep long_is_sought() {
  return expected<TokenScene>(
      "the token again, then who_follows twice, of all 48 bits", [](TokenScene& scene) {
        scene.expect_frame({TokenControl::token, kLongAfter}, scene.after_slots(1), "the token again",
                           "token_missing", "token_wrong");
        for (const unsigned slots : {1U, 3U})
          scene.expect_frame({TokenControl::who_follows, kLongAfter, kLongAfter}, scene.after_slots(slots),
                             "who_follows", "who_follows_missing", "who_follows_wrong");
      });
}

TokenStep long_data() {
  return stimulus<TokenScene>("the user submits data for an address of six octets", [](TokenScene& scene) {
    scene.judge.expect(scene.bench.submit({.destination = kLongAfter, .data = {1}}), "data_refused",
                       "the data is accepted", "it was refused");
  });
}

TokenStep long_groups_refused() {
  return require(
      "requests with response to groups are refused",
      [](TokenScene& scene) {
        for (const std::uint64_t group : kLongGroups)
          if (scene.bench.submit(
                  {.action = Action::request_with_response, .destination = group, .data = {1}}))
            return false;
        return true;
      },
      "data_not_refused");
}

std::vector<TokenCase> each_octet_of_long_addresses() {
  return {
      on_chart(token_must("long_addresses/the_successor_is_sought_by_all_octets", "TB-21",
                          "Who follows is asked by all six octets of the successor.", standard("who_follows"),
                          {{"asks_by_32_bits", "who_follows_wrong"}}),
               {{}, {joins_long_addresses(), long_is_sought()}}, long_own_address()),
      on_chart(
          token_must("long_addresses/data_go_to_all_octets", "TB-07",
                     "Data go to all six octets of their destination; requests with response to groups are "
                     "refused.",
                     standard("addresses"),
                     {{"data_to_40_bits", "data_wrong"}, {"long_groups_are_asked", "data_not_refused"}}),
          {{},
           {joins_long_addresses(), wait(8), long_groups_refused(), long_data(), token(),
            says("the data", {TokenControl{0x62}, kLongAfter}, at_once(), "data_missing", "data_wrong"),
            says("the token to its successor", {TokenControl::token, kLongAfter}, at_once(), "token_missing",
                 "token_wrong")}},
          long_own_address()),
  };
}

// ---- requests of each priority ----

std::uint8_t control_of(Action action, unsigned priority) {
  return static_cast<std::uint8_t>(2U | line::reflect(static_cast<unsigned>(action), 3) << 2U |
                                   line::reflect(priority, 3) << 5U);
}

TokenStep request_of_each_priority() {
  return stimulus<TokenScene>(
      "the user submits a request with response of priority 0, 1 and so on in turn", [](TokenScene& scene) {
        scene.judge.expect(scene.bench.submit({.action = Action::request_with_response,
                                               .priority = scene.turn,
                                               .destination = TokenBench::kBelow,
                                               .data = {1}}),
                           "data_refused", "the request is accepted", "it was refused");
      });
}

TokenStep is_asked_and_responds() {
  return {"000E passes the token to the station, and 0004 responds", "the request, of its priority",
          [](TokenScene& scene) {
            scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
            scene.expect_frame(
                {TokenControl{control_of(Action::request_with_response, scene.turn)}, TokenBench::kBelow},
                scene.at_once(), fmt::format("a request of priority {}", scene.turn), "request_missing",
                "request_wrong");
            scene.bench.wait(scene.bench.octets(8));
            scene.send(scene.bench.data_frame(control_of(Action::response, scene.turn), scene.bench.address(),
                                              TokenBench::kBelow, {2}));
          }};
}

// ---- noise ----

TokenStep resolves_contention() {
  return says("resolve_contention", {TokenControl::resolve}, at_once(), "contention_not_resolved",
              "contention_not_resolved");
}

TokenStep contests(unsigned count) {
  return repeat({count, count}, {noise(17), resolves_contention(), wait(6)});
}

TokenStep stranger_talks_meanwhile() {
  return send("0020 sends data to 0004", [](TokenScene& scene) {
    return scene.bench.data_frame(0x62, TokenBench::kBelow, TokenBench::kStranger, {1, 2});
  });
}

// Each of the three times that it asks for a successor.
std::vector<TokenStep> contested_when_it_asks(unsigned time) {
  std::vector<TokenStep> all{joined(), token(), passes_below(at_once()), passes_below(after_slots(1)),
                             asks_who_follows(after_slots(1))};
  if (time > 0) all.push_back(asks_who_follows(after_slots(3)));
  if (time > 1)
    all.push_back(says("anybody is solicited", {TokenControl::solicit_2, kOwnAddress}, after_slots(3),
                       "any_missing", "any_wrong"));
  return and_then(
      std::move(all), {wait(6), contests(2)},
      {send("0002 answers alone",
            [](TokenScene& scene) {
              return scene.bench.frame(TokenControl::set_successor, kOwnAddress, 0x0002, 0x0002);
            }),
       says("the token to 0002", {TokenControl::token, 0x0002}, at_once(), "token_missing", "token_wrong"),
       starts_anew()});
}

TokenStep taken_with_noise() {
  return {"000E solicits the station and passes the token to it; there is noise twice after the token",
          "the token is not repeated", [](TokenScene& scene) {
            scene.join_between(TokenControl::solicit_1, TokenBench::kAbove, TokenBench::kBelow);
            for (const std::int64_t pause : {8, 40}) {
              scene.bench.wait(scene.bench.octets(pause));
              scene.since = scene.bench.send_noise(6);
            }
            scene.expect_silence(scene.bench.slots(5), "token_repeated", "its successor was active twice");
          }};
}

TokenStep fails_twice() {
  return {"twice, 000E solicits the station and passes the token to it", "it joins, and finds no successor",
          [](TokenScene& scene) {
            scene.fail_to_pass();
            scene.fail_to_pass();
          }};
}

std::vector<TokenCase> noises() {
  return {
      on_chart(
          token_must("passing/contention_when_it_asks_is_resolved", "TB-14",
                     "Noise where a station waits for an answer makes it resolve contention, also when "
                     "it seeks a new successor.",
                     standard("resolve_contention"),
                     {{"no_contest_when_it_asks", "contention_not_resolved"}}),
          {{}, and_then(contested_when_it_asks(0), contested_when_it_asks(1), contested_when_it_asks(2))}),
      on_chart(token_must("passing/each_window_has_all_contests", "TB-15",
                          "A window has nine contests, though one before was given up in the midst of its.",
                          memory("max_pass_count"), {{"contests_go_on", "contention_not_resolved"}}),
               {{},
                {joined(), until_window(), wait(6), contests(5), stranger_talks_meanwhile(),
                 silence(2 * 28, "token_kept", "another holds the token"), until_window(), wait(6),
                 contests(9), noise(17), passes_below(at_once())}}),
      on_chart(token_must("failure/noise_that_is_a_success_forgives_too", "",
                          "A pass that noise shows to have succeeded begins the count of failures anew.",
                          memory("transmitter_fault_count"), {{"noise_forgives_nothing", "answer_missing"}}),
               {{},
                {fails_twice(), taken_with_noise(), fails_twice(),
                 not_reported("a fault", token_bus::EventKind::faulty_transmitter), joined()}},
               with([](token_bus::Rules& rules) { rules.transmitter_fault_limit = 3; })),
  };
}

// ---- windows and their answers ----

TokenStep group_answers_alone() {
  return {"in the window, 0006 answers for the group 0003",
          "the token to 0004, or silence: a group is no successor", [](TokenScene& scene) {
            scene.send(scene.bench.frame(TokenControl::set_successor, kOwnAddress, 0x0006, 0x0003));
            const auto one = scene.bench.next(scene.bench.now() + scene.bench.slots(2));
            if (!one) return;
            scene.judge.expect(one->is(TokenControl::token) && one->destination() == TokenBench::kBelow,
                               "token_wrong", "the token to 0004, or silence", one->text());
            scene.since = one->end;
            scene.take_token();
          }};
}

TokenStep each_too_long() {
  return repeat({2, 2}, {wait(10), send("000E sends data of 8183 octets", [](TokenScene& scene) {
                           return scene.bench.data_frame(0x62, kOwnAddress, TokenBench::kAbove,
                                                         Octets(8'183));
                         })});
}

}  // namespace

std::vector<TokenCase> token_each_cases() {
  std::vector<TokenCase> all{
      on_chart(token_must("requests/each_priority_is_asked_for", "TB-27",
                          "A request with response goes with the priority that it was submitted with.",
                          own("requests"), {{"even_priority_asks", "request_wrong"}}),
               {{},
                {joined(), repeat({8, 8}, {request_of_each_priority(), is_asked_and_responds(),
                                           passes_below(at_once()), taken()})}}),
      on_chart(token_must("passing/a_group_is_no_answer", "TB-26",
                          "set_successor that names a group leaves a station its successor, in a window too.",
                          own("joining"), {{"group_answers", "token_wrong"}}),
               {{},
                {joined(), until_window(), wait(6), group_answers_alone(), wait(10), token(),
                 passes_below(at_once()), taken()}}),
      on_chart(
          token_must(
              "settings/rotation_times_beyond_20_bits", "TB-08",
              "Target rotation times of 1048576 octet durations leave time for each class, and for "
              "windows.",
              controller("token_rotation_timer"),
              {{"targets_in_20_bits", "class_not_served"}, {"maintenance_in_20_bits", "window_missing"}}),
          {{},
           {joined(), submit({4, 2, 0}, 10), token(),
            sends("classes 4, 2 and 0", {4, 2, 0}, "speaks_unasked", "class_not_served"), taken(),
            until_window()}},
          with([](token_bus::Rules& rules) {
            rules.target_rotation_octets.fill(1U << 20U);
            rules.ring_maintenance_octets = 1U << 20U;
          })),
      on_chart(token_must("supply/long_frames_are_counted_anew", "",
                          "The counter of frames too long is 0 after a loss of supply.",
                          own("loss of supply"), {{"long_frames_kept", "counter_wrong"}}),
               {{},
                {joined(), each_too_long(), counted("frames too long", kTooLong, 2), starts_anew(),
                 each_too_long(), counted("frames too long", kTooLong, 2), joined()}}),
  };
  for (const auto& more : {each_octet_of_long_addresses(), noises()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace fieldproof::conformance
