// Subject: slaves as a PICS declares them. Whatever is declared, the reference that is so passes: anything
// else is a false alarm.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "conformance/interbus/whole_cases.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/interbus/slave.hpp"

namespace fieldproof::conformance {
namespace {

struct DeclaredSlave {
  std::string name;
  judge::Pics pics;
};

judge::Pics declared_as(std::initializer_list<std::pair<std::string, judge::Pics::Answer>> answers) {
  judge::Pics pics;
  for (const auto& [item, answer] : answers) pics.declare(item, answer);
  return pics;
}

std::vector<DeclaredSlave> declared_slaves() {
  std::vector<DeclaredSlave> all{
      {"another_code_of_two_words", declared_as({{"id_code", std::int64_t{0x02FF}}})},
      {"four_words", declared_as({{"id_code", std::int64_t{1027}}, {"words", std::int64_t{4}}})},
      {"code_of_four_words", declared_as({{"id_code", std::int64_t{1027}}})},
      {"first_code", declared_as({{"id_code", std::int64_t{0}}})},
      {"last_code", declared_as({{"id_code", std::int64_t{0x1FFF}}, {"words", std::int64_t{3}}})},
      {"undefined_code", declared_as({{"id_code", std::int64_t{0x0803}}, {"words", std::int64_t{11}}})},
      {"inputs_only", declared_as({{"id_code", std::int64_t{0x0302}}})},
      {"outputs_only", declared_as({{"id_code", std::int64_t{0x0301}}})},
      {"no_inputs", declared_as({{"inputs", false}})},
      {"no_outputs", declared_as({{"outputs", false}})},
      {"branch", declared_as({{"has_branch", true}})},
      {"end_of_the_bus", declared_as({{"remote_interface", false}})},
      {"nothing_to_tell",
       declared_as({{"reconfiguration_button", false}, {"peripheral_fault_input", false}})},
      {"of_one_build", declared_as({{"any_length_code", false}, {"other_settings", false}})},
  };
  for (const std::int64_t words : {0, 1, 2, 4, 16, 32})
    all.push_back({"words_" + std::to_string(words), declared_as({{"words", words}})});
  return all;
}

SlaveSetting quick_setting(const judge::Pics& pics) {
  SlaveSetting setting;
  setting.volume = Volume::quick;
  setting.pics = pics;
  return setting;
}

class DeclaredSlaves : public testing::TestWithParam<DeclaredSlave> {};

TEST_P(DeclaredSlaves, PassAsTheyDeclare) {
  SlaveSetting setting = quick_setting(GetParam().pics);
  kernel::FewerIfSanitized few(8);
  for (const SlaveCase& one : slave_cases()) {
    if (few.leaves_out() || is_canary(one.test_case) || has_tag(one.test_case, kStressTag)) continue;
    for (setting.seed = 1; setting.seed <= 2; ++setting.seed) {
      const judge::CaseResult result = run_whole(one, setting);
      const bool is_excluded = result.verdict == judge::Verdict::not_applicable;
      EXPECT_TRUE(is_excluded || result.verdict == judge::Verdict::pass)
          << result.id << " seed " << setting.seed << ": " << result.reason
          << (result.findings.empty() ? "" : ", " + result.findings.front().actual);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheReference, DeclaredSlaves, testing::ValuesIn(declared_slaves()),
                         [](const auto& slave) { return slave.param.name; });

// What a slave declares is what the implementation is given, in every case that does not say otherwise.
TEST(SlaveDeclarations, AreTheSettingsThatTheDeviceGets) {
  for (const DeclaredSlave& declared : declared_slaves()) {
    SlaveSetting setting = quick_setting(declared.pics);
    std::vector<interbus::SlaveConfiguration> given;
    setting.make_device = [&given](const interbus::SlaveConfiguration& of) {
      given.push_back(of);
      return std::make_unique<interbus::Slave>(of);
    };
    SlaveBench(SlaveNeeds{}, setting);
    ASSERT_EQ(given.size(), 1U) << declared.name;
    const judge::Pics& pics = declared.pics;
    EXPECT_EQ(given[0].id_code, pics.number("id_code", given[0].id_code)) << declared.name;
    EXPECT_EQ(given[0].words, pics.number("words", given[0].words)) << declared.name;
    EXPECT_EQ(given[0].has_branch, pics.supports("has_branch")) << declared.name;
  }
}

TEST(SlaveDeclarations, AContradictionIsRefused) {
  for (const judge::Pics& pics :
       {declared_as({{"id_code", std::int64_t{0x0203}}, {"words", std::int64_t{4}}}),
        declared_as({{"words", std::int64_t{11}}}), declared_as({{"id_code", std::int64_t{0x1803}}})}) {
    EXPECT_THROW(slave_network({}, quick_setting(pics)), kernel::Error);
  }
}

TEST(SlaveDeclarations, AStationOfANetworkIsAsDeclared) {
  SlaveSetting setting = quick_setting(declared_as({{"id_code", std::int64_t{0x0403}}}));
  setting.network = slave_network({}, quick_setting({}));
  EXPECT_THROW(slave_network({}, setting), kernel::Error);
  setting.pics = declared_as({{"id_code", std::int64_t{0x0203}}, {"words", std::int64_t{2}}});
  EXPECT_NO_THROW(slave_network({}, setting));
}

}  // namespace
}  // namespace fieldproof::conformance
