#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// What brings a station into the ring, what keeps it there, and what it remembers of an answer.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::memory;
using token_sources::own;
using token_sources::standard;

constexpr std::array kPriorities{6U, 4U, 2U, 0U};

TokenStep datum_of_the_class(unsigned first) {
  return stimulus<TokenScene>(
      fmt::format("the user submits a datum of class {}; in the next turns of each class below",
                  kPriorities.at(first)),
      [first](TokenScene& scene) {
        scene.bench.submit({.priority = kPriorities.at(first + scene.turn),
                            .destination = TokenBench::kBelow,
                            .data = scene.bench.numbered_data(10)});
      });
}

TokenStep frame_of(const std::string& text, TokenControl control, std::uint64_t destination,
                   std::uint64_t source, std::optional<std::uint64_t> data = std::nullopt) {
  return send(text, [=](TokenScene& scene) { return scene.bench.frame(control, destination, source, data); });
}

TokenStep contest_above() {
  return frame_of("000E resolves contention", TokenControl::resolve, TokenBench::kAbove, TokenBench::kAbove);
}

TokenStep another_is_sooner() {
  return send("000C answers sooner; in the next turns 000C sends data to 000E, and passes the token to 0004",
              [](TokenScene& scene) {
                switch (scene.turn) {
                  case 0:
                    return scene.bench.frame(TokenControl::set_successor, TokenBench::kAbove, 0x000C, 0x000C);
                  case 1:
                    return scene.bench.data_frame(0x62, TokenBench::kAbove, 0x000C, {1, 2});
                  default:
                    return scene.bench.frame(TokenControl::token, TokenBench::kBelow, 0x000C);
                }
              });
}

std::vector<TokenStep> leaves(std::uint64_t successor) {
  return {desired(false),
          token(),
          says("set_successor to 000E with its successor",
               {TokenControl::set_successor, TokenBench::kAbove, successor}, at_once(), "leaving_missing",
               "leaving_wrong"),
          says("the token to its successor", {TokenControl::token, successor}, at_once(), "token_missing",
               "token_wrong"),
          wait(8),
          frame_of("its successor passes the token on", TokenControl::token, TokenBench::kAbove, successor)};
}

std::vector<TokenCase> answers_and_offers() {
  return {
      on_chart(token_must("membership/an_answer_for_nothing_is_forgotten", "TB-17",
                          "A station that has answered and got no token in its time is as before: who passes "
                          "it the token later is its successor.",
                          own("joining"), {{"offer_kept", "token_wrong"}}),
               {{},
                {wait(10), solicited(), answers(TokenBench::kAbove, at_once()), wait(4 * 28 + 10),
                 frame_of("0006 passes the token to the station", TokenControl::token, kOwnAddress, 0x0006),
                 says("the token to 0006", {TokenControl::token, 0x0006}, at_once(), "token_missing",
                      "token_wrong")}}),
      on_chart(token_must("membership/a_member_keeps_its_successor", "TB-17",
                          "A member that answers a solicitation keeps its successor.", own("joining"),
                          {{"member_takes_the_offer", "token_wrong"}}),
               {{},
                {joined(),
                 frame_of("000E solicits a successor between it and 0006", TokenControl::solicit_1, 0x0006,
                          TokenBench::kAbove),
                 answers(TokenBench::kAbove, at_once()), wait(8), token(), passes_below(at_once())}}),
      on_chart(
          token_must("membership/noise_leaves_it_demanding", "TB-18",
                     "A station that has answered contends when contention is resolved, though noise came "
                     "between.",
                     standard("resolve_contention"), {{"noise_ends_its_demand", "answer_missing"}}),
          {{},
           {wait(10), solicited(), answers(TokenBench::kAbove, at_once()), wait(5), noise(17), wait(6),
            contest_above(), answers(TokenBench::kAbove, in_window(3))}}),
      on_chart(token_must("membership/it_yields_to_whatever_comes_sooner", "TB-20",
                          "A station that waits in a contest gives up when it receives something before.",
                          memory("resolve_contention"), {{"yields_to_no_frame", "answers_after_another"}}),
               {{},
                {repeat({3, 3},
                        {wait(10), solicited(), answers(TokenBench::kAbove, at_once()), wait(6),
                         contest_above(), wait(10), another_is_sooner(),
                         silence(4 * 28, "answers_after_another", "another was sooner"), starts_anew()})}}),
  };
}

}  // namespace

std::vector<TokenCase> token_membership_cases() {
  std::vector<TokenCase> all = answers_and_offers();
  const auto source = standard("in_ring_desired");
  const std::vector<TokenCase> others{
      on_chart(token_must("membership/data_of_each_class_bring_it_in", "TB-30",
                          "A station that is not to be in the ring joins to send its data, whatever their "
                          "class.",
                          source, {{"urgent_data_only_join", "answer_missing"}}),
               {{},
                {repeat({4, 4}, {wait(10), datum_of_the_class(0), solicited(),
                                 answers(TokenBench::kAbove, at_once()), starts_anew()})}},
               {.adjust = [](token_bus::StationConfiguration& configuration,
                             kernel::Random&) { configuration.in_ring_desired = false; }}),
      on_chart(token_must("membership/data_of_each_class_keep_it", "TB-30",
                          "A station that is not to be in the ring any more stays while data wait, whatever "
                          "their class.",
                          source, {{"urgent_data_only_join", "token_wrong"}}),
               {{},
                {repeat({3, 3}, {joined(), datum_of_the_class(1), desired(false), token(),
                                 passes_below(at_once()), starts_anew()})}},
               with([](token_bus::Rules& rules) { rules.target_rotation_octets.fill(0); })),
      on_chart(token_must("membership/who_has_left_answers_no_solicitation", "TB-30",
                          "A station that has left the ring as it was asked to answers no solicitation.",
                          source, {{"answers_after_leaving", "speaks_after_leaving"}}),
               {{},
                and_then({joined()}, leaves(TokenBench::kBelow),
                         {wait(10), solicited(),
                          silence(2 * 28 + 10, "speaks_after_leaving", "it is not to be in the ring"),
                          frame_of("000E solicits anybody", TokenControl::solicit_2, TokenBench::kAbove,
                                   TokenBench::kAbove),
                          silence(3 * 28, "speaks_after_leaving", "it is not to be in the ring")})}),
      on_chart(
          token_must("membership/each_time_is_reported", "",
                     "Each time that a station joins, gets another successor, and leaves is reported.",
                     own("events"),
                     {{"joins_once", "not_reported"},
                      {"first_successor_only", "not_reported"},
                      {"first_leaving_only", "not_reported"}}),
          {{},
           {repeat(
               {3, 3},
               and_then({wait(10), forget_events(), solicited(), answers(TokenBench::kAbove, at_once()),
                         wait(8), token(), passes_below(at_once()), taken(),
                         reported_again("it", token_bus::EventKind::joined, TokenBench::kAbove),
                         frame_of("0004 names 0002 as the successor of the station",
                                  TokenControl::set_successor, kOwnAddress, TokenBench::kBelow, 0x0002),
                         reported_again("it", token_bus::EventKind::successor_changed, 0x0002), wait(8)},
                        leaves(0x0002),
                        {reported_again("it", token_bus::EventKind::left, kOwnAddress), desired(true)}))}}),
  };
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace fieldproof::conformance
