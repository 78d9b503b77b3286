#include "conformance/valve_bus/node_cases.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

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

class DeclaredNodes : public testing::TestWithParam<DeclaredNode> {};

// Whatever a node declares, the reference that is so passes: anything else is a false alarm.
TEST_P(DeclaredNodes, PassAsTheyDeclare) {
  for (const NodeCase& one : node_cases()) {
    if (is_canary(one.test_case)) continue;
    const bool is_excluded =
        one.test_case.not_applicable && one.test_case.not_applicable(GetParam().pics).has_value();
    if (is_excluded || has_tag(one.test_case, kStressTag)) continue;
    NodeSetting setting;
    setting.volume = Volume::quick;
    setting.pics = GetParam().pics;
    for (setting.seed = 1; setting.seed <= 3; ++setting.seed) {
      const judge::CaseResult result = run_on_bench(one, setting);
      EXPECT_EQ(result.verdict, judge::Verdict::pass)
          << result.id << " seed " << setting.seed << ": " << result.reason
          << (result.findings.empty() ? "" : ", " + result.findings.front().actual);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheReference, DeclaredNodes, testing::ValuesIn(declared_nodes()),
                         [](const auto& node) { return node.param.name; });

}  // namespace
}  // namespace fieldproof::conformance
