#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// How a station outside of the ring comes into it, and what it answers for its predecessor.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::controller;
using token_sources::memory;
using token_sources::standard;

struct Solicitation {
  TokenControl control;
  std::uint64_t destination;
  std::uint64_t source;
};

constexpr std::array kInRange{Solicitation{TokenControl::solicit_1, 0x0004, 0x000E},
                              Solicitation{TokenControl::solicit_1, 0x0008, 0x000C},
                              Solicitation{TokenControl::solicit_1, 0x0004, 0x0100},
                              Solicitation{TokenControl::solicit_1, 0x0002, 0xFFFE},
                              Solicitation{TokenControl::solicit_2, 0x0010, 0x000C},
                              Solicitation{TokenControl::solicit_2, 0x000E, 0x000E}};
constexpr std::array kOutOfRange{Solicitation{TokenControl::solicit_1, 0x000A, 0x000E},
                                 Solicitation{TokenControl::solicit_1, 0x0004, 0x0008},
                                 Solicitation{TokenControl::solicit_1, 0x000C, 0x0010},
                                 Solicitation{TokenControl::solicit_1, 0x0100, 0x0200},
                                 Solicitation{TokenControl::solicit_1, 0x0108, 0x010E},
                                 Solicitation{TokenControl::solicit_2, 0x000E, 0x0004},
                                 Solicitation{TokenControl::solicit_2, 0x000A, 0x0004}};

template <std::size_t count>
TokenStep solicitation(std::string text, const std::array<Solicitation, count>& all) {
  return send(std::move(text), [all](TokenScene& scene) {
    const Solicitation& one = all.at(scene.turn % count);
    return scene.bench.frame(one.control, one.destination, one.source);
  });
}

Octets resolve(TokenScene& scene) {
  return scene.bench.frame(TokenControl::resolve, TokenBench::kAbove, TokenBench::kAbove);
}

TokenStep who_follows(std::uint64_t lost) {
  return send(fmt::format("0020 asks who follows {:04X}", lost), [lost](TokenScene& scene) {
    return scene.bench.frame(TokenControl::who_follows, lost, TokenBench::kStranger, lost);
  });
}

// 11 10 01 00 ...: by the complement 0, 1, 2 and 3 slot times.
void address_with_all_delays(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.address = 0xE41A;
}

}  // namespace

