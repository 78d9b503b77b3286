#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/dual_channel_scene.hpp"

// What the MAC requests goes out on both channels, whatever is known of them; answers come from one.
namespace fieldproof::conformance {
namespace {

using namespace manager_chart;

constexpr std::size_t kCommandSymbols = 16;

// All that a MAC may request, in any order.
std::string random_request(ManagerScene& scene) {
  std::string symbols = "P";
  while (symbols.size() < 64) symbols += "SP01N"[scene.bench.random_octet() % 5];
  return symbols + "1";
}

ManagerStep frame_requested() {
  return does("a frame is requested",
              [](ManagerScene& scene) { scene.request(frame_text(scene.bench.random_octets(9))); });
}
ManagerStep on_both(std::string reason) {
  return requires_that("each channel is requested the same, and nothing else",
                       [reason = std::move(reason)](ManagerScene& scene) {
                         scene.expect_on_both_channels(scene.requested, reason);
                       });
}

void expect_together(ManagerScene& scene) {
  scene.expect_on_both_channels(scene.requested, "not_on_both");
  const kernel::Time on_a = scene.bench.requested(Channel::a).begin();
  const kernel::Time on_b = scene.bench.requested(Channel::b).begin();
  const kernel::Duration skew = on_a < on_b ? on_b - on_a : on_a - on_b;
  const kernel::Duration most = scene.bench.symbols(scene.bench.configuration().channels.skew_symbols);
  scene.judge.expect(skew <= most, "channels_apart", kernel::describe(most), kernel::describe(skew));
  const kernel::Duration took = std::max(on_a, on_b) - scene.begin;
  scene.judge.expect(took <= scene.bench.request_delay() + kernel::kNanosecond, "sent_too_late",
                     kernel::describe(scene.bench.request_delay()), kernel::describe(took));
}

void command_all(ManagerScene& scene) {
  using enum SideCommand;
  constexpr std::array kAll{reset, disable_loopback, enable_transmitter, idle, serial_data};
  const SideCommand command = kAll.at(scene.round % kAll.size());
  scene.bench.clear();
  scene.requested = std::string(kCommandSymbols, letter_of(command));
  scene.bench.command(command, kCommandSymbols);
}

template <unsigned skew, unsigned delay>
ManagerCase together_case() {
  return on_chart(manager_must(fmt::format("requests/together_with_{}_and_{}", skew, delay), "",
                               fmt::format("The channels begin at most the skew apart, here {}, each within "
                                           "the delay, here {}.",
                                           skew, delay),
                               "skew of an octet at most",
                               {{"b_is_20_symbols_later", skew < 20 ? "channels_apart" : "sent_too_late"}}),
                  {{2, 20},
                   {frame_requested(),
                    requires_that("both channels are requested it in time, and together", expect_together)}},
                  {.adjust = [](token_bus::ChannelManagerConfiguration& one) {
                    one.channels.skew_symbols = skew;
                    one.delay_symbols = delay;
                  }});
}

// Each answer of one channel alone, then, while nothing else is on, of the other one.
void answer_in_turn(ManagerScene& scene) {
  constexpr std::string_view kAnswers = "iane";
  const std::size_t other = scene.round / 2 / kAnswers.size();
  const std::string first(kCommandSymbols, kAnswers[scene.round / 2 % kAnswers.size()]);
  const std::string second(kCommandSymbols, kAnswers[other % kAnswers.size()]);
  constexpr std::int64_t kPause = 40;
  scene.carry_from(scene.here(), {first}, {second, kCommandSymbols + kPause});
  scene.expect_indicated(first + std::string(kPause, 'S') + second, "answer_wrong");
}

ManagerStep answered(std::string text, std::string on_a, std::string on_b, std::string indicated,
                     std::string reason) {
  return {std::move(text), "it is indicated", [=](ManagerScene& scene) {
            const auto of = [](const std::string& answer) {
              std::string all;
              for (std::size_t n = 0; n < kCommandSymbols; ++n) all += answer;
              return all;
            };
            scene.carry({of(on_a)}, {of(on_b)});
            scene.expect_indicated(of(indicated), reason);
          }};
}

}  // namespace

std::vector<ManagerCase> manager_request_cases() {
  return {
      on_chart(manager_must("requests/go_out_on_both_channels", "",
                            "What the MAC requests is requested of both channels, symbol by symbol.",
                            "a redundant medium carries everything twice",
                            {{"sends_on_a_alone", "not_on_both"},
                             {"sends_on_the_preferred_alone", "not_on_both"},
                             {"zero_and_one_exchanged_on_b", "not_on_both"}}),
               {{10, 100},
                {does("symbols of all five kinds at random are requested",
                      [](ManagerScene& scene) { scene.request(random_request(scene)); }),
                 on_both("not_on_both")}}),
      on_chart(
          manager_must("requests/begin_together", "",
                       "The channels begin at most the skew apart, each within the delay.",
                       "skew of an octet at most",
                       {{"b_is_20_symbols_later", "channels_apart"}, {"slow_requests", "sent_too_late"}}),
          {{3, 30},
           {frame_requested(),
            requires_that("both channels are requested it in time, and together", expect_together)}}),
      together_case<1, 64>(),
      together_case<32, 2>(),
      on_chart(manager_must("requests/the_longest_frame_goes_out", "",
                            "A frame of 8191 octets goes out whole on both channels.",
                            "a manager knows no length", {{"gives_up_after_50000", "not_on_both"}}),
               {{1, 3},
                {does("a frame of 8191 octets is requested",
                      [](ManagerScene& scene) {
                        scene.request(frame_text(
                            scene.bench.random_octets(scene.bench.configuration().rules.most_octets)));
                      }),
                 on_both("not_on_both")}}),
      on_chart(
          manager_must("requests/go_on_after_a_fault", "",
                       "A channel with a fault is requested everything all the same: so it is known "
                       "when it is repaired.",
                       "who has a fault is sent to",
                       {{"sends_on_a_alone", "not_on_both"}, {"silent_on_a_faulty_channel", "not_on_both"}}),
          {{3, 30}, {powered_anew(), b_serves(), frame_requested(), on_both("not_on_both")}}),
  };
}

std::vector<ManagerCase> manager_management_cases() {
  return {
      on_chart(manager_must("management/commands_after_a_fault", "",
                            "A channel with a fault is given commands all the same.",
                            "who has a fault is sent to", {{"silent_on_a_faulty_channel", "not_on_both"}}),
               {{5, 25},
                {powered_anew(), b_serves(), does("each command of the management mode in turn", command_all),
                 on_both("not_on_both")}}),
      on_chart(manager_must("management/each_answer_of_either", "",
                            "Each answer is indicated where the other channel gives none, whether that one "
                            "has answered before, and whether a channel has a fault.",
                            "whose answer counts", {{"answers_of_the_preferred_alone", "answer_wrong"}}),
               {{32, 64},
                {powered_anew(),
                 {"a channel answers, each answer in turn, and later the other one, each answer in turn",
                  "both answers are indicated", answer_in_turn},
                 does("a channel alone carries a frame",
                      [](ManagerScene& scene) { scene.carry_on(scene.here()); }),
                 {"the same answers", "both are indicated", answer_in_turn}}}),
      on_chart(manager_must("management/commands_go_to_both", "",
                            "Commands of the management mode are requested of both channels as they are.",
                            "both translators are brought on line together",
                            {{"commands_on_a_alone", "not_on_both"}}),
               {{5, 25},
                {does("each command of the management mode in turn", command_all), on_both("not_on_both")}}),
      on_chart(manager_must("management/one_answer_is_enough", "",
                            "The MAC is indicated the answers of the preferred channel; where it gives none, "
                            "those of the other one: a dead translator keeps no station off line.",
                            "whose answer counts",
                            {{"answers_dropped", "answer_wrong"},
                             {"answers_of_the_preferred_alone", "answer_wrong"},
                             {"answers_of_both_mixed", "answer_wrong"},
                             {"answers_of_the_other_first", "answer_wrong"}}),
               {{2, 10},
                {powered_anew(), answered("both channels answer ACK", "a", "a", "a", "answer_wrong"),
                 answered("B alone answers ACK", "", "a", "a", "answer_wrong"),
                 answered("A answers NACK, and B ACK", "n", "a", "n", "answer_wrong"),
                 answered("A alone answers with a physical error", "e", "", "e", "answer_wrong"), b_serves(),
                 answered("A answers IDLE, and B ACK; B is preferred", "i", "a", "a", "answer_wrong")}}),
  };
}

}  // namespace fieldproof::conformance
