#include "conformance/valve_bus/host_scene.hpp"

#include <fmt/format.h>

namespace fieldproof::conformance {

using valve_bus::HostCounters;
using valve_bus::HostErrorKind;
using valve_bus::Response;

HostScene::HostScene(HostBench& bench_, CaseJudge& judge_, unsigned round_)
    : bench(bench_),
      judge(judge_),
      round(round_),
      id(bench.random_id()),
      other(static_cast<std::uint8_t>(id % bench.rules().last_address + 1)) {}

Response HostScene::random_response() {
  return {bench.random_octet(), bench.random_octet()};
}

namespace host_chart {
namespace {

// In which a response that began at an ordinary time has been reported, if it is.
kernel::Duration reporting_time(const HostScene& scene) {
  return scene.bench.characters(14) + kernel::kMillisecond;
}

void order(HostScene& scene) {
  scene.counters = scene.bench.counters(scene.id);
  scene.others = scene.bench.counters(scene.other);
  scene.request = order_read(scene.bench, scene.judge, scene.id);
}

void give(HostScene& scene, std::vector<std::uint8_t> octets, kernel::Duration after) {
  scene.octets = std::move(octets);
  scene.bench.answer(scene.octets, after);
}

void give_right_response(HostScene& scene) {
  give(scene, right_octets(scene), scene.bench.turnaround_time());
}

}  // namespace

std::vector<std::uint8_t> right_octets(HostScene& scene) {
  const auto octets = octets_of(scene.random_response());
  return {octets.begin(), octets.end()};
}

HostStep read() {
  return {"the PC orders a read of a node", "the host sends it", order};
}

HostStep served_read() {
  return {"the PC orders a read, and the node answers rightly", "the PC gets the data",
          [](HostScene& scene) { scene.known = expect_read_served(scene.bench, scene.judge, scene.id); }};
}

HostStep response() {
  return stimulus<HostScene>("the node answers rightly", give_right_response);
}

HostStep answer(std::string text, MakeOctets octets, MakeTime after) {
  return stimulus<HostScene>(
      std::move(text), [octets = std::move(octets), after = std::move(after)](HostScene& scene) {
        give(scene, octets(scene), after ? after(scene) : scene.bench.turnaround_time());
      });
}

HostStep reported() {
  return expected<HostScene>("the PC gets its data", [](HostScene& scene) {
    expect_response(scene.bench, scene.judge, scene.id, scene.response());
  });
}

HostStep taken(std::string reason) {
  return expected<HostScene>("the PC gets the data in it", [reason = std::move(reason)](HostScene& scene) {
    const auto told = scene.bench.next_told(reporting_time(scene));
    const Response data = scene.response();
    const auto mismatch = [&] {
      return Mismatch{
          {fmt::format("the PC gets the data of {:02X}: {:02X} {:02X}", scene.id, data.data0, data.data1)},
          told ? text_of(*told) : "nothing"};
    };
    scene.judge.expect(told.has_value(), reason, mismatch);
    const auto* seen = std::get_if<valve_bus::HostResponse>(&told->what);
    scene.judge.expect(seen != nullptr && *seen == valve_bus::HostResponse{scene.id, data.data0, data.data1},
                       "response_wrong", mismatch);
  });
}

HostStep refused(std::string reason, std::string why_not) {
  return expected<HostScene>("nothing is reported; the node is polled again and served",
                             [reason = std::move(reason), why_not = std::move(why_not)](HostScene& scene) {
                               expect_nothing_told(scene.bench, scene.judge, reporting_time(scene), reason,
                                                   why_not);
                               expect_retry(scene.bench, scene.judge, scene.request);
                               give_right_response(scene);
                               expect_response(scene.bench, scene.judge, scene.id, scene.response());
                             });
}

HostStep polled_again() {
  return expected<HostScene>("the host polls the node again",
                             [](HostScene& scene) { expect_retry(scene.bench, scene.judge, scene.request); });
}

HostStep not_polled_again() {
  return expected<HostScene>("no further poll", [](HostScene& scene) {
    expect_no_request(scene.bench, scene.judge, 2 * scene.bench.time_out(), "polled_too_often",
                      fmt::format("{} attempts in all", scene.bench.rules().read_attempts));
  });
}

HostStep error(HostErrorKind kind, std::string reason_for_data) {
  return expected<HostScene>(fmt::format("the PC gets an error: {}", describe(kind)),
                             [kind, reason = std::move(reason_for_data)](HostScene& scene) {
                               expect_error(scene.bench, scene.judge, {scene.id, kind}, reason);
                             });
}

HostStep old_data() {
  return expected<HostScene>("the PC gets what was known, marked as old", [](HostScene& scene) {
    expect_old(scene.bench, scene.judge, scene.id, scene.known);
  });
}

HostStep nothing_reported(kernel::Duration within, std::string reason, std::string why_not) {
  return expected<HostScene>("nothing more is reported", [within, reason = std::move(reason),
                                                          why_not = std::move(why_not)](HostScene& scene) {
    expect_nothing_told(scene.bench, scene.judge, within, reason, why_not);
  });
}

HostStep counted(std::uint64_t HostCounters::* counter, unsigned count, std::string what) {
  return expected<HostScene>(
      fmt::format("{} {} counted", count, what), [counter, count, what](HostScene& scene) {
        scene.judge.expect_equal(scene.bench.counters(scene.id).*counter - scene.counters.*counter, count,
                                 "counters_wrong", what);
        scene.judge.expect(scene.bench.counters(scene.other) == scene.others, "counters_wrong",
                           "the counters of another node stand as they stood", "they have changed");
      });
}

}  // namespace host_chart
}  // namespace fieldproof::conformance
