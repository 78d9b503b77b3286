#include "emc/sensitivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "emc/profile.hpp"

namespace fieldproof::emc {
namespace {

const CouplingParameter& parameter_named(std::string_view name) {
  return *std::ranges::find(coupling_parameters(), name, &CouplingParameter::name);
}

TEST(Sensitivity, TriesHalfToTwiceAndSixDecibelsWithinTheRange) {
  const Coupling coupling;
  EXPECT_EQ(values_around(parameter_named("shield_db"), coupling), (std::vector<double>{3, 6}));
  EXPECT_EQ(values_around(parameter_named("imbalance_db"), coupling), (std::vector<double>{24, 27, 33, 36}));
  const auto clamp = values_around(parameter_named("clamp_pf"), coupling);
  ASSERT_EQ(clamp.size(), 4U);
  EXPECT_DOUBLE_EQ(clamp.front(), 100);
  EXPECT_DOUBLE_EQ(clamp.back(), 400);
  EXPECT_TRUE(values_around(parameter_named("source_ohm"), coupling).empty()) << "the standard fixes it";
  EXPECT_TRUE(values_around(parameter_named("common_mode_limit_v"), coupling).empty()) << "there is none";
  for (const CouplingParameter& parameter : coupling_parameters()) {
    for (const double value : values_around(parameter, coupling)) {
      Coupling tried = coupling;
      tried.*parameter.member = value;
      EXPECT_NO_THROW(check_coupling(tried)) << parameter.name << " " << value;
    }
  }
}

TEST(Sensitivity, SaysHowFarACriterionStaysAndWhatComesThen) {
  const auto by_imbalance = [](const Coupling& coupling) -> std::optional<Criterion> {
    return coupling.imbalance_db < 25   ? Criterion::c
           : coupling.imbalance_db > 35 ? Criterion::a
                                        : Criterion::b;
  };
  const auto range = range_of(parameter_named("imbalance_db"), Coupling{}, Criterion::b, by_imbalance);
  ASSERT_TRUE(range.has_value());
  EXPECT_EQ(range->from, 27);
  EXPECT_EQ(range->to, 33);
  EXPECT_EQ(range->below, (std::pair{24.0, Criterion::c}));
  EXPECT_EQ(range->above, (std::pair{36.0, Criterion::a}));
  const auto other = range_of(parameter_named("ring_q"), Coupling{}, Criterion::b, by_imbalance);
  ASSERT_TRUE(other.has_value());
  EXPECT_TRUE(other->holds());
  EXPECT_FALSE(range_of(parameter_named("ring_q"), Coupling{}, Criterion::b, [](const Coupling&) {
                 return std::optional<Criterion>{};
               }).has_value());
}

}  // namespace
}  // namespace fieldproof::emc
