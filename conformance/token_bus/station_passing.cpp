#include <fmt/format.h>

#include "conformance/token_bus/station_scene.hpp"

// How the token leaves a station: the pass, windows for others, who leaves.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::controller;
using token_sources::memory;
using token_sources::mib;
using token_sources::standard;

TokenStep passes_to(std::uint64_t next, SpanOf span) {
  return says(fmt::format("the token to {:04X}", next), {TokenControl::token, next}, std::move(span),
              "token_missing", "token_wrong");
}

TokenStep is_window(TokenControl control, std::uint64_t destination) {
  return require(
      fmt::format("it is a solicitation of {} with the successor {:04X}",
                  control == TokenControl::solicit_1 ? "one window" : "two windows", destination),
      [=](TokenScene& scene) {
        return scene.answer.is(control) && scene.answer.destination() == destination;
      },
      "window_wrong");
}

TokenStep answered_by(std::uint64_t joiner) {
  return send(fmt::format("{:04X} answers", joiner), [joiner](TokenScene& scene) {
    return scene.bench.frame(TokenControl::set_successor, scene.bench.address(), joiner, joiner);
  });
}

TokenStep resolves() {
  return says("resolve_contention", {TokenControl::resolve}, at_once(), "contention_not_resolved",
              "contention_not_resolved");
}

TokenStep leaves_wish() {
  return stimulus<TokenScene>("the user does not want the station in the ring any more",
                              [](TokenScene& scene) { scene.bench.set_in_ring_desired(false); });
}

}  // namespace

