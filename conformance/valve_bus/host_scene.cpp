#include "conformance/valve_bus/host_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fieldproof::conformance {

using valve_bus::HostCounters;
using valve_bus::HostErrorKind;

namespace {

constexpr unsigned kWritten = 5;  // nodes that are written to

valve_bus::Response data_of(const HostScene& scene) {
  return {scene.octets.at(0), scene.octets.at(1)};
}

}  // namespace

HostScene::HostScene(HostBench& bench_, CaseJudge& judge_, unsigned round_)
    : Scene(bench_, judge_, round_),
      id(bench.random_id()),
      other(static_cast<std::uint8_t>(id % bench.rules().last_address + 1)) {}

void HostScene::order(const valve_bus::Command& ordered) {
  command = ordered;
  bench.order(ordered);
}

void HostScene::expect_sent() {
  request = expect_request(bench, judge, command);
  poll = request;
}

void HostScene::answer(std::vector<std::uint8_t> given, kernel::Duration after) {
  octets = std::move(given);
  bench.answer(octets, after);
}

line::Levels HostScene::levels(valve_bus::CharacterProfile profile) const {
  line::Levels all;
  for (const std::uint8_t octet : octets) all.append(bench.levels_of(octet, profile));
  return all;
}

kernel::Duration HostScene::reporting_time() const {
  return bench.characters(11 + static_cast<double>(octets.size())) + kernel::kMillisecond;
}

void HostScene::expect_nothing_reported(std::string_view reason, const std::string& why_not) {
  expect_nothing_told(bench, judge, reporting_time(), reason, why_not);
}

