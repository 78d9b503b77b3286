#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"
#include "harness/line/frame_check.hpp"

// Each kind of datum, each unknown control code, each pair of errors, each length of a frame and of a
// preamble.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::derived;
using token_sources::mib;
using token_sources::own;
using token_sources::standard;

constexpr unsigned kDataActions = 3;
constexpr unsigned kDataPriorities = 8;

// 01 MMM PPP in the order of the line, each part with its highest bit first.
std::uint8_t control_of_data(unsigned action, unsigned priority) {
  return static_cast<std::uint8_t>(2U | line::reflect(action, 3) << 2U | line::reflect(priority, 3) << 5U);
}

TokenStep each_datum_twice() {
  return {
      "000E sends data, requests with response and responses to the station, of each priority, each twice",
      "each is delivered", [](TokenScene& scene) {
        for (unsigned n = 0; n < 2 * kDataActions * kDataPriorities; ++n) {
          const unsigned action = n / 2 / kDataPriorities;
          const unsigned priority = n / 2 % kDataPriorities;
          scene.bench.wait(scene.bench.octets(8));
          scene.send(scene.bench.data_frame(control_of_data(action, priority), kOwnAddress,
                                            TokenBench::kAbove, {1, 2, 3}));
          auto& frames = scene.bench.user().frames;
          const bool is_delivered =
              frames.size() == 1 && is_reported_as(scene.bench.sent().back(), frames.front());
          scene.judge.expect(is_delivered, "not_delivered", [&] {
            return Mismatch{{scene.bench.sent().back().text() + ", once"},
                            fmt::format("{} data", frames.size())};
          });
          frames.clear();
        }
      }};
}

// What is no token to the station does not make it speak; it listens on.
TokenStep each_unknown_control() {
  return {"000E sends each of the 57 unknown control codes to the station, without data and with an address",
          "silence: they are no frames", [](TokenScene& scene) {
            constexpr std::array<std::uint8_t, 7> kKnown{0x00, 0x80, 0x40, 0xC0, 0x20, 0x10, 0x30};
            for (unsigned code = 0; code < 256; code += 4) {
              if (std::ranges::count(kKnown, code) > 0) continue;
              for (const Octets& data : {Octets{}, Octets{0x0E, 0x00}}) {
                scene.bench.wait(scene.bench.octets(8));
                scene.send(scene.bench.data_frame(static_cast<std::uint8_t>(code), kOwnAddress,
                                                  TokenBench::kAbove, data));
                scene.expect_silence(scene.bench.slots(1), "acts_on_unknown", "its control is unknown");
              }
            }
          }};
}

// ---- errors ----

constexpr unsigned kPairsOfErrors = 5;

// The octets between two delimiters, and in front of the second a part of one.
line::Levels with_errors(const Octets& octets, bool has_part, bool has_error_bit) {
  constexpr std::size_t kDelimiter = 32;
  const line::Levels right = half_bits_around(octets, {.has_error = has_error_bit});
  if (!has_part) return right;
  line::Levels levels = right.slice(0, right.size() - kDelimiter);
  levels.append(0b1001, 4);
  levels.append(right, right.size() - kDelimiter, kDelimiter);
  return levels;
}

line::Levels two_errors(TokenScene& scene) {
  constexpr std::size_t kShort = 20;
  constexpr std::size_t kLong = 220;
  const bool is_long = scene.turn < 2;
  Octets octets = with_crc_32(scene.bench.data_frame(0x62, kOwnAddress, TokenBench::kAbove,
                                                     scene.bench.numbered_data(is_long ? kLong : kShort)));
  const bool has_error_bit = scene.turn % 2 == 0;
  if (!has_error_bit || scene.turn == 4) octets.back() ^= 0x10;
  scene.bench.wait(scene.bench.octets(8));
  return with_errors(octets, scene.turn == 2 || scene.turn == 3, has_error_bit);
}

TokenStep damaged_and_whole() {
  return {
      "000E sends data of 1 octet with a wrong check, then the same as they are; in the next turns of 2 "
      "octets, of 4 and so on up to 4096",
      "the second is delivered, the first is not", [](TokenScene& scene) {
        const Octets data = scene.bench.numbered_data(std::size_t{1} << scene.turn);
        const Octets frame = scene.bench.data_frame(0x62, kOwnAddress, TokenBench::kAbove, data);
        Octets damaged = with_crc_32(frame);
        damaged[damaged.size() / 2] ^= 0x04;
        auto& frames = scene.bench.user().frames;
        scene.bench.wait(scene.bench.octets(8));
        scene.since = scene.bench.send_half_bits(half_bits_around(damaged));
        scene.judge.expect(frames.empty(), "acts_on_wrong_check", "no data", "data");
        scene.bench.wait(scene.bench.octets(8));
        scene.send(frame);
        scene.judge.expect(frames.size() == 1 && frames.front().data == data, "not_delivered",
                           fmt::format("{} octets of data", data.size()), "others, or none");
        frames.clear();
      }};
}

