#include <array>

#include "conformance/fieldbus_dll/isa_scene.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"

// Frames on the line: preambles, clocks and jitter that a receiver must take.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

constexpr std::size_t kLongData = 200;

// A DU to the IUT with data that no other has, and its check.
Octets long_du(IsaScene& scene) {
  Octets octets{scene.bench.control(scene.bench.rules().codes.du, Priority::time_available),
                scene.bench.address(), IsaBench::kPeer};
  for (const std::uint8_t octet : scene.fresh(kLongData)) octets.push_back(octet);
  return with_frame_check(octets);
}

IsaCase at_rate(std::int64_t bit_rate, const std::string& name) {
  using namespace isa_chart;
  return on_chart(must_case("fieldbus_dll/isa_dle/line/a_token_is_used_at_" + name, "ISA-01",
                            "All that is counted in octets scales with the bit rate.",
                            link_sources::line("bit rates"), {{"timers_of_31250", "token_not_returned"}}),
                  {{2, 20},
                   {submit({Priority::normal}, 2, 101), et(Priority::normal),
                    used({1}, {"no_data_frame", "more_than_one_frame"})}},
                  {.schedule = {}, .is_scheduler = true, .bit_rate = bit_rate});
}

}  // namespace

std::vector<IsaCase> isa_line_cases() {
  using namespace isa_chart;
  using link_sources::line;
  using link_sources::memory;
  return {
      on_chart(must_case("fieldbus_dll/isa_dle/line/all_preambles_are_taken", "ISA-39",
                         "A frame has 1 to 8 octets of preamble and both delimiters, to the half bit.",
                         line("preamble and delimiters"),
                         {{"wants_one_preamble_octet", "preamble_not_taken"},
                          {"sends_no_preamble", "frame_malformed"},
                          {"end_delimiter_turned", "frame_malformed"},
                          {"least_significant_bit_first", "check_wrong"},
                          {"short_silence", "gap_too_short"}}),
               {{8, 8},
                {drive("a DU with 1 to 8 octets of preamble, in turn",
                       [](IsaScene& scene) { return half_bits_of_frame(long_du(scene), scene.round + 1); }),
                 wait(32), delivered("the frame", "preamble_not_taken"), submit({Priority::normal}, 10),
                 drive("an ET with as many",
                       [](IsaScene& scene) {
                         return half_bits_of_frame(with_frame_check(scene.bench.et(Priority::normal)),
                                                   scene.round + 1);
                       }),
                 says("data, and EE, exact to the half bit, with V(MID) of silence in front",
                      "token_not_returned")}}),
      on_chart(
          must_in_time("fieldbus_dll/isa_dle/line/other_clocks_are_taken", "ISA-40",
                       "A receiver takes frames whose clock is 0.2 % off.",
                       memory("tolerance of the bit rate"), {{"does_not_recover_clock", "clock_not_taken"}}),
          {{3, 30},
           {stimulus<IsaScene>("a DU of 205 octets at 100, 100.2 and 99.8 % of the bit rate, in turn",
                               [](IsaScene& scene) {
                                 constexpr std::array<std::int64_t, 3> kPerMille{1'000, 1'002, 998};
                                 const line::Levels half_bits = half_bits_of_frame(long_du(scene));
                                 scene.bench.send_wave(
                                     clocked(scene.bench, half_bits, kPerMille[scene.round % 3]));
                               }),
            wait(32), delivered("the frame", "clock_not_taken")}}),
      on_chart(must_in_time("fieldbus_dll/isa_dle/line/jitter_is_taken", "ISA-40",
                            "A receiver takes frames whose edges are up to a tenth of a bit off.",
                            memory("jitter at a receiver"), {{"wants_exact_edges", "jitter_not_taken"}}),
               {{3, 50},
                {stimulus<IsaScene>(
                     "a DU of 205 octets, each edge moved by up to a tenth of a bit, at random",
                     [](IsaScene& scene) {
                       scene.bench.send_wave(jittered(scene.bench, half_bits_of_frame(long_du(scene))));
                     }),
                 wait(32), delivered("the frame", "jitter_not_taken")}}),
      at_rate(1'000'000, "1_Mbit_s"),
      at_rate(2'500'000, "2500_kbit_s"),
  };
}

}  // namespace fieldproof::conformance
