#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "conformance/valve_bus/host_scene.hpp"

// A PC that goes on while the host is at something, and the options of a host together.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::Response;

// An octet of the next read in each character of the first one.
void write_during_a_request(HostScene& scene) {
  HostBench& bench = scene.bench;
  scene.order(bench.read_of(scene.id, 0x33, 0x55));
  bench.await(bench.observation_timeout());
  bench.wait(bench.characters(0.5));
  for (const std::uint8_t octet : octets_for(bench.read_of(scene.other))) {
    bench.write({octet});
    bench.wait(bench.characters(1));
  }
}

void write_during_the_time_out(HostScene& scene) {
  HostBench& bench = scene.bench;
  bench.wait(scene.request.end + bench.time_out() * 2 / 3 - bench.now());
  bench.order(bench.read_of(scene.other));
}

HostStep other_is_next() {
  return {"the other node answers its read", "it is sent next, and the PC gets the data",
          [](HostScene& scene) {
            expect_request(scene.bench, scene.judge, scene.bench.read_of(scene.other));
            const Response response = scene.bench.random_response();
            scene.bench.answer(response);
            expect_response(scene.bench, scene.judge, scene.other, response);
          }};
}

// In the ring the last of these stands where the read stood.
void fill_during_the_time_out(HostScene& scene) {
  HostBench& bench = scene.bench;
  std::vector<std::uint8_t> octets;
  while (octets.size() < bench.rules().fifo_octets) {
    const auto other = octets_for(bench.read_of(scene.other, 0xEE, 0xDD));
    octets.insert(octets.end(), other.begin(), other.end());
  }
  bench.write(octets);
}

void order_marked_read(HostScene& scene) {
  scene.order(scene.bench.read_of(scene.id, 0x11, 0x22));
  scene.expect_sent();
}

// ---- options ----

// The read carries what was written; the node has it.
void expect_read_back_of(HostScene& scene, const Command& write) {
  HostBench& bench = scene.bench;
  const Command read = bench.read_of(write.id, write.data0, write.data1);
  expect_request(bench, scene.judge, read, "no_verification");
  bench.answer(Response{write.data0, write.data1});
}

void expect_both_read_back(HostScene& scene) {
  HostBench& bench = scene.bench;
  const std::array writes{Command{7, 0, 0x12, 0x34}, Command{7, 0, 0xED, 0xCB}};
  for (const Command& write : writes) bench.order(write);
  for (const Command& write : writes) {
    expect_request(bench, scene.judge, write, "no_request");
    expect_read_back_of(scene, write);
  }
  expect_nothing_told(bench, scene.judge, 2 * bench.time_out(), "right_readback_told",
                      "each time the node had what had been sent to it");
}

void acknowledge_and_expect_read_back(HostScene& scene) {
  HostBench& bench = scene.bench;
  bench.answer(Response{scene.command.data0, scene.command.data1});
  expect_read_back_of(scene, scene.command);
  expect_nothing_told(bench, scene.judge, bench.time_out(), "right_readback_told",
                      "the node has what was written");
}

std::vector<HostCase> cases_of_a_pc_that_goes_on() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("the PC writes at any time");
  return {
      on_chart(
          {.id = "valve_bus/host/meanwhile/request_goes_on",
           .purpose = "RH-19",
           .requirement = "What the PC writes during a request does not part its characters.",
           .reference = own,
           .tags = {"must", "timing"},
           .catches = {{"pc_delays_characters", "gap_in_frame"}}},
          {{3, 60},
           {stimulus("the PC orders a read, and writes an octet of another one in each of its characters",
                     write_during_a_request),
            expected("the read is sent with at most 1.5 characters between its octets",
                     [](HostScene& scene) { scene.expect_sent(); }),
            response(), reported(), other_is_next()}}),
      on_chart({.id = "valve_bus/host/meanwhile/time_out_goes_on",
                .purpose = "RH-08",
                .requirement = "What the PC writes during a time-out does not prolong it.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"pc_restarts_time_out", "time_out_too_long"}}},
               {{3, 60},
                {read(),
                 {"no node answers, and the PC orders a read of another node at two thirds of the time-out",
                  "the first one is polled again after its time-out, within 5 %",
                  [](HostScene& scene) {
                    write_during_the_time_out(scene);
                    expect_retry_in_time(scene.bench, scene.judge, scene.request, scene.request.end);
                  }},
                 response(),
                 reported(),
                 other_is_next()}}),
      on_chart(
          {.id = "valve_bus/host/meanwhile/repetition_is_of_the_read",
           .purpose = "RH-23",
           .requirement = "A read is repeated as it was ordered, whatever has been written to the FIFO "
                          "since.",
           .reference = own,
           .tags = {"must", "timing"},
           .catches = {{"repeats_from_the_ring", "request_wrong"}},
           .not_applicable = for_switched_power()},
          {{1, 10},
           {power_cycled(),
            {"the PC orders a read with the data 11 22", "the host sends it", order_marked_read},
            stimulus("no node answers, and the PC fills the FIFO with 512 octets", fill_during_the_time_out),
            polled_again(),
            polled_again(),
            power_cycled()}}),
  };
}

}  // namespace

std::vector<HostCase> host_meanwhile_cases() {
  using namespace host_chart;
  auto all = cases_of_a_pc_that_goes_on();
  all.push_back(on_chart(
      {.id = "valve_bus/host/meanwhile/each_write_is_verified_by_itself",
       .purpose = "RH-31",
       .requirement = "With the option, what is read back is compared with the write that was sent, "
                      "not with one that still waits.",
       .reference = valve_sources::own("verification by a read"),
       .tags = {"must", "option"},
       .catches = {{"verified_against_newest", "right_readback_told"}},
       .not_applicable = for_both(for_switched_power(), for_quick_frames(10))},
      {{1, 10},
       {power_cycled(),
        {"the PC orders two writes of other data to a node at once, which has the first and then the "
         "second when it is read",
         "each is read back, and nothing is reported", expect_both_read_back}}},
      {.acknowledged_writes = false, .verifies_writes = true}));
  all.push_back(
      on_chart({.id = "valve_bus/host/meanwhile/acknowledged_write_is_verified",
                .purpose = "RH-31",
                .requirement = "With both options, a write that was acknowledged is read back, too.",
                .reference = valve_sources::own("verification by a read"),
                .tags = {"must", "option"},
                .catches = {{"acknowledged_not_verified", "no_verification"}},
                .not_applicable = for_both(for_switched_power(), for_quick_frames(10))},
               {{2, 20},
                {power_cycled(),
                 write(),
                 {"the node acknowledges it, and has what was written when it is read",
                  "the host reads the node, and nothing is reported", acknowledge_and_expect_read_back}}},
               {.acknowledged_writes = true, .verifies_writes = true}));
  return all;
}

}  // namespace fieldproof::conformance
