#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_expect.hpp"

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

void expect_bit_rate(HostBench& bench, CaseJudge& judge, unsigned dip, std::string_view reason) {
  const auto wanted = static_cast<double>(valve_bus::dip_bit_rates()[dip]);
  bench.order(changing_write(bench));
  const auto frame = bench.next_frame(bench.observation_timeout());
  judge.expect(frame.has_value(), "no_request", "the write is sent", "nothing was sent");
  judge.expect_between(fmt::format("bit rate at position {}", dip), "bit/s", measured_bit_rate(bench),
                       wanted * 0.995, wanted * 1.005, reason);
  bench.note_write(changing_write(bench));
}

void each_position_is_a_bit_rate(HostBench& bench, CaseJudge& judge) {
  for (unsigned dip = 0; dip < valve_bus::dip_bit_rates().size(); ++dip) {
    bench.restart(dip);
    expect_bit_rate(bench, judge, dip, "bit_rate_wrong");
    expect_read_served(bench, judge, bench.random_id());
  }
}

void switches_are_read_at_power_up(HostBench& bench, CaseJudge& judge) {
  bench.restart(1);
  for (const unsigned turned_to : {2U, 0U, 5U}) {
    bench.set_dip(turned_to);
    expect_bit_rate(bench, judge, 1, "dip_effective_at_once");
    expect_read_served(bench, judge, bench.random_id());
  }
  bench.restart(2);
  expect_bit_rate(bench, judge, 2, "dip_not_read_at_power_up");
}

}  // namespace

std::vector<HostCase> host_dip_cases() {
  const auto with_switches = [](const judge::Pics& pics) {
    const auto why_not = for_plain_writes()(pics);
    return why_not ? why_not
                   : for_host_with("dip_can_be_set", "the bench cannot turn the host's DIP switches")(pics);
  };
  std::vector<HostCase> cases;
  cases.push_back(
      {{.id = "valve_bus/host/dip/each_position_is_a_bit_rate",
        .purpose = "RH-25",
        .requirement = "Each position of the DIP switches is a bit rate of the table, within "
                       "0.5 %.",
        .reference = valve_sources::own("what timers at 12 MHz make"),
        .stimulus = "A write of alternating bits and a read at each position.",
        .expected = "The bit rate of the table; the read is served.",
        .tags = {"must", "timing"},
        .catches = {{"dip_off_by_one", "bit_rate_wrong"}, {"clock_off_by_one_percent", "bit_rate_wrong"}},
        .not_applicable = with_switches},
       each_position_is_a_bit_rate});
  cases.push_back({{.id = "valve_bus/host/dip/switches_are_read_at_power_up",
                    .purpose = "RH-26",
                    .requirement = "DIP switches that are turned in operation have an effect after the next "
                                   "power-up only.",
                    .reference = valve_sources::own("switches are read at power-up"),
                    .stimulus = "The switches are turned, a write and a read; then power goes and comes.",
                    .expected = "The bit rate stays as it was, and is the new one after power-up.",
                    .tags = {"must"},
                    .catches = {{"dip_read_in_operation", "dip_effective_at_once"}},
                    .not_applicable = with_switches},
                   switches_are_read_at_power_up});
  return cases;
}

}  // namespace fieldproof::conformance
