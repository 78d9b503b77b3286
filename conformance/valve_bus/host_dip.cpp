#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "conformance/valve_bus/host_scene.hpp"

// The switches that say the bit rate.
namespace fieldproof::conformance {
namespace {

// A write of which all octets but COMMAND are 55h, the check too: nearly each bit is another than the one
// before.
valve_bus::Command changing_write(const HostBench& bench) {
  return {0x55, static_cast<std::uint8_t>(bench.rules().write_command), 0x55, 0x55};
}

// By the distances between the edges of the last frame, most of which are a bit apart.
double measured_bit_rate(const HostBench& bench) {
  std::vector<double> distances;
  for (const line::Waveform& wave : bench.last_waves()) {
    std::size_t edge = 0;
    for (std::size_t at = 0; (at = wave.levels.end_of_run(at)) < wave.levels.size();) {
      if (edge != 0) {
        distances.push_back(static_cast<double>((wave.time_of(at) - wave.time_of(edge)).count()));
      }
      edge = at;
    }
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  return 1e12 / *middle;
}

HostStep bit_rate_of(std::string text, std::function<unsigned(const HostScene&)> dip, std::string reason) {
  return {"the PC orders a write of alternating bits", std::move(text),
          [dip = std::move(dip), reason = std::move(reason)](HostScene& scene) {
            const auto wanted = static_cast<double>(valve_bus::dip_bit_rates()[dip(scene)]);
            scene.bench.order(changing_write(scene.bench));
            const auto frame = scene.bench.next_frame(scene.bench.observation_timeout());
            scene.judge.expect(frame.has_value(), "no_request", "the write is sent", "nothing was sent");
            scene.judge.expect_between(fmt::format("bit rate at position {}", dip(scene)), "bit/s",
                                       measured_bit_rate(scene.bench), wanted * 0.995, wanted * 1.005,
                                       reason);
            scene.bench.note_write(changing_write(scene.bench));
          }};
}

// At power-up, and to what they are turned in operation.
constexpr unsigned kBefore = 1;
unsigned turned_to(const HostScene& scene) {
  constexpr std::array kTurnedTo{2U, 0U, 5U};
  return kTurnedTo.at(scene.round);
}

}  // namespace

std::vector<HostCase> host_dip_cases() {
  using namespace host_chart;
  const auto with_switches = for_both(for_plain_writes(), for_settable_dip());
  return {
      on_chart(
          {.id = "valve_bus/host/dip/each_position_is_a_bit_rate",
           .purpose = "RH-25",
           .requirement = "Each position of the DIP switches is a bit rate of the table, within "
                          "0.5 %.",
           .reference = valve_sources::own("what timers at 12 MHz make"),
           .tags = {"must", "timing"},
           .catches = {{"dip_off_by_one", "bit_rate_wrong"}, {"clock_off_by_one_percent", "bit_rate_wrong"}},
           .not_applicable = with_switches},
          {{dip_positions(), dip_positions()},
           {powered_up_at_each_position(),
            bit_rate_of("it is sent at the bit rate of the table", dip_of, "bit_rate_wrong"),
            served_read()}}),
      on_chart({.id = "valve_bus/host/dip/switches_are_read_at_power_up",
                .purpose = "RH-26",
                .requirement = "DIP switches that are turned in operation have an effect after the next "
                               "power-up only.",
                .reference = valve_sources::own("switches are read at power-up"),
                .tags = {"must"},
                .catches = {{"dip_read_in_operation", "dip_effective_at_once"}},
                .not_applicable = with_switches},
               {{3, 3},
                {stimulus("power goes off and comes at position 1, and the DIP switches are turned",
                          [](HostScene& scene) {
                            scene.bench.restart(kBefore);
                            scene.bench.set_dip(turned_to(scene));
                          }),
                 bit_rate_of(
                     "it is sent at the bit rate of position 1", [](const HostScene&) { return kBefore; },
                     "dip_effective_at_once"),
                 served_read(),
                 stimulus("power goes off and comes",
                          [](HostScene& scene) { scene.bench.restart(turned_to(scene)); }),
                 bit_rate_of("it is sent at the new bit rate", turned_to, "dip_not_read_at_power_up")}}),
  };
}

}  // namespace fieldproof::conformance
