#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// Management mode, which IEEE 802.3 does not have: the translator answers in its place.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::memory;
using token_sources::own;
using token_sources::paper;
using enum SideCommand;

std::string_view text_of_answer(char answer) {
  constexpr std::string_view kLetters = "iane";
  constexpr std::array<std::string_view, 4> kTexts{"IDLE", "ACK", "NACK", "a physical error"};
  return kTexts.at(kLetters.find(answer));
}

TranslatorStep commanded(SideCommand command) {
  return does(std::string(text_of(command)), [command](TranslatorScene& scene) {
    scene.answers_to(command);
    scene.bench.clear();
  });
}

TranslatorStep answers(SideCommand command, char answer, std::string reason) {
  return {std::string(text_of(command)), fmt::format("the answer is {}", text_of_answer(answer)),
          [=](TranslatorScene& scene) {
            const std::string seen = scene.answers_to(command);
            scene.judge.expect(seen == std::string(1, answer), reason, [&] {
              return Mismatch{{std::string(1, answer)}, seen.empty() ? "none" : seen};
            });
          }};
}

TranslatorStep frame_requested() {
  return does("a frame is requested",
              [](TranslatorScene& scene) { scene.request(frame_text(scene.octets)); });
}
TranslatorStep nothing_sent(std::string reason, std::string why) {
  return requires_that("nothing is sent: " + why,
                       [=](TranslatorScene& scene) { scene.expect_nothing_sent(reason, why); });
}
TranslatorStep is_sent(std::string reason) {
  return requires_that("it is sent",
                       [=](TranslatorScene& scene) { scene.expect_sent(encoded(scene.requested), reason); });
}
TranslatorStep is_looped_back(std::string reason) {
  return requires_that("it is indicated", [=](TranslatorScene& scene) {
    scene.expect_content(scene.requested.substr(scene.requested.find('N')), reason);
  });
}
TranslatorStep nothing_indicated(std::string reason, std::string why) {
  return requires_that("silence is indicated: " + why,
                       [=](TranslatorScene& scene) { scene.expect_nothing_indicated(reason, why); });
}
TranslatorStep frame_received() {
  return does("a frame comes from the line",
              [](TranslatorScene& scene) { scene.receive(encoded(frame_text(scene.octets))); });
}

void receive_under_management(TranslatorScene& scene) {
  const std::string bits = encoded(frame_text(scene.octets));
  scene.bench.clear();
  scene.bench.command_and_receive(idle, bits.size() / 2 + 10, side_bits_of(bits));
}

void expect_answers_only(TranslatorScene& scene) {
  scene.bench.settle();
  const std::string& seen = scene.bench.indicated().text();
  scene.judge.expect(seen.find('i') != std::string::npos, "no_answer", "IDLE", "no answer");
  scene.judge.expect(seen.find_first_not_of("iS") == std::string::npos, "symbols_leak", "nothing but IDLE",
                     seen);
}

TranslatorStep power_failure() {
  return does("the supply fails and comes again", [](TranslatorScene& scene) {
    scene.bench.set_power(false);
    scene.rest();
    scene.bench.set_power(true);
    scene.bench.clear();
  });
}

