#include "island.hpp"

#include <conformance/bench_role.hpp>
#include <conformance/valve_bus/node_cases.hpp>
#include <conformance/valve_bus/node_expect.hpp>
#include <conformance/valve_bus/node_mutants.hpp>
#include <harness/iut/plugin.hpp>
#include <protocols/valve_bus/attached_node.hpp>
#include <protocols/valve_bus/dissector.hpp>
#include <protocols/valve_bus/node.hpp>

namespace island {
namespace {

using namespace fieldproof;
using namespace fieldproof::conformance;
using kernel::kMicrosecond;
using kernel::kMillisecond;

// ---- the station and its mutants ----

class Island : public valve_bus::Node {
 public:
  using Node::Node;

 protected:
  kernel::Duration turnaround_time() const override { return delimiter(rules()) + 120 * kMicrosecond; }
};

// The bus allows 2 ms for both.
class AnswersSlowly final : public Island {
  using Island::Island;
  kernel::Duration turnaround_time() const override { return Island::turnaround_time() + kMillisecond; }
};

class MovesSlowly final : public Island {
  using Island::Island;
  void actuate(std::uint16_t valves, kernel::Time now) override {
    Island::actuate(valves, now + kMillisecond);
  }
};

std::vector<NodeMutants::Row> rows() {
  return {{"answers_slowly", "MV1", "answers a read 1 ms later", mutant<AnswersSlowly>()},
          {"moves_slowly", "MV2", "moves its valves 1 ms later", mutant<MovesSlowly>()}};
}

const NodeMutants& mutants() {
  static const NodeMutants table("node", {rows});
  return table;
}

// ---- the cases ----

const judge::Reference kDataSheet{"data sheet of the valve island", "dynamic properties",
                                  judge::Standing::own};

void expect_at_once(CaseJudge& judge, std::string_view what, kernel::Duration took, std::string_view reason) {
  judge.expect_between(what, "us", static_cast<double>(took.count()) * 1e-6, 0, 300, reason);
}

void answers_within_300_us(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 50); ++n) {
    bench.clear_observations();
    const auto switches = static_cast<std::uint16_t>(bench.random().below(0x10000));
    bench.boards().set_input(0, switches);
    const kernel::Time asked = bench.read();
    bench.await_response_window();
    const Transmission answer = expect_answer(bench, judge, switches, asked);
    const kernel::Duration took = answer.characters.front().start - asked - bench.delimiter();
    expect_at_once(judge, "answer after the silence", took, "answers_too_slowly");
  }
}

void moves_within_300_us(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 50); ++n) {
    bench.clear_observations();
    const auto data0 = static_cast<std::uint8_t>(~bench.valves());
    const kernel::Time written = bench.write(data0, 0);
    bench.await_response_window();
    expect_write_taken(bench, judge, data0, 0, written);
    const kernel::Duration took = bench.boards().changes().front().when - written - bench.delimiter();
    expect_at_once(judge, "valves after the silence", took, "moves_too_slowly");
  }
}

const std::vector<NodeCase>& cases() {
  static const std::vector<NodeCase> all{
      {{.id = "island/node/read/answers_within_300_us",
        .purpose = "VI-01",
        .requirement = "The valve island answers a read at most 0.3 ms after the silence that ends it.",
        .reference = kDataSheet,
        .stimulus = "Reads with random limit switches.",
        .expected = "Each answer is right and begins in time.",
        .tags = {"must", "timing"},
        .catches = {{"answers_slowly", "answers_too_slowly"}}},
       &answers_within_300_us},
      {{.id = "island/node/write/moves_within_300_us",
        .purpose = "VI-02",
        .requirement =
            "The valve island moves its valves at most 0.3 ms after the silence that ends a write.",
        .reference = kDataSheet,
        .stimulus = "Writes that change every valve of the first board.",
        .expected = "The valves stand as each write says, in time.",
        .tags = {"must", "timing"},
        .catches = {{"moves_slowly", "moves_too_slowly"}}},
       &moves_within_300_us}};
  return all;
}

}  // namespace

std::unique_ptr<NodeDevice> firmware(const NodeConfiguration& configuration, const std::string& case_id,
                                     std::uint64_t seed) {
  const std::shared_ptr<iut::Device> device =
      iut::make_plugin(*fieldproof_plugin(FIELDPROOF_PLUGIN_VERSION), "valve_bus", "node");
  return std::make_unique<valve_bus::AttachedNode>(iut::Attachment{device.get(), device}, configuration,
                                                   case_id, seed);
}

OwnStations own_firmware() {
  return own_station<valve_bus::NodeRole>(
      [](const IutRequest& wanted, const NodeConfiguration& configuration) {
        return firmware(configuration, wanted.case_id, wanted.seed);
      });
}

std::unique_ptr<Suite> island_suite(SuiteGiven given) {
  given.own = own_firmware();
  return std::make_unique<Suite>(
      SuiteRows{
          .protocol = "island",
          .roles = {row_of<valve_bus::NodeRole, Island>(
              {.what = "valve island", .mutants = mutants},
              CaseRole<NodeCase, NodeSetting, valve_bus::FrameDissector>{.name = "node", .cases = cases})}},
      std::move(given));
}

}  // namespace island
