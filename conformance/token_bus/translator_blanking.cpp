#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// What follows a transmission and is none: bits that a repeater adds, reflections, the test of the
// transceiver.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::memory;
using token_sources::own;
using token_sources::paper;

constexpr std::int64_t kSurelyBlanked = 10;  // symbols after an end delimiter
constexpr std::int64_t kSurelyOver = 33;
constexpr unsigned kMostDribble = 7;
constexpr std::string_view kEcho = "101010101010101010101010";

void receive_with_echo(TranslatorScene& scene, std::int64_t symbols, bool more_follows = false) {
  scene.requested = frame_text(scene.octets, more_follows);
  scene.receive(encoded(scene.requested));
  scene.bench.wait(scene.bench.symbols(symbols));
  scene.bench.carry(side_bits_of(kEcho));
}

void expect_frame_alone(TranslatorScene& scene, std::string_view reason) {
  scene.expect_content(scene.requested.substr(scene.requested.find('N')), reason);
}

void expect_echo(TranslatorScene& scene, std::string_view reason) {
  scene.bench.settle();
  const std::string frame = indicated_as(scene.requested);
  const std::string seen = scene.content();
  scene.judge.expect(seen.starts_with(frame.substr(frame.find('N'))) && seen.ends_with("1111"), reason,
                     "the frame, and ones after it", seen);
}

void receive_with_dribble(TranslatorScene& scene) {
  scene.requested = frame_text(scene.octets);
  std::string bits = encoded(scene.requested);
  for (unsigned n = 0; n <= scene.round % kMostDribble; ++n)
    bits += scene.bench.random_octet() % 2 == 0 ? '0' : '1';
  scene.receive(bits);
}

// What IEEE 802.3 has a transceiver do 0.6 to 1.6 us after a transmission, for 5 to 15 bits.
SideBits heartbeat(bool has_carrier) {
  SideBits bits(8, {'I', false, false});
  bits.insert(bits.end(), 14, {'I', has_carrier, true});
  return bits;
}

// Its end, and the delay in front of it, lie within the mask.
std::optional<std::string> has_too_short_a_mask(const judge::Pics& pics) {
  const token_bus::TranslatorConfiguration reference;
  constexpr std::int64_t kHeartbeatSymbols = 11;
  const std::int64_t needed = pics.number("delay_symbols", reference.delay_symbols) + kHeartbeatSymbols;
  if (pics.number("error_mask_symbols", reference.error_mask_symbols) >= needed) return std::nullopt;
  return "error_mask_symbols is shorter than the test of a transceiver";
}

TranslatorCase where(std::optional<std::string> (*not_applicable)(const judge::Pics&), TranslatorCase one) {
  one.test_case.not_applicable = not_applicable;
  return one;
}

// Without an end delimiter: nothing but the end of its own transmission is there to go by.
void send_with_heartbeat(TranslatorScene& scene) {
  scene.request("PPPPPPPPPPPPPPPPPPPPPPPP");
  scene.bench.wait(scene.bench.delay());
  const bool was_sent = !scene.sent().empty();
  scene.judge.expect(was_sent, "nothing_sent", "a preamble", "nothing");
}

void receive_heartbeat(TranslatorScene& scene) {
  scene.bench.clear();
  scene.bench.carry(heartbeat(scene.round % 2 == 1));
}

void receive_collision_while_sending(TranslatorScene& scene) {
  const std::string symbols(64, 'P');
  SideBits bits = side_bits_of(encoded(symbols));
  for (std::size_t n = 40; n < 100; ++n) bits.at(n).has_error = true;
  scene.bench.clear();
  scene.bench.request_and_receive(symbols, bits);
}

void expect_collision(TranslatorScene& scene) {
  scene.bench.settle();
  const std::string& seen = scene.bench.indicated().text();
  scene.judge.expect(seen.find("BBBBBBBB") != std::string::npos, "collision_not_indicated",
                     "bad_signal while the error lasts", seen);
}

}  // namespace