std::vector<TokenCase> token_joining_cases() {
  return {
      on_chart(
          token_must(
              "joining/answers_at_once_in_the_first_window", "TB-16",
              "A station whose address lies in the range of the first window answers in it, with its "
              "own address.",
              standard("response windows"),
              {{"addresses_high_octet_first", "answer_missing"}, {"answers_with_successor", "answer_wrong"}}),
          {{},
           {wait(10),
            repeat({6, 6}, {solicitation("a solicitation whose range has the station, each of six", kInRange),
                            expected<TokenScene>("set_successor to who solicits, with its own address",
                                                 [](TokenScene& scene) {
                                                   const auto& one = kInRange.at(scene.turn);
                                                   scene.expect_frame(
                                                       {TokenControl::set_successor, one.source, kOwnAddress},
                                                       scene.at_once(), "set_successor", "answer_missing",
                                                       "answer_wrong");
                                                 }),
                            wait(40), noise(8)})}}),
      on_chart(
          token_must("joining/is_silent_out_of_range", "TB-17",
                     "A station whose address is none of those that are solicited is silent; the ends of a "
                     "range are not in it.",
                     standard("response windows"),
                     {{"range_with_its_ends", "answers_unasked"},
                      {"addresses_high_octet_first", "answers_unasked"}}),
          {{},
           {wait(10),
            repeat({7, 7},
                   {solicitation("a solicitation whose range does not have the station, each of seven",
                                 kOutOfRange),
                    silence(2 * 28 + 10, "answers_unasked", "its address is not solicited")}),
            solicited(), answers(TokenBench::kAbove, at_once())}}),
      on_chart(token_must(
                   "joining/second_window_is_used_after_a_silent_first", "TB-18",
                   "A station above the highest address answers in the second window, and only when the "
                   "first was silent.",
                   memory("windows of solicit_successor_2"), {{"second_window_at_once", "begins_too_early"}}),
               {{},
                {wait(10),
                 send("the lowest, 0004, solicits successors below it or above 0008",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::solicit_2, 0x0008, TokenBench::kBelow);
                      }),
                 says("set_successor to 0004 in the second window",
                      {TokenControl::set_successor, TokenBench::kBelow, kOwnAddress}, in_window(1),
                      "answer_missing", "answer_wrong"),
                 wait(40), noise(8), wait(10),
                 send("the same",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::solicit_2, 0x0008, TokenBench::kBelow);
                      }),
                 wait(6), noise(15), silence(3 * 28, "answers_after_another", "the first window was used")}}),
      on_chart(
          token_must("joining/contest_delays_are_the_complement_of_two_bits", "TB-19",
                     "Who has answered and sees contention resolved answers again after 0 to 3 slot times, "
                     "the greater its next two bits the sooner.",
                     memory("resolve_contention"),
                     {{"contest_not_complemented", "answer_missing"},
                      {"contest_with_the_first_pair_only", "begins_too_early"}}),
          {{},
           {wait(10),
            send("F000 solicits a successor between it and 0004",
                 [](TokenScene& scene) {
                   return scene.bench.frame(TokenControl::solicit_1, TokenBench::kBelow, 0xF000);
                 }),
            says("set_successor to F000", {TokenControl::set_successor, 0xF000}, at_once(), "answer_missing",
                 "answer_wrong"),
            contest()}},
          {.adjust = address_with_all_delays}),
      on_chart(
          token_must("joining/yields_to_who_answers_sooner", "TB-20",
                     "In a contest a station that receives another before its own delay is over gives up.",
                     standard("resolve_contention"), {{"yields_to_nobody", "answers_after_another"}}),
          {{},
           {wait(10), solicited(), answers(TokenBench::kAbove, at_once()), wait(6),
            send("000E resolves contention", resolve), wait(6), noise(15),
            silence(4 * 28, "answers_after_another", "another has answered sooner")}}),
      on_chart(token_must("joining/the_token_makes_it_a_member", "TB-16",
                          "Who has answered and gets the token is in the ring: it passes the token on to the "
                          "successor of who solicited.",
                          standard("set_successor"),
                          {{"successor_is_who_solicited", "token_wrong"},
                           {"token_to_predecessor", "token_wrong"},
                           {"token_with_data", "token_wrong"},
                           {"joins_unreported", "not_reported"},
                           {"events_twice", "reported_twice"},
                           {"reports_about_a_stranger", "not_reported"}}),
               {{},
                {wait(10), solicited(), answers(TokenBench::kAbove, at_once()), wait(6), token(),
                 says("the token to 0004", {TokenControl::token, TokenBench::kBelow}, at_once(),
                      "token_missing", "token_wrong"),
                 reported("that it has joined", token_bus::EventKind::joined, TokenBench::kAbove)}}),
      on_chart(
          token_must("joining/noise_is_no_reason_to_wait_longer", "TB-16",
                     "Who has answered and gets no token within demand_wait_slots has not been solicited, "
                     "whatever noise there was: a later token comes from its successor.",
                     token_sources::own("demand_wait_slots"), {{"offer_kept", "token_wrong"}}),
          {{},
           {wait(10), solicited(), answers(TokenBench::kAbove, at_once()), wait(60), noise(6), wait(70),
            token(),
            says("the token to 000E, who has sent it", {TokenControl::token, TokenBench::kAbove}, at_once(),
                 "token_missing", "token_wrong")}}),
      on_chart(
          token_must("joining/answers_for_its_predecessor", "TB-23",
                     "When a token passer asks who follows a station, the one whose predecessor that is "
                     "answers, and contends as any that has answered; nobody else does.",
                     standard("who_follows"),
                     {{"answers_as_the_lost_one", "answers_unasked"},
                      {"members_do_not_contend", "contest_missing"}}),
          {{},
           {joined(), who_follows(kOwnAddress),
            silence(2 * 28, "answers_unasked", "its predecessor is another"), who_follows(TokenBench::kBelow),
            silence(2 * 28, "answers_unasked", "its predecessor is another"), who_follows(TokenBench::kAbove),
            says("set_successor to 0020 with its own address",
                 {TokenControl::set_successor, TokenBench::kStranger, kOwnAddress}, at_once(),
                 "answer_missing", "answer_wrong"),
            wait(8),
            send("0020 resolves contention",
                 [](TokenScene& scene) {
                   return scene.bench.frame(TokenControl::resolve, TokenBench::kStranger,
                                            TokenBench::kStranger);
                 }),
            says("set_successor to 0020 after three slot times, by the pair 00",
                 {TokenControl::set_successor, TokenBench::kStranger, kOwnAddress}, in_window(3),
                 "contest_missing", "answer_wrong")}}),
      on_chart(token_must("joining/a_station_that_has_nothing_to_send_stays_outside", "TB-17",
                          "A station that is not to be in the ring and has nothing to send answers no "
                          "solicitation; with data it does.",
                          standard("in_ring_desired"), {{"always_joins", "answers_unasked"}}),
               {{},
                {stimulus<TokenScene>("the user does not want the station in the ring",
                                      [](TokenScene& scene) { scene.bench.set_in_ring_desired(false); }),
                 wait(10), solicited(), silence(2 * 28, "answers_unasked", "it has no reason to join"),
                 submit({6}, 4), solicited(), answers(TokenBench::kAbove, at_once())}}),
  };
}

}  // namespace fieldproof::conformance