std::vector<TokenCase> token_passing_cases() {
  return {
      on_chart(
          token_must("passing/token_goes_to_its_successor", "TB-06",
                     "A station with nothing to send passes the token on to its successor, within the slot "
                     "time in which the others wait for it.",
                     standard("token pass"), {{"begins_after_four_octets", "begins_too_early"}}),
          // Fewer tokens than there are between two response windows.
          {{5, 12}, {token(), passes_to(TokenBench::kBelow, at_once()), taken()}, {joined()}}),
      on_chart(
          token_must("passing/one_window_between_it_and_its_successor", "TB-11",
                     "When enough tokens have gone by the station solicits successors between it and its "
                     "own: one window of one slot time, then the token.",
                     mib("max_inter_solicit_count"),
                     {{"opens_no_window", "window_missing"},
                      {"windows_of_two_slots", "begins_too_late"},
                      {"solicits_with_data", "window_missing"}},
                     {{standard("response windows"), {"window_wrong", "begins_too_late"}}}),
          {{},
           {joined(), until_window(), is_window(TokenControl::solicit_1, TokenBench::kBelow),
            passes_to(TokenBench::kBelow, after_slots(1))}}),
      on_chart(
          token_must("passing/the_lowest_opens_two_windows", "TB-12",
                     "The station with the lowest address solicits by solicit_successor_2: two windows, for "
                     "those below it and those above the highest.",
                     standard("solicit_successor_2"), {{"lowest_opens_one_window", "window_wrong"}}),
          {{},
           {joined_as_lowest(), until_window(), is_window(TokenControl::solicit_2, TokenBench::kAbove),
            passes_to(TokenBench::kAbove, after_slots(2))}}),
      on_chart(
          token_must("passing/who_answers_is_the_successor", "TB-13",
                     "One station that answers in a window is the successor from then on, and gets the "
                     "token.",
                     standard("set_successor"), {{"answer_not_taken", "token_missing"}}),
          {{},
           {joined(), until_window(), wait(6), answered_by(0x0006), passes_to(0x0006, at_once()), wait(8),
            send("it passes the token on to 000E",
                 [](TokenScene& scene) {
                   return scene.bench.frame(TokenControl::token, TokenBench::kAbove, 0x0006);
                 }),
            wait(8), token(), passes_to(0x0006, at_once())}}),
      on_chart(
          token_must("passing/contention_is_resolved", "TB-14",
                     "Several that answer at once are asked to contend, in four windows; who then answers "
                     "alone is the successor.",
                     standard("resolve_contention"), {{"contention_is_silence", "contention_not_resolved"}}),
          {{},
           {joined(), until_window(), wait(6), noise(17), resolves(), wait(6 + 2 * 28), answered_by(0x0008),
            passes_to(0x0008, at_once())}}),
      on_chart(token_must("passing/contention_without_an_answer_ends_after_four_windows", "TB-14",
                          "When nobody answers in a contest the token goes to the successor of before.",
                          standard("resolve_contention"), {{"contest_of_two_windows", "begins_too_early"}}),
               {{},
                {joined(), until_window(), wait(6), noise(17), resolves(),
                 passes_to(TokenBench::kBelow, after_slots(4))}}),
      on_chart(
          token_must("passing/contention_for_ever_is_given_up", "TB-15",
                     "After as many contests as the address has pairs of bits, and one, the token goes to "
                     "the successor of before.",
                     memory("max_pass_count"),
                     {{"resolves_for_ever", "token_wrong"}, {"resolves_once", "contention_not_resolved"}}),
          {{},
           {joined(), until_window(), wait(6), repeat({9, 9}, {noise(17), resolves(), wait(6)}), noise(17),
            passes_to(TokenBench::kBelow, at_once())}}),
      on_chart(token_must("passing/a_frame_after_the_token_is_its_success", "TB-25",
                          "A valid frame after the token shows that it was taken: the station listens.",
                          standard("token pass"), {{"success_not_seen", "token_repeated"}}),
               {{},
                {joined(), token(), passes_to(TokenBench::kBelow, at_once()), wait(8),
                 send("data from its successor",
                      [](TokenScene& scene) {
                        return scene.bench.data_frame(0x62, TokenBench::kAbove, TokenBench::kBelow, {1, 2});
                      }),
                 silence(6 * 28, "token_repeated", "its successor has the token"), taken(), serves()}}),
      on_chart(token_must("passing/who_is_named_by_a_leaving_successor_is_the_next", "TB-30",
                          "A station whose successor leaves takes the one that this names, reports it, and "
                          "passes the token to it.",
                          standard("leaving"), {{"new_successor_not_taken", "token_wrong"}}),
               {{},
                {joined(), token(), passes_to(TokenBench::kBelow, at_once()), wait(8),
                 send("0004 leaves, and names 0002",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::set_successor, kOwnAddress, TokenBench::kBelow,
                                                 0x0002);
                      }),
                 taken(), token(), passes_to(0x0002, at_once()),
                 reported("the new successor", token_bus::EventKind::successor_changed, 0x0002)}}),
      on_chart(token_must("passing/who_passes_the_token_is_its_predecessor", "TB-06",
                          "The predecessor of a station is who has passed the last token to it: it answers "
                          "for that one, and names its successor to that one when it leaves.",
                          standard("token pass"), {{"first_predecessor_kept", "answer_missing"}}),
               {{},
                {joined(),
                 send("0010, which has come between, passes the token to the station",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::token, kOwnAddress, 0x0010);
                      }),
                 passes_to(TokenBench::kBelow, at_once()), taken(),
                 send("0020 asks who follows 0010",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::who_follows, 0x0010, TokenBench::kStranger,
                                                 0x0010);
                      }),
                 says("set_successor to 0020 with its own address",
                      {TokenControl::set_successor, TokenBench::kStranger, kOwnAddress}, at_once(),
                      "answer_missing", "answer_wrong")}}),
      on_chart(token_must("passing/who_leaves_names_its_successor", "TB-30",
                          "A station that is not to be in the ring any more sends set_successor with its "
                          "successor to its predecessor, passes the token, and is silent.",
                          standard("leaving"),
                          {{"leaving_with_exchanged_neighbours", "leaving_wrong"},
                           {"leaves_without_a_word", "leaving_wrong"}}),
               {{},
                {joined(), leaves_wish(), token(),
                 says("set_successor to 000E with 0004",
                      {TokenControl::set_successor, TokenBench::kAbove, TokenBench::kBelow}, at_once(),
                      "leaving_missing", "leaving_wrong"),
                 passes_to(TokenBench::kBelow, at_once()), taken(),
                 silence(10 * 28, "speaks_after_leaving", "it is not in the ring"),
                 reported("that it has left", token_bus::EventKind::left, kOwnAddress)}}),
  };
}

}  // namespace fieldproof::conformance