std::vector<TranslatorCase> translator_blanking_cases() {
  return {
      on_chart(
          translator_must("blanking/dribble_bits_cost_no_frame", "PST-10",
                          "One to seven bits after the last end delimiter, as repeaters add them, are "
                          "silence.",
                          own("bits after the end of a transmission"),
                          {{"blanking_absent", "dribble_indicated"}}),
          {{kMostDribble, 10 * kMostDribble},
           {does("a frame with 1 to 7 bits after it", receive_with_dribble),
            requires_that("the frame, and silence",
                          [](TranslatorScene& scene) { expect_frame_alone(scene, "dribble_indicated"); }),
            receives()},
           {on_line()}}),
      on_chart(
          translator_must("blanking/an_echo_is_hidden", "PST-11",
                          "After the end of a transmission the receiver is blanked: ten symbols after "
                          "it, silence is reported; 33 symbols after it, what is there is reported.",
                          paper("receiver blanking"),
                          {{"blanking_absent", "echo_indicated"},
                           {"blanking_of_6_symbols", "echo_indicated"},
                           {"blanking_of_100_symbols", "blanked_too_long"}},
                          {{memory("24 to 32 symbols"), {"echo_indicated", "blanked_too_long"}}}),
          {{2, 20},
           {does("a frame, and 12 symbols that begin ten symbols after it",
                 [](TranslatorScene& scene) { receive_with_echo(scene, kSurelyBlanked); }),
            requires_that("the frame, and silence",
                          [](TranslatorScene& scene) { expect_frame_alone(scene, "echo_indicated"); }),
            pause(),
            does("a frame, and 12 symbols that begin 33 symbols after it",
                 [](TranslatorScene& scene) { receive_with_echo(scene, kSurelyOver); }),
            requires_that("both", [](TranslatorScene& scene) { expect_echo(scene, "blanked_too_long"); }),
            pause()},
           {on_line()}}),
      on_chart(
          translator_must("blanking/none_while_more_follows", "PST-12",
                          "After an end delimiter with I = 1 nothing is blanked.",
                          memory("blanking follows the end of a transmission"),
                          {{"blanks_after_every_frame", "blanked_too_long"}}),
          {{2, 20},
           {does("a frame with I = 1, and 12 symbols that begin ten symbols after it",
                 [](TranslatorScene& scene) { receive_with_echo(scene, kSurelyBlanked, true); }),
            requires_that("both", [](TranslatorScene& scene) { expect_echo(scene, "blanked_too_long"); }),
            pause()},
           {on_line()}}),
      where(has_too_short_a_mask,
            on_chart(
                translator_must("blanking/the_heartbeat_is_silence", "PST-15",
                                "The signal error by which a transceiver tests itself after a transmission "
                                "is silence, with and without carrier.",
                                own("signal errors are masked for 4 us"),
                                {{"heartbeat_indicated", "heartbeat_indicated"}}),
                {{4, 40},
                 {does("a preamble is requested", send_with_heartbeat),
                  does("the test of the transceiver, without and with carrier", receive_heartbeat),
                  requires_that("silence",
                                [](TranslatorScene& scene) {
                                  scene.expect_nothing_indicated("heartbeat_indicated",
                                                                 "it is no signal of the line");
                                }),
                  receives()},
                 {on_line()}})),
      on_chart(translator_must("blanking/a_collision_while_it_sends_is_indicated", "",
                               "A signal error during its own transmission is a collision, and is "
                               "indicated: the MAC has to know of it.",
                               own("errors are masked after a transmission only"),
                               {{"errors_masked_while_it_sends", "collision_not_indicated"},
                                {"deaf_while_it_sends", "collision_not_indicated"}}),
               {{2, 20},
                {does("a preamble is requested, comes back from the line, and collides there",
                      receive_collision_while_sending),
                 requires_that("bad_signal", expect_collision), receives()},
                {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