void request_jabber(TranslatorScene& scene) {
  scene.request(std::string(kJabberSymbols + 2'000, 'P'));
}

void expect_jabber_ends(TranslatorScene& scene) {
  scene.bench.settle();
  const std::size_t bits = scene.sent().size();
  constexpr std::size_t kMargin = 2'000;
  scene.judge.expect(bits > 0 && bits < 2 * std::size_t{kJabberSymbols} + kMargin, "jabbers",
                     fmt::format("{} symbols at most", kJabberSymbols), fmt::format("{} bits", bits));
}

std::vector<TranslatorCase> command_cases() {
  return {
      on_chart(
          translator_must("management/commands_are_answered", "PST-13",
                          "RESET, DISABLE LOOPBACK and ENABLE TRANSMITTER are acknowledged, in any "
                          "order; no command is answered with IDLE, and serial data, which this "
                          "physical layer has not, with NACK.",
                          memory("answers of the management mode"),
                          {{"reset_not_acknowledged", "answer_wrong"},
                           {"idle_acknowledged", "answer_wrong"},
                           {"serial_data_acknowledged", "answer_wrong"},
                           {"answers_late", "answer_wrong"}}),
          {{2, 10},
           {answers(reset, 'a', "answer_wrong"), answers(disable_loopback, 'a', "answer_wrong"),
            answers(enable_transmitter, 'a', "answer_wrong"), answers(idle, 'i', "answer_wrong"),
            answers(serial_data, 'n', "answer_wrong"), answers(enable_transmitter, 'a', "answer_wrong"),
            answers(disable_loopback, 'a', "answer_wrong"), answers(reset, 'a', "answer_wrong"), pause()}}),
      on_chart(translator_must("management/the_transmitter_waits_for_its_command", "PST-13",
                               "Nothing is sent before ENABLE TRANSMITTER: neither after the supply has "
                               "come, nor after RESET, nor after DISABLE LOOPBACK.",
                               own("what the commands do"),
                               {{"transmitter_on_from_the_start", "sends_unasked"},
                                {"reset_enables_transmitter", "sends_unasked"},
                                {"enable_does_nothing", "enabled_and_silent"}}),
               {{2, 10},
                {frame_requested(), nothing_sent("sends_unasked", "nobody has enabled the transmitter"),
                 commanded(reset), frame_requested(),
                 nothing_sent("sends_unasked", "RESET enables no transmitter"), commanded(disable_loopback),
                 frame_requested(), nothing_sent("sends_unasked", "the transmitter is still off"),
                 commanded(enable_transmitter), frame_requested(), is_sent("enabled_and_silent"), pause(),
                 commanded(reset)}}),
      on_chart(translator_must("management/loopback_works_until_it_is_disabled", "PST-13",
                               "After RESET what is requested is indicated, and what comes from the line "
                               "is not; after DISABLE LOOPBACK it is the other way round.",
                               own("what the commands do"),
                               {{"no_loopback_after_reset", "not_looped_back"},
                                {"line_leaks_into_loopback", "line_indicated"},
                                {"loopback_never_disabled", "looped_back_on_line"}}),
               {{2, 10},
                {commanded(reset), pause(), frame_requested(), is_looped_back("not_looped_back"), pause(),
                 frame_received(), nothing_indicated("line_indicated", "the receiver is looped back"),
                 pause(), commanded(disable_loopback), pause(), frame_requested(),
                 nothing_indicated("looped_back_on_line", "nothing comes from the line"), receives()}}),
      on_chart(translator_must("management/reset_takes_it_off_the_line", "PST-13",
                               "RESET ends what ENABLE TRANSMITTER and DISABLE LOOPBACK have begun.",
                               own("what the commands do"),
                               {{"reset_keeps_the_transmitter", "sends_after_reset"},
                                {"reset_enables_transmitter", "sends_after_reset"}}),
               {{2, 10},
                {on_line(), commanded(reset), frame_requested(),
                 nothing_sent("sends_after_reset", "RESET has switched the transmitter off"), pause()}}),
  };
}

std::vector<TranslatorCase> mode_cases() {
  return {
      on_chart(
          translator_must("management/no_symbol_leaks", "PST-14",
                          "In management mode no symbol of the line is indicated, whatever comes from "
                          "there; after END PHYSICAL it is.",
                          paper("INMUX: indications of the mode"),
                          {{"symbols_leak", "symbols_leak"}, {"stays_in_management", "does_not_recover"}}),
          {{3, 30},
           {does("a frame comes from the line in management mode", receive_under_management),
            requires_that("nothing but answers is indicated", expect_answers_only), receives()},
           {on_line()}}),
      on_chart(translator_must("management/commands_are_not_sent", "",
                               "In management mode nothing goes out: a command is no symbol.",
                               paper("two modes"), {{"commands_are_sent", "sends_commands"}}),
               {{2, 10},
                {commanded(idle),
                 does("SM idle again",
                      [](TranslatorScene& scene) {
                        scene.bench.clear();
                        scene.bench.command(idle, 64);
                      }),
                 nothing_sent("sends_commands", "a command is no symbol"), frame_requested(),
                 is_sent("does_not_recover"), pause()},
                {on_line()}}),
      on_chart(
          translator_must("management/power_failure_takes_it_off_the_line", "",
                          "When the supply has failed the translator is as after RESET.",
                          own("state after power-up"), {{"remembers_over_power_failure", "sends_unasked"}}),
          {{2, 10},
           {on_line(), power_failure(), frame_requested(),
            nothing_sent("sends_unasked", "nobody has enabled the transmitter since"), pause()}}),
      on_chart(
          translator_must("management/jabber_ends", "",
                          "A transmission that does not end is cut off; the transmitter stays off, and "
                          "says so, until RESET.",
                          memory("jabber inhibit and physical error"),
                          {{"jabbers_for_ever", "jabbers"},
                           {"jabber_is_not_reported", "answer_wrong"},
                           {"jabber_outlives_reset", "answer_wrong"}}),
          {{1, 2},
           {on_line(), does("66000 + 2000 symbols of pad_idle are requested", request_jabber),
            requires_that("it is cut off", expect_jabber_ends), pause(), frame_requested(),
            nothing_sent("sends_after_jabber", "it is off until RESET"), answers(idle, 'e', "answer_wrong"),
            answers(enable_transmitter, 'n', "answer_wrong"), answers(reset, 'a', "answer_wrong"),
            answers(disable_loopback, 'a', "answer_wrong"), answers(enable_transmitter, 'a', "answer_wrong"),
            pause(), frame_requested(), is_sent("does_not_recover"), pause()}},
          with_short_jabber()),
  };
}

}  // namespace

std::vector<TranslatorCase> translator_management_cases() {
  std::vector<TranslatorCase> all = command_cases();
  for (TranslatorCase& one : mode_cases()) all.push_back(std::move(one));
  return all;
}

}  // namespace fieldproof::conformance
