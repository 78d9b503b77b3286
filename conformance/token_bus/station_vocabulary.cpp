#include "conformance/token_bus/station_vocabulary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace fieldproof::conformance::token_chart {
namespace {

void expect_answer_to(TokenScene& scene) {
  scene.send(scene.bench.frame(TokenControl::solicit_1, TokenBench::kBelow, TokenBench::kAbove));
  scene.expect_frame({TokenControl::set_successor, TokenBench::kAbove}, scene.at_once(), "set_successor",
                     "answer_missing", "answer_wrong");
}

void expect_request_to_be_answered(TokenScene& scene) {
  scene.join(false);
  scene.bench.submit({.action = token_bus::Action::request_with_response,
                      .destination = TokenBench::kBelow,
                      .data = scene.bench.numbered_data(4)});
  scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
  scene.expect_frame({TokenControl{0x72}, TokenBench::kBelow}, scene.at_once(), "the request",
                     "request_missing", "request_wrong");
}

void bring_to_state(TokenScene& scene) {
  switch (scene.turn % kListeningStates) {
    case 0:
      scene.expect_frame({TokenControl::claim}, scene.after_slots(scene.bench.rules().bus_idle_slots),
                         "the first claim", "claim_missing", "claim_wrong");
      break;
    case 1:
      return scene.join(false);
    case 2:
      expect_answer_to(scene);
      break;
    case 3:
      expect_request_to_be_answered(scene);
      break;
    case 4:
      scene.join(false);
      scene.rotate_until_window();
      break;
    case 5:
      scene.join(false);
      scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
      scene.expect_frame({TokenControl::token, TokenBench::kBelow}, scene.at_once(), "the token",
                         "token_missing", "token_wrong");
      break;
    default:
      break;
  }
  scene.bench.wait(scene.bench.octets(8));
}

}  // namespace

TokenStep starts_anew() {
  return stimulus<TokenScene>("the supply of the station fails, and returns 10 octet durations later",
                              [](TokenScene& scene) {
                                scene.bench.set_power(false);
                                scene.bench.wait(scene.bench.octets(10));
                                scene.bench.set_power(true);
                                scene.bench.user().events.clear();
                                scene.bench.user().frames.clear();
                                scene.submitted.clear();
                                scene.since = scene.bench.now();
                              });
}

std::vector<std::uint64_t> addresses_beside(const TokenBench& bench) {
  std::vector<std::uint64_t> all;
  for (const unsigned bit : {6U, 8U, 15U, 16U, 23U, 24U, 31U, 32U, 39U, 40U, 47U}) {
    if (bit < 8 * token_bus::address_octets(bench.rules()))
      all.push_back(bench.address() ^ std::uint64_t{1} << bit);
  }
  return all;
}

std::vector<std::uint64_t> groups_beside(const TokenBench& bench) {
  const std::uint64_t everybody = (std::uint64_t{1} << 8 * token_bus::address_octets(bench.rules())) - 1;
  return {bench.address() | 1U, 1, everybody};
}

TokenStep brought_to_each_state() {
  return stimulus<TokenScene>(
      "the station claims the token; in the next turns it is a member, has answered a solicitation, waits "
      "for "
      "a response, has opened a window, has passed the token, is outside of the ring",
      bring_to_state);
}

TokenStep forget_events() {
  return stimulus<TokenScene>("events are counted from here",
                              [](TokenScene& scene) { scene.bench.user().events.clear(); });
}

TokenStep reported_again(const std::string& text, token_bus::EventKind kind, std::uint64_t about) {
  return require(
      fmt::format("{} is reported to its user, about {:04X}, each time", text, about),
      [kind, about](TokenScene& scene) {
        const bool has_one = scene.bench.user().has_event(kind, about);
        scene.bench.user().events.clear();
        return has_one;
      },
      "not_reported");
}

TokenStep not_reported(const std::string& text, token_bus::EventKind kind) {
  return require(
      fmt::format("{} is not reported", text),
      [kind](TokenScene& scene) {
        return std::ranges::none_of(scene.bench.user().events,
                                    [&](const token_bus::Event& one) { return one.kind == kind; });
      },
      "reported_unfounded");
}

TokenStep keeps_no_token() {
  return silence(5 * 28, "token_kept", "another holds the token");
}

TokenStep stranger_talks() {
  return send("0020 sends data to 0004", [](TokenScene& scene) {
    return scene.bench.data_frame(0x62, TokenBench::kBelow, TokenBench::kStranger, {1, 2});
  });
}

TokenStep desired(bool is_desired) {
  return stimulus<TokenScene>(
      is_desired ? "its user wants it in the ring" : "its user does not want it in the ring",
      [is_desired](TokenScene& scene) { scene.bench.set_in_ring_desired(is_desired); });
}

TokenStep solicited() {
  return send("000E solicits a successor between it and 0004", [](TokenScene& scene) {
    return scene.bench.frame(TokenControl::solicit_1, TokenBench::kBelow, TokenBench::kAbove);
  });
}

TokenStep answers(std::uint64_t whom, SpanOf span) {
  return says(fmt::format("set_successor to {:04X} with its own address", whom),
              {TokenControl::set_successor, whom, kOwnAddress}, std::move(span), "answer_missing",
              "answer_wrong");
}

}  // namespace fieldproof::conformance::token_chart
