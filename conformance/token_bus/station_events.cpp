#include <fmt/format.h>

#include <algorithm>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"

// What is reported to the user of a station has led up to it on the line, in every case; and a quiet life
// reports nothing.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::own;

std::string text_of_event(const token_bus::Event& event) {
  return fmt::format("{} about {:04X}", token_bus::text_of(event.kind), event.address);
}

// Whether something that leads to such an event was on the line before it.
bool has_cause(const TokenBench& bench, const TokenUser::Reported& reported) {
  const std::uint64_t about = reported.event.address;
  const auto sent = [&](auto is_cause) {
    return std::ranges::any_of(bench.sent(), [&](const DrivenFrame& one) {
      return one.end <= reported.when + kTokenRounding && is_cause(one);
    });
  };
  const auto driven = [&](auto is_cause) {
    return std::ranges::any_of(
        bench.driven(), [&](const DrivenFrame& one) { return one.begin <= reported.when && is_cause(one); });
  };
  switch (reported.event.kind) {
    case token_bus::EventKind::joined:
      return sent([&](const DrivenFrame& one) {
        return one.is(TokenControl::token) && one.destination() == bench.address() && one.source() == about;
      });
    case token_bus::EventKind::left:
      return bench.may_leave();
    case token_bus::EventKind::sole_station:
      return driven([](const DrivenFrame& one) {
        return one.is(TokenControl::claim) || one.is(TokenControl::who_follows);
      });
    case token_bus::EventKind::successor_changed:
      return sent([&](const DrivenFrame& one) {
        return one.is(TokenControl::set_successor) && one.address_in_data() == about;
      });
    case token_bus::EventKind::pass_failed:
    case token_bus::EventKind::faulty_transmitter:
      return driven([](const DrivenFrame& one) { return one.is(TokenControl::who_follows); });
    case token_bus::EventKind::unexpected_frame:
      return sent([&](const DrivenFrame& one) { return one.source() == about; });
    case token_bus::EventKind::response_missing:
      return driven([&](const DrivenFrame& one) { return one.is_data() && one.destination() == about; });
    case token_bus::EventKind::duplicate_address:
      return sent([&](const DrivenFrame& one) { return one.source() == bench.address(); });
  }
  return false;
}

TokenStep reports_nothing() {
  return expected<TokenScene>("nothing is reported to its user", [](TokenScene& scene) {
    const auto& events = scene.bench.user().events;
    scene.judge.expect(events.empty(), "reported_unfounded", [&] {
      return Mismatch{{"no event: nothing has happened"}, text_of_event(events[0])};
    });
  });
}

TokenStep same_successor() {
  return send("000E names 0004 as the successor of the station, which it is", [](TokenScene& scene) {
    return scene.bench.frame(TokenControl::set_successor, kOwnAddress, TokenBench::kAbove,
                             TokenBench::kBelow);
  });
}

TokenStep others_talk() {
  return send("000E solicits those between it and 000C, then sends data to 0004", [](TokenScene& scene) {
    scene.send(scene.bench.frame(TokenControl::solicit_1, 0x000C, TokenBench::kAbove));
    scene.bench.wait(scene.bench.slots(1));
    return scene.bench.data_frame(0x62, TokenBench::kBelow, TokenBench::kAbove, {1, 2});
  });
}

}  // namespace

void judge_events(TokenBench& bench, CaseJudge& judge) {
  for (const TokenUser::Reported& one : bench.user().all_events) {
    judge.expect(has_cause(bench, one), "reported_unfounded", [&] {
      return Mismatch{{"an event that something on the line leads to"}, text_of_event(one.event), one.when};
    });
  }
  const auto is_again = [](const TokenUser::Reported& one, const TokenUser::Reported& next) {
    return one.event.kind == next.event.kind && one.event.address == next.event.address &&
           one.when == next.when;
  };
  const auto& all = bench.user().all_events;
  const auto twice = std::ranges::adjacent_find(all, is_again);
  judge.expect(twice == all.end(), "reported_twice", [&] {
    return Mismatch{{"each event once"}, text_of_event(twice->event) + ", twice at once", twice->when};
  });
}

std::vector<TokenCase> token_event_cases() {
  return {
      on_chart(token_must("events/a_quiet_life_reports_nothing", "",
                          "While the token goes round, windows stay silent, others talk and noise passes by, "
                          "nothing is reported.",
                          own("events"),
                          {{"joins_with_each_token", "reported_unfounded"},
                           {"successor_with_each_token", "reported_unfounded"},
                           {"silent_window_is_a_failure", "reported_unfounded"},
                           {"noise_reported", "reported_unfounded"}}),
               {{},
                and_then({joined(), repeat({3, 3}, {token(), passes_on(), taken()}), same_successor(),
                          others_talk(), wait(10), noise(8), wait(10), reports_nothing(), until_window(),
                          passes_below(after_slots(1)), taken(), token(), passes_on(), wait(8), noise(6)},
                         {wait(40), noise(6), wait(28), taken(), serves(), reports_nothing()})}),
      on_chart(token_must("events/who_is_alone_reports_it_once", "",
                          "A station that is alone reports it when it becomes so, and not in each round.",
                          own("events"), {{"alone_in_each_round", "reported_unfounded"}}),
               {{},
                {claims(),
                 stimulus<TokenScene>("nobody answers, for 40 slot times",
                                      [](TokenScene& scene) { scene.bench.wait(scene.bench.slots(40)); }),
                 expected<TokenScene>("it has reported that it is alone, once, and nothing else",
                                      [](TokenScene& scene) {
                                        const auto& events = scene.bench.user().events;
                                        scene.judge.expect(
                                            scene.bench.user().has_event(token_bus::EventKind::sole_station,
                                                                         kOwnAddress),
                                            "not_reported", "sole station about 000A", "it is not reported");
                                        scene.judge.expect_equal(events.size(), std::size_t{1},
                                                                 "reported_unfounded", "events");
                                      })}}),
  };
}

}  // namespace fieldproof::conformance
