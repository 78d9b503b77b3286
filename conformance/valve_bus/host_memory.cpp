#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/valve_bus/host_scene.hpp"

// What one order leaves to the next: nothing but what was read of each node, its counters, and what is
// written to it.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::HostCounters;
using valve_bus::HostErrorKind;
using valve_bus::Response;

// ---- reads with each outcome ----

// One letter for each attempt: (S)ilence, a (W)rong response, a (R)ight one, which ends the read.
constexpr std::array<std::string_view, 14> kOutcomes{"SSS", "R",   "WWW", "SR",  "WWS", "WR",  "SSW",
                                                     "SSR", "SWS", "WWR", "SWW", "SWR", "WSW", "WSS"};

struct ReadNode {
  std::uint8_t id;
  std::optional<Response> known{};
  HostCounters counted{};
};

// Two nodes whose IDs differ in one high bit, which are read in turn.
class Reads {
 public:
  Reads(HostBench& bench, CaseJudge& judge) : bench_(bench), judge_(judge) {
    for (ReadNode& node : nodes_) node.counted = bench.counters(node.id);
  }

  void read(std::string_view outcome) {
    ReadNode& node = nodes_.at(reads_++ % nodes_.size());
    const auto [data0, data1] = bench_.random_response();
    bench_.order(bench_.read_of(node.id, data0, data1));
    HostFrame poll = expect_request(bench_, judge_, bench_.read_of(node.id, data0, data1));
    for (std::size_t attempt = 0; !is_answered(node, outcome[attempt]); ++attempt) {
      if (attempt + 1 == outcome.size()) {
        expect_failed(node, outcome[attempt]);
        break;
      }
      ++node.counted.retries;
      const HostFrame again = expect_retry(bench_, judge_, poll);
      judge_.expect_between("time to the next attempt", "us", in_microseconds(again.start - poll.end),
                            in_microseconds(earliest_repetition(bench_)), in_microseconds(latest_ - poll.end),
                            again.start >= latest_ ? "time_out_too_long" : "time_out_too_short");
      poll = again;
    }
    for (const ReadNode& one : nodes_) expect_counters(one);
  }

 private:
  bool is_answered(ReadNode& node, char what) {
    latest_ = bench_.now() + latest_repetition(bench_);
    if (what == 'S') {
      ++node.counted.timeouts;
      return false;
    }
    Response response = bench_.random_response();
    if (node.known && response == *node.known) response.data0 ^= 0xFF;
    if (what == 'W') {
      ++node.counted.rejected;
      answer_wrongly(node, response);
      return false;
    }
    bench_.answer(response);
    expect_response(bench_, judge_, node.id, response);
    node.known = response;
    last_right_ = response;
    return true;
  }

  void answer_wrongly(const ReadNode& node, const Response& response) {
    const auto right = octets_of(response);
    std::vector<std::uint8_t> octets(right.begin(), right.end());
    // After a right one two octets that its check would make right.
    const unsigned way = last_right_ ? 3 : wrong_++ % 5;
    if (way == 0) octets[2] ^= 0x80;
    if (way == 1) octets[2] ^= node.id;  // as if the ID were in its check
    if (way == 2) octets = {octets[0], octets[1], octets[2], 0};
    if (way == 3) octets.resize(2);
    if (way == 4) octets.resize(1);
    if (last_right_) octets = {last_right_->data0, last_right_->data1};
    last_right_.reset();
    kernel::Time end = bench_.answer(octets, bench_.turnaround_time());
    if (way == 4) end = std::max(end, answer_after_a_fragment(response));
    latest_ = std::max(latest_, end + bench_.delimiter() + 2 * character_notice(bench_.rules()));
  }

  // Both within the time-out: an attempt ends with what came first.
  kernel::Time answer_after_a_fragment(const Response& response) {
    const kernel::Duration later = bench_.turnaround_time() + bench_.characters(8);
    if (later + bench_.characters(9) < bench_.time_out()) return bench_.answer(response, later);
    return bench_.now();
  }

  void expect_failed(const ReadNode& node, char last) {
    const auto kind = last == 'S' ? HostErrorKind::no_response : HostErrorKind::bad_response;
    expect_error(bench_, judge_, {node.id, kind});
    if (node.known) {
      expect_old(bench_, judge_, node.id, *node.known);
    } else {
      expect_nothing_told(bench_, judge_, kernel::kMillisecond, "data_of_silence_told",
                          "nothing was known of the node");
    }
  }

