#include "conformance/valve_bus/node_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/rules.hpp"

namespace fieldproof::conformance {
namespace {

struct DeclaredNode {
  std::string name;
  judge::Pics pics;
};

judge::Pics declaring(std::initializer_list<std::pair<std::string, judge::Pics::Answer>> answers) {
  judge::Pics pics;
  for (const auto& [item, answer] : answers) pics.declare(item, answer);
  return pics;
}

std::vector<DeclaredNode> declared_nodes() {
  std::vector<DeclaredNode> all{
      {"address_99", declaring({{"address_tens", std::int64_t{9}}, {"address_units", std::int64_t{9}}})},
      {"address_1", declaring({{"address_tens", std::int64_t{0}}, {"address_units", std::int64_t{1}}})},
      {"one_board", declaring({{"boards", std::int64_t{1}}})},
      {"P1", declaring({{"characters", std::string("P1")}})},
      {"P2", declaring({{"characters", std::string("P2")}})},
      {"acknowledges", declaring({{"answers_writes", true}})},
      {"acknowledges_P2", declaring({{"answers_writes", true}, {"characters", std::string("P2")}})},
      {"lets_go", declaring({{"loss_limit", 500 * kernel::kMillisecond}})},
      {"lets_go_soon", declaring({{"loss_limit", 100 * kernel::kMillisecond}})},
  };
  constexpr std::int64_t kSlowest = 1'200;
  constexpr std::int64_t kFastest = 1'000'000;
  std::vector<std::int64_t> rates{kSlowest, kFastest};
  rates.insert(rates.end(), valve_bus::dip_bit_rates().begin(), valve_bus::dip_bit_rates().end());
  for (const std::int64_t rate : rates) {
    all.push_back({"at_" + std::to_string(rate), declaring({{"bit_rate", rate}})});
  }
  return all;
}

// A node that answers as early as it may, and one that answers as late.
class EarlyNode : public valve_bus::Node {
 public:
  using Node::Node;

 private:
  kernel::Duration turnaround_time() const override { return valve_bus::delimiter(rules()); }
};
class LateNode : public valve_bus::Node {
 public:
  using Node::Node;

 private:
  kernel::Duration turnaround_time() const override {
    return valve_bus::delimiter(rules()) + valve_bus::turnaround_time_span(rules());
  }
};

template <typename Node>
std::unique_ptr<valve_bus::NodeDevice> make(const valve_bus::NodeConfiguration& configuration) {
  return std::make_unique<Node>(configuration);
}

class DeclaredNodes : public testing::TestWithParam<DeclaredNode> {
 protected:
  template <typename Node>
  static void expect_passes(std::uint64_t seeds) {
    for (const NodeCase& one : node_cases()) {
      if (is_canary(one.test_case)) continue;
      const bool is_excluded =
          one.test_case.not_applicable && one.test_case.not_applicable(GetParam().pics).has_value();
      if (is_excluded || has_tag(one.test_case, kStressTag)) continue;
      NodeSetting setting;
      setting.volume = Volume::quick;
      setting.pics = GetParam().pics;
      setting.make_device = &make<Node>;
      for (setting.seed = 1; setting.seed <= seeds; ++setting.seed) {
        const judge::CaseResult result = run_on_bench(one, setting);
        EXPECT_EQ(result.verdict, judge::Verdict::pass)
            << result.id << " seed " << setting.seed << ": " << result.reason
            << (result.findings.empty() ? "" : ", " + result.findings.front().actual);
      }
    }
  }
};

// Whatever a node declares, the reference that is so passes: anything else is a false alarm.
TEST_P(DeclaredNodes, PassAsTheyDeclare) {
  expect_passes<valve_bus::Node>(3);
}
TEST_P(DeclaredNodes, PassWhenTheyAnswerAsEarlyAsTheyMay) {
  expect_passes<EarlyNode>(1);
}
TEST_P(DeclaredNodes, PassWhenTheyAnswerAsLateAsTheyMay) {
  expect_passes<LateNode>(1);
}

// Takes a frame with a wrong check for a sign of life of its host.
class KeptAliveByAnyFrame : public valve_bus::Node {
 public:
  using Node::Node;

 private:
  bool fits(std::span<const std::uint8_t> octets) const override {
    is_wrong_ = !Node::fits(octets);
    return true;
  }
  void on_command(const valve_bus::Command& command, kernel::Time now) override {
    if (!is_wrong_) Node::on_command(command, now);
  }
  mutable bool is_wrong_ = false;
};

TEST(NodePower, AWrongFrameIsNoSignOfLife) {
  const auto cases = node_cases();
  const auto one = std::ranges::find_if(cases, [](const NodeCase& each) {
    return each.test_case.id == "valve_bus/node/power/valves_hold_without_a_host";
  });
  NodeSetting setting;
  setting.pics = declaring({{"loss_limit", 100 * kernel::kMillisecond}});
  setting.make_device = &make<KeptAliveByAnyFrame>;
  EXPECT_EQ(run_on_bench(*one, setting).reason, "valves_hold_without_host");
}

INSTANTIATE_TEST_SUITE_P(OfTheReference, DeclaredNodes, testing::ValuesIn(declared_nodes()),
                         [](const auto& node) { return node.param.name; });

}  // namespace
}  // namespace fieldproof::conformance
