#include <fmt/format.h>

#include <algorithm>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"

// What begins anew each time: contests, claims, repetitions, the search for a successor. And what has begun
// in time and ends later.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::memory;
using token_sources::mib;
using token_sources::own;
using token_sources::standard;

// Its first pair is 11: it answers a contest at once, and its first claim is the longest.
void address_that_begins_high(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.address = 0xE41A;
}

TokenStep resolves_once() {
  return says("resolve_contention", {TokenControl::resolve}, at_once(), "contention_not_resolved",
              "contention_not_resolved");
}

TokenStep passes_to_0002(SpanOf span) {
  return says("the token to 0002", {TokenControl::token, 0x0002}, std::move(span), "token_missing",
              "token_wrong");
}

TokenStep first_contest() {
  return {"F000 solicits, and resolves contention",
          "set_successor at once, and by the first pair of its address again at once", [](TokenScene& scene) {
            constexpr std::uint64_t kSender = 0xF000;
            const auto expect_answer = [&](const std::string& what) {
              scene.expect_frame({TokenControl::set_successor, kSender}, scene.at_once(), what,
                                 "answer_missing", "answer_wrong");
            };
            scene.send(scene.bench.frame(TokenControl::solicit_1, TokenBench::kBelow, kSender));
            expect_answer("set_successor to F000");
            scene.bench.wait(scene.bench.octets(8));
            scene.send(scene.bench.frame(TokenControl::resolve, kSender, kSender));
            expect_answer("set_successor in the first window");
            scene.bench.wait(scene.bench.octets(40));
            scene.since = scene.bench.send_noise(8);
            scene.bench.wait(scene.bench.octets(10));
          }};
}

// And another claims longer.
TokenStep longest_claim() {
  return expected<TokenScene>("the first claim, of six slot times", [](TokenScene& scene) {
    scene.expect_frame({TokenControl::claim}, scene.after_slots(scene.bench.rules().bus_idle_slots),
                       "the first claim", "claim_missing", "claim_wrong");
    scene.judge.expect_equal(scene.answer.data().size(),
                             std::size_t{6} * scene.bench.rules().slot_time_octets, "claim_length_wrong",
                             "octets of data in the first claim");
    scene.bench.wait(scene.bench.octets(20));
    scene.since = scene.bench.send_noise(30);
  });
}

std::vector<TokenCase> ends_later() {
  return {
      on_chart(token_must("anew/an_answer_may_end_after_its_window", "TB-13",
                          "An answer that begins in its window is one, though it ends after it.",
                          standard("response windows"), {{"window_not_held_open", "token_wrong"}}),
               {{},
                {joined(), until_window(), wait(26),
                 send("0002 answers",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::set_successor, kOwnAddress, 0x0002, 0x0002);
                      }),
                 passes_to_0002(at_once())}}),
      on_chart(token_must("anew/a_response_may_end_after_its_time", "TB-27",
                          "A response that begins within two slot times is one, though it ends later.",
                          standard("response"), {{"response_not_waited_for", "not_delivered"}}),
               {{},
                {joined(), request(), token(), is_requested(at_once()), wait(2 * 28 - 2),
                 send("0004 responds with 200 octets",
                      [](TokenScene& scene) {
                        return scene.bench.data_frame(0x6A, kOwnAddress, TokenBench::kBelow, Octets(200));
                      }),
                 delivered("the response is reported to its user", 1), passes_below(at_once())}}),
      on_chart(token_must("anew/a_long_frame_shows_that_the_token_was_taken", "TB-25",
                          "A frame that begins within a slot time after the token shows that it was taken, "
                          "though it ends later.",
                          standard("token pass"), {{"success_not_waited_for", "token_repeated"}}),
               {{},
                {joined(), token(), passes_below(at_once()), wait(26),
                 send("0004 sends 300 octets of data to 000E",
                      [](TokenScene& scene) {
                        return scene.bench.data_frame(0x62, TokenBench::kAbove, TokenBench::kBelow,
                                                      Octets(300));
                      }),
                 silence(5 * 28, "token_repeated", "its successor has the token"),
                 require(
                     "it has sent nothing meanwhile",
                     [](TokenScene& scene) {
                       return std::ranges::none_of(scene.bench.driven(), [&](const DrivenFrame& one) {
                         return one.begin > scene.answer.begin;
                       });
                     },
                     "token_repeated"),
                 taken(), serves()}}),
  };
}

}  // namespace