  void expect_counters(const ReadNode& node) {
    const HostCounters counted = bench_.counters(node.id);
    judge_.expect_equal(counted.timeouts, node.counted.timeouts, "counters_wrong",
                        fmt::format("time-outs of {}", node.id));
    judge_.expect_equal(counted.rejected, node.counted.rejected, "counters_wrong",
                        fmt::format("rejected responses of {}", node.id));
    judge_.expect_equal(counted.retries, node.counted.retries, "counters_wrong",
                        fmt::format("retries of {}", node.id));
  }

  HostBench& bench_;
  CaseJudge& judge_;
  std::array<ReadNode, 2> nodes_{ReadNode{9}, ReadNode{9 + 64}};
  unsigned reads_ = 0;
  unsigned wrong_ = 0;
  std::optional<Response> last_right_{};  // where it was the last thing on the line from a node
  kernel::Time latest_{};                 // for the next attempt
};

void read_with_each_outcome(HostBench& bench, CaseJudge& judge) {
  Reads reads(bench, judge);
  const auto count = static_cast<unsigned>(kOutcomes.size());
  for (unsigned n = 0; n < bench.volume(3 * count, 60 * count); ++n)
    reads.read(kOutcomes.at((n + n / count * (n % 3)) % count));
}

void read_hundreds_of_times(HostBench& bench, CaseJudge& judge) {
  Reads reads(bench, judge);
  for (unsigned n = 0; n < bench.volume(360U, 2'000U); ++n) reads.read(n / 2 % 2 == 0 ? "SSS" : "WWW");
}

// ---- boundary data ----

constexpr std::array<Response, 9> kBoundaryData{{{0x00, 0x00},
                                                 {0xFF, 0xFF},
                                                 {0x00, 0xFF},
                                                 {0xFF, 0x00},
                                                 {0x80, 0x7F},
                                                 {0x7F, 0x80},
                                                 {0x01, 0x00},
                                                 {0x00, 0x80},
                                                 {0x55, 0xAA}}};

const Response& boundary_data(const HostScene& scene) {
  return kBoundaryData.at(scene.round / 2);
}

std::vector<std::uint8_t> boundary_octets(HostScene& scene) {
  const auto octets = octets_of(boundary_data(scene));
  return {octets.begin(), octets.end()};
}

// A refresh would come much later.
void expect_boundary_write_sent(HostScene& scene) {
  const auto [data0, data1] = boundary_data(scene);
  scene.order({7, static_cast<std::uint8_t>(scene.bench.rules().write_command), data0, data1});
  const kernel::Time ordered = scene.bench.now();
  scene.expect_sent();
  scene.judge.expect(scene.request.start - ordered < scene.bench.rules().refresh / 2, "write_lost",
                     "each write of the PC is sent", "it was sent by its refresh only");
  scene.bench.wait(scene.bench.delimiter() + scene.bench.rules().write_distance);
}

// ---- supply ----

void fill_its_memory(HostScene& scene) {
  HostBench& bench = scene.bench;
  const auto writes = bench.write_to(11);
  bench.order(writes);
  expect_request(bench, scene.judge, writes);
  bench.wait(bench.delimiter() + bench.rules().write_distance);
  scene.known = expect_read_served(bench, scene.judge, scene.id);
  bench.order(bench.read_of(scene.id));
  expect_request(bench, scene.judge, bench.read_of(scene.id));
  // While it waits for this response: more than fits, and a part of a command.
  std::vector<std::uint8_t> octets;
  for (unsigned n = 0; n <= bench.rules().fifo_octets / 4; ++n) octets.insert(octets.end(), {12, 1, 0, 0});
  bench.write(octets);
  scene.judge.expect_equal(bench.has_overflowed(), true, "overflow_not_told", "overflow");
  if (scene.round % 2 == 0) bench.wait(3 * bench.time_out() + bench.characters(40));  // it fails
}

void expect_nothing_left(HostScene& scene) {
  HostBench& bench = scene.bench;
  scene.judge.expect_equal(bench.has_overflowed(), false, "remembers_over_power_loss", "overflow");
  scene.judge.expect_equal(bench.fifo_room(), std::size_t{bench.rules().fifo_octets},
                           "remembers_over_power_loss", "room in the FIFO");
  scene.judge.expect(bench.counters(scene.id) == HostCounters{}, "remembers_over_power_loss",
                     "the counters stand at 0", "they do not");
  const auto frame = bench.next_frame(bench.rules().refresh * 3);
  scene.judge.expect(!frame, "remembers_over_power_loss", "nothing is sent after power-up",
                     [&] { return "it sent something"; }());
  expect_nothing_told(bench, scene.judge, {}, "remembers_over_power_loss", "nothing was ordered");
}

void expect_nothing_known(HostScene& scene) {
  HostBench& bench = scene.bench;
  const HostFrame first = order_read(bench, scene.judge, scene.id);
  for (unsigned n = 1; n < bench.rules().read_attempts; ++n) expect_retry(bench, scene.judge, first);
  expect_error(bench, scene.judge, {scene.id, HostErrorKind::no_response});
  expect_nothing_told(bench, scene.judge, kernel::kMillisecond, "remembers_over_power_loss",
                      "nothing has been read since power-up");
}

}  // namespace

std::vector<HostCase> host_memory_cases() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("what is reported to the PC of a read");
  return {
      {{.id = "valve_bus/host/memory/each_read_has_its_own_outcome",
        .purpose = "RH-37",
        .requirement =
            "Attempts, kind of the error, old data and counters of a read are its own, whatever came of "
            "the reads before it; the next attempt comes after the time-out, whatever was answered.",
        .reference = own,
        .stimulus =
            "Reads of two nodes in turn, of which each attempt is not answered, wrongly or rightly, in each "
            "order.",
        .expected = "Each is repeated, ends, is reported and counted as its own attempts say.",
        .tags = {"must", "timing"},
        .catches = {{"kind_of_any_attempt", "error_wrong"},
                    {"old_data_of_any_node", "old_data_wrong"},
                    {"old_data_told_once", "old_data_not_told"},
                    {"time_out_short", "time_out_too_short"},
                    {"right_after_wrong_taken", "no_retry"}}},
       read_with_each_outcome},
      {{.id = "valve_bus/host/memory/counters_go_beyond_8_bits",
        .purpose = "RH-37",
        .requirement = "The counters of a node count each attempt, hundreds of them.",
        .reference = own,
        .stimulus = "360 reads (2000 at full volume) of two nodes, not answered or answered wrongly three "
                    "times each.",
        .expected = "All are counted.",
        .tags = {"must", "timing"},
        .catches = {{"counters_of_8_bits", "counters_wrong"}}},
       read_hundreds_of_times},
      on_chart({.id = "valve_bus/host/memory/boundary_data_are_told",
                .purpose = "RH-37",
                .requirement = "All data are reported as they are, also twice the same.",
                .reference = own,
                .tags = {"must"},
                .catches = {{"equal_responses_told_once", "response_not_told"},
                            {"zeros_not_told", "response_not_told"}}},
               {{2 * kBoundaryData.size(), 2 * kBoundaryData.size()},
                {stimulus("the PC orders a read of node 9", [](HostScene& scene) { scene.id = 9; }), read(),
                 answer("the node answers with 00 00, FF FF and the like, twice each", boundary_octets),
                 reported()}}),
      on_chart({.id = "valve_bus/host/memory/boundary_data_are_sent",
                .purpose = "RH-37",
                .requirement = "All data are sent as they are, also twice the same.",
                .reference = valve_sources::paper("frame of the host"),
                .tags = {"must", "timing"},
                .catches = {{"equal_writes_sent_once", "no_request"}},
                .not_applicable = for_both(for_plain_writes(), for_quick_frames(8))},
               {{2 * kBoundaryData.size(), 2 * kBoundaryData.size()},
                {{"the PC orders a write of 00 00, FF FF and the like to node 7, twice each",
                  "it is sent at once", expect_boundary_write_sent}}}),
      on_chart(
          {.id = "valve_bus/host/memory/nothing_survives_power",
           .purpose = "RH-38",
           .requirement =
               "After power-up nothing is left of what was ordered, written, read, counted or lost.",
           .reference = valve_sources::own("power-up is the only reset"),
           .tags = {"must", "timing"},
           .catches = {{"refreshes_over_power_loss", "remembers_over_power_loss"},
                       {"overflow_over_power_loss", "remembers_over_power_loss"},
                       {"counters_over_power_loss", "remembers_over_power_loss"}},
           .not_applicable =
               for_both(for_both(for_plain_writes(), for_quick_frames(8)), for_switched_power())},
          {{2, 20},
           {stimulus(
                "a write and a read are served; while another read waits, or has failed, the PC writes more "
                "than fits",
                fill_its_memory),
            power_cycled(),
            expected("nothing is sent or reported, the FIFO is empty, the counters are 0",
                     expect_nothing_left),
            {"the PC orders a read that is not answered", "the PC gets an error, and no old data",
             expect_nothing_known}}}),
  };
}

}  // namespace fieldproof::conformance
