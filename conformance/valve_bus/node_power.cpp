#include <fmt/format.h>

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// Power, and a host that is gone.
namespace fieldproof::conformance {
namespace {

void without_a_host_the_valves_hold(NodeBench& bench, CaseJudge& judge) {
  bench.require(&iut::Capabilities::process_side);
  bench.write(0x5A, 0xA5);
  bench.await_response_window();
  bench.clear_observations();
  const kernel::Duration limit = bench.rules().loss_limit;
  if (limit > kernel::Duration{}) {
    bench.wait(limit - limit / 10);
    expect_no_valve_moved(bench, judge, "valves_let_go",
                          fmt::format("the host may be silent for {}", kernel::describe(limit)));
    bench.wait(limit / 5);
    expect_valves(bench, judge, 0, "valves_hold_without_host");
  } else {
    bench.wait(10 * kernel::kSecond);
    expect_no_valve_moved(bench, judge, "valves_let_go", "they hold while the host is silent");
  }
  expect_silence(bench, judge, "drives_without_being_asked", "nobody asked it");
  bench.clear_observations();
  expect_serves(bench, judge);
}

void power_up_is_safe(NodeBench& bench, CaseJudge& judge) {
  bench.set_power(true);
  bench.wait(200 * kernel::kMillisecond);
  expect_no_valve_moved(bench, judge, "valve_set_at_power_up", "no write has come");
  expect_silence(bench, judge, "speaks_at_power_up", "nobody asked it");
  expect_serves(bench, judge);
}

void power_lost_in_a_frame(NodeBench& bench, CaseJudge& judge) {
  for (std::size_t at = 0; at <= valve_bus::kCommandOctets; ++at) {
    bench.write(0xFF, 0xFF);
    bench.await_response_window();
    bench.clear_observations();
    const auto frame = octets_of(valve_bus::Command{bench.address(), 0, 0x0F, 0xF0});
    bench.send(std::span(frame).first(at));
    bench.set_power(false);
    bench.wait(bench.delimiter() / 2);
    expect_silence(bench, judge, "speaks_without_power", "it has no supply");
    bench.clear_observations();
    bench.set_power(true);
    bench.send(std::span(frame).subspan(at));
    bench.await_response_window();
    expect_valves(bench, judge, at == 0 ? bench.valves_of(0x0F, 0xF0) : 0, "remembers_over_power_loss");
    const bool is_acknowledged = at == 0 && bench.rules().answers_writes;
    if (!is_acknowledged) expect_silence(bench, judge, "speaks_at_power_up", "nobody asked it");
    bench.clear_observations();
    expect_serves(bench, judge);
  }
}

}  // namespace

std::vector<NodeCase> node_power_cases() {
  const auto with_switched_power =
      for_node_with("power_can_be_switched", "the bench cannot switch the supply of the node");
  std::vector<NodeCase> cases;
  cases.push_back({{.id = "valve_bus/node/power/valves_hold_without_a_host",
                    .purpose = "RN-32",
                    .requirement = "When the host falls silent the valves hold; a node that declares so "
                                   "switches them off after 500 ms.",
                    .reference = valve_sources::own("loss of the host: literally, nothing changes"),
                    .stimulus = "A write, then 10 s of silence.",
                    .expected = "The valves hold, or go off as declared; then the node serves.",
                    .tags = {"must"},
                    .catches = {{"lets_go_after_5_s", "valves_let_go"}}},
                   without_a_host_the_valves_hold});
  cases.push_back({{.id = "valve_bus/node/power/power_up_is_safe",
                    .purpose = "RN-33",
                    .requirement = "From power-up to the first valid write all valves are off, and the node "
                                   "does not drive the line.",
                    .reference = valve_sources::own("safe state after power-up"),
                    .stimulus = "Power is switched on; 200 ms of silence.",
                    .expected = "No valve moves and nothing is said; then the node serves.",
                    .tags = {"must"},
                    .catches = {{"valves_set_at_power_up", "valve_set_at_power_up"},
                                {"speaks_at_power_up", "speaks_at_power_up"}},
                    .not_applicable = with_switched_power},
                   power_up_is_safe,
                   {.is_powered = false}});
  cases.push_back({{.id = "valve_bus/node/power/power_lost_in_a_frame",
                    .purpose = "RN-34",
                    .requirement = "A loss of power in the middle of a frame is a power-up: the rest of the "
                                   "frame is none, and the valves are off.",
                    .reference = valve_sources::own("safe state after power-up"),
                    .stimulus = "Power goes and comes after each octet of a write.",
                    .expected = "The valves stay off, nothing is said; then the node serves.",
                    .tags = {"must"},
                    .catches = {{"keeps_octets_over_power_loss", "remembers_over_power_loss"},
                                {"keeps_valves_over_power_loss", "remembers_over_power_loss"}},
                    .not_applicable = with_switched_power},
                   power_lost_in_a_frame});
  return cases;
}

}  // namespace fieldproof::conformance
