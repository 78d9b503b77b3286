#include <fmt/format.h>

#include <algorithm>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// The thousandth of each, and what is drawn.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::mib;
using token_sources::standard;

constexpr unsigned kFaultsOfEach = 300;

TokenStep a_visit_with_data() {
  return {"the user submits a datum, 000E passes the token to the station, and 0004 sends it data later",
          "the datum, then the token; what came is delivered", [](TokenScene& scene) {
            const Octets data = scene.bench.numbered_data(8);
            scene.judge.expect(scene.bench.submit({.destination = TokenBench::kBelow, .data = data}),
                               "data_refused", "the datum is accepted", "it was refused");
            scene.send(scene.bench.frame(TokenControl::token, kOwnAddress, TokenBench::kAbove));
            scene.expect_frame({TokenControl{0x62}, TokenBench::kBelow}, scene.at_once(), "the datum",
                               "data_missing", "data_missing");
            scene.judge.expect(scene.answer.data() == data, "data_wrong", "the datum", scene.answer.text());
            scene.expect_frame({TokenControl::token, TokenBench::kBelow}, scene.at_once(),
                               "the token to 0004", "token_missing", "token_wrong");
            scene.bench.wait(scene.bench.octets(8));
            scene.send(scene.bench.data_frame(0x62, kOwnAddress, TokenBench::kBelow, data));
            auto& frames = scene.bench.user().frames;
            scene.judge.expect(frames.size() == 1 && frames.front().data == data, "not_delivered",
                               "the datum of 0004", "another, or none");
            frames.clear();
            scene.take_token();
          }};
}

TokenStep faults_of_each_kind() {
  return stimulus<TokenScene>(
      fmt::format("{} receptions each of noise, of an abort, of a wrong check, of an E bit", kFaultsOfEach),
      [](TokenScene& scene) {
        Octets damaged = with_crc_32(right_token(scene));
        const line::Levels with_error_bit = half_bits_around(damaged, {.has_error = true});
        damaged.back() ^= 0x10;
        const auto drive_one = [&](const line::Levels& levels) {
          scene.bench.wait(scene.bench.octets(8));
          scene.since = scene.bench.send_half_bits(levels);
        };
        for (unsigned n = 0; n < kFaultsOfEach; ++n) {
          drive_one(half_bits_around(damaged));
          drive_one(with_error_bit);
          drive_one(half_bits_around({}));
          scene.bench.wait(scene.bench.octets(8));
          scene.since = scene.bench.send_noise(8);
        }
      });
}

TokenStep windows_differ() {
  return require(
      "windows are not all as many tokens apart",
      [](TokenScene& scene) {
        std::vector<unsigned> tokens;
        for (const DrivenFrame& one : scene.bench.driven()) {
          if (one.is(TokenControl::solicit_1)) tokens.push_back(0);
          if (one.is(TokenControl::token) && !tokens.empty()) ++tokens.back();
        }
        if (!tokens.empty()) tokens.pop_back();  // the last one lasts
        return std::ranges::adjacent_find(tokens, std::ranges::not_equal_to()) != tokens.end();
      },
      "windows_not_drawn");
}

}  // namespace

std::vector<TokenCase> token_many_cases() {
  return {
      on_chart(token_must("many/each_of_a_thousand_tokens_is_used", "TB-06",
                          "Each token is used, each datum is sent, and each one that comes is delivered, "
                          "however many there were.",
                          standard("token pass"),
                          {{"token_1000_lost", "data_missing"}, {"datum_300_lost", "data_missing"}}),
               {{}, {joined(), repeat({1'100, 5'000}, {a_visit_with_data()})}},
               with([](token_bus::Rules& rules) { rules.ring_maintenance_octets = 0; })),
      on_chart(
          token_must("many/errors_are_counted_beyond_an_octet", "TB-34",
                     "Faulty receptions are counted beyond 255.", mib("counters"),
                     {{"counts_in_octets", "counter_wrong"}}),
          {{},
           {joined(), faults_of_each_kind(), counted("non-silence", kNonSilence, kFaultsOfEach),
            counted("fragments", kFragment, kFaultsOfEach), counted("FCS errors", kFcsError, kFaultsOfEach),
            counted("E bit errors", kEBitError, kFaultsOfEach), wait(8), serves()}}),
      on_chart(token_must("many/windows_are_drawn", "TB-11",
                          "The two low bits of the count to the next window are drawn each time.",
                          mib("max_inter_solicit_count"), {{"windows_not_drawn", "windows_not_drawn"}}),
               {{},
                {joined(), repeat({16, 32}, {until_window(), passes_below(after_slots(1)), taken()}),
                 windows_differ()}}),
  };
}

}  // namespace fieldproof::conformance