TokenStep each_preamble() {
  return {"000E sends data after a preamble of 4 octets; in the next turns of each number up to 32",
          "they are delivered", [](TokenScene& scene) {
            scene.bench.wait(scene.bench.octets(8));
            scene.send(scene.bench.data_frame(0x62, kOwnAddress, TokenBench::kAbove, {1, 2, 3}),
                       {.preamble_octets = 4 + scene.turn});
            auto& frames = scene.bench.user().frames;
            scene.judge.expect(frames.size() == 1, "not_delivered",
                               fmt::format("data after {} octets of preamble", 4 + scene.turn), "none");
            frames.clear();
          }};
}

TokenStep token_and_a_burst() {
  return stimulus<TokenScene>(
      "000E passes the token to 0004, and an octet duration of noise ends within the blanking after it",
      [](TokenScene& scene) {
        scene.send(scene.bench.frame(TokenControl::token, TokenBench::kBelow, TokenBench::kAbove));
        scene.bench.wait(scene.bench.octets(2));
        scene.bench.send_noise(1);
      });
}

}  // namespace

std::vector<TokenCase> token_kind_cases() {
  return {
      on_chart(token_must("kinds/each_datum_is_delivered", "TB-33",
                          "Data for the station are reported to its user, whatever their kind and priority, "
                          "though they are those of before, whether it is in the ring or not.",
                          standard("data frames"),
                          {{"data_of_members_only", "not_delivered"},
                           {"unasked_response_kept", "not_delivered"},
                           {"equal_data_once", "not_delivered"}}),
               {{}, {each_datum_twice(), joined(), each_datum_twice(), wait(8), serves()}}),
      on_chart(token_must("kinds/unknown_control_codes_are_left", "TB-33",
                          "A frame of an unknown control code is none, whatever it shares with a known one.",
                          standard("frame control"), {{"low_control_bits_only", "acts_on_unknown"}}),
               {{}, {joined(), each_unknown_control(), wait(8), serves()}}),
      on_chart(
          token_must("kinds/of_two_errors_the_first_counts", "TB-34",
                     "Of two errors of one reception that counts which comes first: a fragment, a frame "
                     "too long, an E bit, a wrong check.",
                     own("errors of reception"), {{"length_looked_at_last", "counter_wrong"}}),
          {{},
           {joined(),
            repeat({kPairsOfErrors, kPairsOfErrors},
                   {drive("a frame too long whose E bit is set; in the next turns one too "
                          "long with a wrong check, one with a part of an octet whose E bit is "
                          "set, one with a part of an octet and a wrong check, one with an E "
                          "bit and a wrong check",
                          two_errors)}),
            counted("frames too long", kTooLong, 2), counted("fragments", kFragment, 2),
            counted("E bit errors", kEBitError, 1), counted("FCS errors", kFcsError, 0), wait(8), serves()}},
          with([](token_bus::Rules& rules) { rules.most_octets = 200; })),
      on_chart(
          token_must("kinds/damaged_frames_of_all_lengths", "TB-31",
                     "The check is looked at whatever the length of a frame.", mib("FCS errors"),
                     {{"long_frames_unchecked", "acts_on_wrong_check"}}),
          {{}, {joined(), repeat({13, 13}, {damaged_and_whole()}), counted("FCS errors", kFcsError, 13)}}),
      on_chart(token_must("kinds/preambles_of_all_lengths", "TB-32",
                          "A frame is received after a preamble of each length that may be set.",
                          derived("preamble"), {{"long_preambles_lost", "not_delivered"}}),
               {{}, {wait(10), repeat({29, 29}, {each_preamble()}), joined()}},
               with([](token_bus::Rules& rules) { rules.preamble_octets = 32; })),
      on_chart(token_must("kinds/what_is_blanked_was_silence", "TB-34",
                          "What ends while the receiver is blanked was silence: the bus is idle from the "
                          "transmission before on.",
                          own("blanking"), {{"blanked_puts_off_the_claim", "begins_too_late"}}),
               {{},
                {wait(10), token_and_a_burst(),
                 says("the first claim after seven slot times", {TokenControl::claim}, after_slots(7),
                      "claim_missing", "claim_wrong")}}),
  };
}

}  // namespace fieldproof::conformance