namespace host_chart {

std::vector<std::uint8_t> right_octets(HostScene& scene) {
  const auto octets = octets_of(scene.bench.random_response());
  return {octets.begin(), octets.end()};
}

HostStep read() {
  return {"the PC orders a read of a node", "the host sends it", [](HostScene& scene) {
            scene.counters = scene.bench.counters(scene.id);
            scene.others = scene.bench.counters(scene.other);
            const auto [data0, data1] = scene.bench.random_response();
            scene.order(scene.bench.read_of(scene.id, data0, data1));
            scene.expect_sent();
          }};
}

HostStep write() {
  return {"the PC orders a write to a node", "the host sends it", [](HostScene& scene) {
            scene.order(scene.bench.write_to(1 + (scene.round + scene.writes++) % kWritten));
            scene.expect_sent();
          }};
}

HostStep served_read() {
  return {"the PC orders a read, and the node answers rightly", "the PC gets the data",
          [](HostScene& scene) { scene.known = expect_read_served(scene.bench, scene.judge, scene.id); }};
}

MakeOctets written_data(bool is_right) {
  return [is_right](HostScene& scene) {
    valve_bus::Response response{scene.command.data0, scene.command.data1};
    if (!is_right) (scene.round % 2 == 0 ? response.data1 : response.data0) ^= 1U << scene.round % 8;
    const auto octets = octets_of(response);
    return std::vector<std::uint8_t>(octets.begin(), octets.end());
  };
}

HostStep power_cycled() {
  return stimulus("power goes off and comes", [](HostScene& scene) {
    scene.bench.restart(static_cast<unsigned>(scene.bench.pics().number("dip", 0)));
  });
}

HostStep powered_up_at_each_position() {
  return stimulus("power goes off and comes with the DIP switches in each position in turn",
                  [](HostScene& scene) { scene.bench.restart(dip_of(scene)); });
}

unsigned dip_positions() {
  return static_cast<unsigned>(valve_bus::dip_bit_rates().size());
}

unsigned dip_of(const HostScene& scene) {
  return scene.round % dip_positions();
}

HostStep response() {
  return answer("the node answers rightly", right_octets);
}

HostStep answer(std::string text, MakeOctets octets, MakeTime after) {
  return stimulus(std::move(text), [octets = std::move(octets), after = std::move(after)](HostScene& scene) {
    scene.answer(octets(scene), after ? after(scene) : scene.bench.turnaround_time());
  });
}

HostStep answer_levels(std::string text, std::function<line::Levels(HostScene&)> levels) {
  return stimulus(std::move(text), [levels = std::move(levels)](HostScene& scene) {
    scene.octets = right_octets(scene);
    scene.bench.answer_levels(levels(scene), scene.bench.turnaround_time());
  });
}

HostStep reported() {
  return expected("the PC gets its data", [](HostScene& scene) {
    expect_response(scene.bench, scene.judge, scene.id, data_of(scene));
  });
}

HostStep taken(std::string reason) {
  return expected("the PC gets the data in it", [reason = std::move(reason)](HostScene& scene) {
    expect_response(scene.bench, scene.judge, scene.id, data_of(scene), scene.reporting_time(), reason);
  });
}

HostStep refused(std::string reason, std::string why_not) {
  return expected(fmt::format("nothing is reported: {}; the node is polled again and served", why_not),
                  [reason = std::move(reason), why_not](HostScene& scene) {
                    scene.expect_nothing_reported(
                        reason, fmt::format("{}: {:02X}", why_not, fmt::join(scene.octets, " ")));
                    expect_retry(scene.bench, scene.judge, scene.request);
                    scene.answer(right_octets(scene));
                    expect_response(scene.bench, scene.judge, scene.id, data_of(scene));
                  });
}

HostStep taken_if(std::string text, std::function<bool(const HostScene&)> is_taken,
                  std::string refused_reason, std::string taken_reason, std::string why_not) {
  const HostStep one = taken(std::move(refused_reason));
  const HostStep other = refused(std::move(taken_reason), std::move(why_not));
  return expected(fmt::format("{} {}, else {}", text, one.expected, other.expected),
                  [one = one.run, other = other.run, is_taken = std::move(is_taken)](HostScene& scene) {
                    is_taken(scene) ? one(scene) : other(scene);
                  });
}

HostStep polled_again() {
  return expected("the host polls the node again", [](HostScene& scene) {
    scene.poll = expect_retry(scene.bench, scene.judge, scene.request);
  });
}

HostStep not_polled_again() {
  return expected("no further poll", [](HostScene& scene) {
    expect_no_request(scene.bench, scene.judge, 2 * scene.bench.time_out(), "polled_too_often",
                      fmt::format("{} attempts in all", scene.bench.rules().read_attempts));
  });
}

HostStep error(HostErrorKind kind, std::string reason_for_data) {
  return expected(fmt::format("the PC gets an error: {}", describe(kind)),
                  [kind, reason = std::move(reason_for_data)](HostScene& scene) {
                    expect_error(scene.bench, scene.judge, {scene.command.id, kind}, reason);
                  });
}

HostStep old_data() {
  return expected("the PC gets what was known, marked as old",
                  [](HostScene& scene) { expect_old(scene.bench, scene.judge, scene.id, scene.known); });
}

HostStep nothing_reported(MakeTime within, std::string reason, std::string why_not) {
  return expected(fmt::format("nothing is reported: {}", why_not),
                  [within = std::move(within), reason = std::move(reason), why_not](HostScene& scene) {
                    expect_nothing_told(scene.bench, scene.judge, within(scene), reason, why_not);
                  });
}

HostStep nothing_reported(kernel::Duration within, std::string reason, std::string why_not) {
  return nothing_reported([within](HostScene&) { return within; }, std::move(reason), std::move(why_not));
}

HostStep nothing_reported(std::string reason, std::string why_not) {
  return nothing_reported(&HostScene::reporting_time, std::move(reason), std::move(why_not));
}

HostStep recovers() {
  return expected("then a read is served",
                  [](HostScene& scene) { expect_host_recovers(scene.bench, scene.judge); });
}

HostStep counted(std::uint64_t HostCounters::* counter, unsigned count, std::string what,
                 std::string reason) {
  return expected(fmt::format("{} counted: {}", what, count), [counter, count, what,
                                                               reason = std::move(reason)](HostScene& scene) {
    scene.judge.expect_equal(scene.bench.counters(scene.id).*counter - scene.counters.*counter, count, reason,
                             what);
    scene.judge.expect(scene.bench.counters(scene.other) == scene.others, "counters_wrong",
                       "the counters of another node stand as they stood", "they have changed");
  });
}

}  // namespace host_chart
}  // namespace fieldproof::conformance
