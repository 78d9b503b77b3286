#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// Which bit of the line is the first of a pair: the clock slips until the preamble reads as ones.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::derived;
using token_sources::memory;
using token_sources::own;
using token_sources::paper;

constexpr unsigned kMostLost = 15;

void receive_frame(TranslatorScene& scene, const std::vector<std::uint8_t>& octets, std::size_t lost,
                   bool is_late = false) {
  scene.requested = frame_text(octets);
  scene.receive((is_late ? "I" : "") + encoded(scene.requested).substr(lost));
}

TranslatorStep is_received(std::string reason) {
  return requires_that("from the start delimiter on it is indicated as it was sent",
                       [reason = std::move(reason)](TranslatorScene& scene) {
                         scene.expect_content(scene.requested.substr(scene.requested.find('N')), reason);
                       });
}

// Octets whose symbols look like non_data, or like a preamble, when they are read one bit late.
std::vector<std::uint8_t> misleading(unsigned round) {
  constexpr std::array<std::uint8_t, 5> kOctets{0xAA, 0x55, 0x00, 0xFF, 0x0F};
  return std::vector<std::uint8_t>(40, kOctets.at(round % kOctets.size()));
}

}  // namespace

std::vector<TranslatorCase> translator_locking_cases() {
  return {
      on_chart(
          translator_must("locking/both_phases_are_found", "PST-03",
                          "Whether a transmission begins with the first or the second bit of a symbol, its "
                          "start delimiter is found.",
                          paper("the clock slips until the preamble reads as ones"),
                          {{"never_slips", "frame_not_found"},
                           {"slips_by_two_bits", "frame_not_found"},
                           {"slips_once_only", "frame_not_found"}}),
          {{4, 40},
           {does("a frame, with a bit more or less in front of it in turn",
                 [](TranslatorScene& scene) {
                   receive_frame(scene, scene.octets, scene.round % 4 == 1 ? 1 : 0, scene.round % 4 == 3);
                 }),
            is_received("frame_not_found"), pause()},
           {on_line()}}),
      on_chart(
          translator_must("locking/lost_bits_cost_no_frame", "PST-04",
                          "Receivers and repeaters lose bits of the preamble: up to 15 cost no frame.",
                          derived("preamble of a repeater"),
                          {{"never_slips", "frame_not_found"}, {"slips_after_28_zeros", "frame_not_found"}}),
          {{kMostLost, 10 * kMostLost},
           {does("a frame without its first 1 to 15 bits",
                 [](TranslatorScene& scene) {
                   receive_frame(scene, scene.octets, 1 + scene.round % kMostLost);
                 }),
            is_received("frame_not_found"), pause()},
           {on_line()}}),
      on_chart(
          translator_must("locking/each_transmission_is_locked_anew", "",
                          "The phase of a transmission says nothing about that of the next one.",
                          derived("bits that are lost at the begin of a carrier"),
                          {{"keeps_its_phase", "frame_not_found"}, {"slips_once_only", "frame_not_found"}}),
          {{6, 60},
           {does("a frame, and each one in another phase than the last",
                 [](TranslatorScene& scene) { receive_frame(scene, scene.octets, scene.round % 2); }),
            is_received("frame_not_found"),
            does("so short a silence as two stations leave",
                 [](TranslatorScene& scene) { scene.bench.wait(scene.bench.symbols(48)); })},
           {on_line()}}),
      on_chart(translator_must("locking/data_move_no_phase", "PST-06",
                               "After the first non_data the phase stands: data that look like another "
                               "phase move nothing.",
                               derived("pairs across the border of two symbols"),
                               {{"slips_in_data", "symbols_wrong"}}),
               {{10, 50},
                {does("a frame of zeros, ones, and both in turn, in both phases",
                      [](TranslatorScene& scene) {
                        receive_frame(scene, misleading(scene.round / 2), scene.round % 2);
                      }),
                 is_received("symbols_wrong"), pause()},
                {on_line()}}),
      on_chart(translator_must("locking/clocks_may_differ", "PST-18",
                               "A line clock 100 ppm away costs no symbol of the longest frame.",
                               memory("clock tolerance of IEEE 802.3"),
                               {{"loses_a_bit_after_50000", "symbols_wrong"},
                                {"samples_by_its_own_clock", "symbols_wrong"}}),
               {{3, 9},
                {does("a frame of 8191 octets from a clock that is 100 ppm slow, right, 100 ppm fast",
                      [](TranslatorScene& scene) {
                        scene.bench.set_line_clock(100 * (static_cast<int>(scene.round % 3) - 1));
                        receive_frame(scene, scene.bench.random_octets(kLongestFrame), 0);
                        scene.bench.set_line_clock(0);
                      }),
                 is_received("symbols_wrong"), pause()},
                {on_line()}}),
      on_chart(translator_must("locking/begins_in_time", "",
                               "A symbol of the line is indicated within the declared delay.",
                               own("delay of a translator"), {{"slow_receiver", "indicated_too_late"}}),
               {{2, 10},
                {does("a frame", [](TranslatorScene& scene) { receive_frame(scene, scene.octets, 0); }),
                 requires_that("the first non_data is indicated within the delay of its bits",
                               [](TranslatorScene& scene) {
                                 scene.bench.settle();
                                 const std::size_t at = scene.bench.indicated().text().find('N');
                                 scene.judge.expect(at != std::string::npos, "frame_not_found",
                                                    "a start delimiter", "none");
                                 const kernel::Time due =
                                     scene.begin + scene.bench.symbols(32) + scene.bench.delay();
                                 const kernel::Time seen = scene.bench.indicated().time_of(at);
                                 scene.judge.expect(seen <= due + kernel::kNanosecond, "indicated_too_late",
                                                    kernel::describe(due), kernel::describe(seen));
                               }),
                 pause()},
                {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