std::vector<TokenCase> token_anew_cases() {
  std::vector<TokenCase> all = ends_later();
  const std::vector<TokenCase> others{
      on_chart(token_must("anew/each_contest_begins_with_the_first_pair", "TB-19",
                          "A station that is solicited again contends by its first two bits again.",
                          memory("resolve_contention"), {{"contest_goes_on_from_before", "begins_too_late"}}),
               {{}, {wait(10), first_contest(), first_contest()}}, {.adjust = address_that_begins_high}),
      on_chart(
          token_must("anew/each_claim_begins_with_the_first_pair", "TB-02",
                     "A station that has given up its claim begins the next one by its first two bits.",
                     memory("order of the pairs"), {{"claim_goes_on_from_before", "claim_length_wrong"}}),
          {{}, {longest_claim(), longest_claim()}}, {.adjust = address_that_begins_high}),
      on_chart(token_must("anew/each_window_has_its_contests", "TB-15",
                          "When contests were given up in one window, contention is resolved in the next.",
                          memory("max_pass_count"), {{"contests_used_up", "contention_not_resolved"}}),
               {{},
                {joined(), until_window(), wait(6), repeat({9, 9}, {noise(17), resolves_once(), wait(6)}),
                 noise(17), passes_below(at_once()), taken(), until_window(), wait(6), noise(17),
                 resolves_once()}}),
      on_chart(
          token_must("anew/each_successor_is_sought_from_the_begin", "TB-22",
                     "When who has answered who_follows does not take the token, it is repeated, and who "
                     "follows that one is asked.",
                     standard("token pass failure"), {{"search_goes_on_from_before", "token_wrong"}}),
          {{},
           {joined(), token(), passes_below(at_once()), passes_below(after_slots(1)),
            asks_who_follows(after_slots(1)), wait(6),
            send("0002 answers",
                 [](TokenScene& scene) {
                   return scene.bench.frame(TokenControl::set_successor, kOwnAddress, 0x0002, 0x0002);
                 }),
            passes_to_0002(at_once()), passes_to_0002(after_slots(1)),
            says("who_follows 0002", {TokenControl::who_follows, 0x0002, 0x0002}, after_slots(1),
                 "who_follows_missing", "who_follows_wrong")}}),
      on_chart(token_must("anew/noise_is_waited_out_after_each_token", "TB-24",
                          "Noise after a token that was repeated is waited out as the first was.",
                          memory("token_pass_timer after noise"),
                          {{"second_noise_is_success", "who_follows_missing"}}),
               {{},
                {joined(), token(), passes_below(at_once()), wait(8), noise(6), passes_below(after_slots(4)),
                 wait(8), noise(6), asks_who_follows(after_slots(4))}}),
      on_chart(token_must("anew/each_request_has_its_repetitions", "TB-27",
                          "The second request of a visit is repeated as often as the first.",
                          mib("max_retry_limit"), {{"repetitions_used_up", "request_wrong"}}),
               {{},
                {joined(), request(), token(), is_requested(at_once()), request_repeated(), taken(),
                 request(), token(), is_requested(at_once()), request_repeated(), taken()}}),
      on_chart(token_must("anew/a_claim_makes_it_alone", "TB-04",
                          "A member that claims a lost token knows no neighbour: it solicits anybody.",
                          standard("claim process"), {{"neighbours_kept_by_a_claim", "no_use_of_the_token"}}),
               {{},
                {joined(), claims(),
                 says("anybody is solicited by who is alone", {TokenControl::solicit_2, kOwnAddress},
                      after_slots(1), "no_use_of_the_token", "no_use_of_the_token")}}),
  };
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace fieldproof::conformance
