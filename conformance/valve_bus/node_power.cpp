#include <algorithm>

#include "conformance/valve_bus/node_scene.hpp"

// Power, and a host that is gone.
namespace fieldproof::conformance {
namespace {

void keep_host_silent(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.require(&iut::Capabilities::process_side);
  bench.clear_observations();
  const kernel::Duration limit = bench.rules().loss_limit;
  if (limit == kernel::Duration{}) {
    bench.wait(10 * kernel::kSecond);
    return;
  }
  bench.wait(limit / 2);
  // Not a sign of life of the host: it is no command.
  scene.frame = scene.moving_write();
  scene.frame.back() ^= 0x01;
  const kernel::Time before = bench.now();
  bench.send(scene.frame);
  bench.wait(std::max(limit - limit / 10 - limit / 2 - (bench.now() - before), kernel::Duration{}));
}

void expect_let_go_as_declared(NodeScene& scene) {
  const kernel::Duration limit = scene.bench.rules().loss_limit;
  if (limit == kernel::Duration{}) return;
  scene.bench.wait(limit / 5);
  expect_valves(scene.bench, scene.judge, 0, "valves_hold_without_host");
}

void power_up(NodeScene& scene) {
  scene.bench.power_up();
  scene.bench.wait(200 * kernel::kMillisecond);
}

void power_anew(NodeScene& scene) {
  scene.bench.set_power(false);
  scene.bench.wait(kernel::kMillisecond);
  scene.bench.power_up();
  scene.bench.clear_observations();
}

void lose_power(NodeScene& scene) {
  scene.bench.clear_observations();
  scene.frame = scene.write(0x0F, 0xF0);
  scene.bench.send(std::span(scene.frame).first(scene.round));
  scene.bench.set_power(false);
  scene.bench.wait(scene.bench.delimiter() / 2);
}

void return_power(NodeScene& scene) {
  scene.bench.clear_observations();
  scene.bench.power_up();
  scene.bench.send(std::span(scene.frame).subspan(scene.round));
  scene.bench.await_response_window();
}

// In front of its answer: at once, or when it is sure of the read. One that answers then has answered.
void lose_power_after_a_read(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.clear_observations();
  // As long as it took for its last answer, but for a microsecond.
  const kernel::Duration took = scene.answer.driver_on - scene.end;
  bench.read();
  const kernel::Duration sure = bench.delimiter() + character_notice(bench.rules()) + kernel::kMicrosecond;
  if (scene.round % 2 == 1) bench.wait(std::max(sure, took - kernel::kMicrosecond));
  if (bench.has_driven()) bench.await_response_window();
  bench.set_power(false);
  bench.wait(bench.delimiter());
  bench.clear_observations();
}

// Within its answer, when an octet or more of it is out.
void lose_power_in_an_answer(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.clear_observations();
  const kernel::Time latest = bench.read() + bench.delimiter() + turnaround_time_span(bench.rules());
  while (!bench.has_driven() && bench.now() < latest) bench.wait(bench.bits(1));
  bench.wait(bench.characters(1 + scene.round % 2));
  bench.set_power(false);
  bench.wait(10 * kernel::kMillisecond);
  bench.power_up();
  bench.clear_observations();
}

void send_without_power(NodeScene& scene) {
  for (unsigned n = 0; n < 2; ++n) {
    scene.bench.send(scene.write(0x0F, 0xF0));
    scene.bench.await_response_window();
  }
  scene.bench.read();
  scene.bench.await_response_window();
}

// The whole write came after power, when none of it came before.
void expect_power_up(NodeScene& scene) {
  const bool is_whole = scene.round == 0;
  expect_valves(scene.bench, scene.judge, is_whole ? scene.valves() : std::uint16_t{0},
                "remembers_over_power_loss");
  if (is_whole && scene.bench.rules().answers_writes) return;
  expect_silence(scene.bench, scene.judge, "speaks_at_power_up", "nobody asked it");
}

}  // namespace

std::vector<NodeCase> node_power_cases() {
  const auto with_switched_power = for_item("power_can_be_switched", true, declared_node(),
                                            "the bench cannot switch the supply of the node");
  using namespace node_chart;
  constexpr unsigned kCommandPlaces = valve_bus::kCommandOctets + 1;
  return {
      on_chart({.id = "valve_bus/node/power/valves_hold_without_a_host",
                .purpose = "RN-32",
                .requirement = "When the host falls silent the valves hold; a node that declares so "
                               "switches them off after 500 ms.",
                .reference = valve_sources::own("loss of the host: literally, nothing changes"),
                .tags = {"must"},
                .catches = {{"lets_go_after_5_s", "valves_let_go"}}},
               {{1, 1},
                {valves_on(),
                 stimulus("10 s of silence; with a declared time 0.9 times that, with a wrong frame in it",
                          keep_host_silent),
                 no_valve_moved("valves_let_go", "they hold while the host is silent"),
                 expected("at 1.1 times a declared time they are off", expect_let_go_as_declared),
                 silent("drives_without_being_asked", "nobody asked it"), serves()}}),
      on_chart({.id = "valve_bus/node/power/power_up_is_safe",
                .purpose = "RN-33",
                .requirement = "From power-up to the first valid write all valves are off, and the node "
                               "does not drive the line.",
                .reference = valve_sources::own("safe state after power-up"),
                .tags = {"must"},
                .catches = {{"valves_set_at_power_up", "valve_set_at_power_up"},
                            {"speaks_at_power_up", "speaks_at_power_up"}},
                .not_applicable = with_switched_power},
               {{1, 1},
                {stimulus("power is switched on; 200 ms of silence", power_up),
                 no_valve_moved("valve_set_at_power_up", "no write has come"),
                 silent("speaks_at_power_up", "nobody asked it"), serves()}},
               {.is_powered = false}),
      on_chart(
          {.id = "valve_bus/node/power/nothing_is_done_without_it",
           .purpose = "RN-44",
           .requirement =
               "Without supply a node does nothing, and after power-up nothing of what came before.",
           .reference = valve_sources::own("safe state after power-up"),
           .tags = {"must"},
           .catches = {{"works_without_supply", "implementation_asks_the_impossible"},
                       {"speaks_at_power_up", "speaks_at_power_up"}},
           .not_applicable = with_switched_power},
          {{2, 10},
           {read(), answered(), stimulus("a read, and power goes before its answer", lose_power_after_a_read),
            stimulus("two writes and a read", send_without_power),
            ignored("acts_without_power", "it has no supply"),
            stimulus("power comes; 200 ms of silence", power_up),
            no_valve_moved("remembers_over_power_loss", "no write has come since"),
            silent("speaks_at_power_up", "nobody asked it"), serves()}}),
      on_chart(
          {.id = "valve_bus/node/power/settings_hold_after_each_power_up",
           .purpose = "RN-33",
           .requirement = "What a node is set to holds after each power-up.",
           .reference = valve_sources::own("what of a node can be set"),
           .tags = {"must"},
           .catches = {{"answers_writes_once", "no_answer"}},
           .not_applicable = for_both(with_switched_power, for_both(for_answer("answers_writes", true),
                                                                    for_answer("boards", std::int64_t{1})))},
          {{2, 4},
           {stimulus("power goes and comes", power_anew), write(), taken(), read(), answered(), serves()}},
          {.boards = 1, .answers_writes = true}),
      on_chart({.id = "valve_bus/node/power/power_lost_in_an_answer",
                .purpose = "RN-34",
                .requirement = "A loss of power in the middle of an answer is a power-up: the node receives, "
                               "and serves.",
                .reference = valve_sources::own("safe state after power-up"),
                .tags = {"must"},
                .catches = {{"deaf_after_power_lost_in_an_answer", "does_not_recover"}},
                .not_applicable = with_switched_power},
               {{2, 10},
                {stimulus("a read; within its answer power goes, and comes again", lose_power_in_an_answer),
                 serves()}}),
      on_chart(
          {.id = "valve_bus/node/power/power_lost_in_a_frame",
           .purpose = "RN-34",
           .requirement = "A loss of power in the middle of a frame is a power-up: the rest of the "
                          "frame is none, and the valves are off.",
           .reference = valve_sources::own("safe state after power-up"),
           .tags = {"must"},
           .catches = {{"keeps_octets_over_power_loss", "remembers_over_power_loss"},
                       {"keeps_valves_over_power_loss", "remembers_over_power_loss"}},
           .not_applicable = with_switched_power},
          {{kCommandPlaces, kCommandPlaces},
           {sent("a write that switches all valves on",
                 [](NodeScene& scene) { return scene.write(0xFF, 0xFF); }),
            stimulus("the first 0 to 5 octets of a write, and power goes", lose_power),
            silent("speaks_without_power", "it has no supply"),
            stimulus("power comes, and the other octets", return_power),
            expected("the valves are off, and no answer, but for a whole write after power", expect_power_up),
            serves()}}),
  };
}

}  // namespace fieldproof::conformance
