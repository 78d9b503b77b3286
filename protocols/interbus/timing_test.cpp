#include "protocols/interbus/timing.hpp"
#include "protocols/interbus/paper.hpp"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include <set>

namespace fieldproof::interbus {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kNanosecond;

Duration one_station(Formula formula, unsigned user_octets) {
  TimingInput input;
  input.user_octets = user_octets;
  input.remote_stations = 1;
  return cycle_time(formula, input);
}

TEST(CycleTimeTest, FormulasGiveThePublishedTable) {
  EXPECT_EQ(one_station(Formula::f1, 2), 755 * kMicrosecond);
  EXPECT_EQ(one_station(Formula::f2, 2), 411 * kMicrosecond);
  EXPECT_EQ(one_station(Formula::f3, 2), 424'450 * kNanosecond);
  EXPECT_EQ(one_station(Formula::f4, 2), 695'200 * kNanosecond);
  EXPECT_EQ(one_station(Formula::f1, 4), 814'800 * kNanosecond);
  EXPECT_EQ(one_station(Formula::f2, 4), 463 * kMicrosecond);
  EXPECT_EQ(one_station(Formula::f3, 4), 478'050 * kNanosecond);
  EXPECT_EQ(one_station(Formula::f4, 4), 755 * kMicrosecond);
  // (13 * 8 + 4) and (13 * 10 + 4) bit * 2 us + 450 us, by hand.
  EXPECT_EQ(one_station(Formula::f5, 2), 666 * kMicrosecond);
  EXPECT_EQ(one_station(Formula::f5, 4), 718 * kMicrosecond);
}

TEST(CycleTimeTest, PrintedAndPublishedReadingDifferByTwoTelegrams) {
  EXPECT_EQ(one_station(Formula::f1, 2), one_station(Formula::f4, 4));
  EXPECT_EQ(one_station(Formula::f1, 4) - one_station(Formula::f4, 4), 59'800 * kNanosecond);
}

TEST(CycleTimeTest, Generation3TakesQuarterMillisecondMore) {
  TimingInput input{2, 1, 500'000, 700 * kMicrosecond};
  EXPECT_EQ(cycle_time(Formula::f1, input), 1'005 * kMicrosecond);
}

TEST(CycleTimeTest, SixtyDrivesStayInsideTheAxisOfTheirManual) {
  TimingInput input;
  input.user_octets = 60 * 6;
  input.remote_stations = 60;
  EXPECT_EQ(cycle_time(Formula::f3, input), 10'611'800 * kNanosecond);
}

TEST(CycleTimeTest, ThousandPointsTakeAboutFourMilliseconds) {
  TimingInput input;
  input.user_octets = 128;
  EXPECT_EQ(cycle_time(Formula::f2, input), 3'684 * kMicrosecond);
  // 14.95 bit * 134 * 2 us + 450 us; the published statement is "4 ms".
  EXPECT_EQ(cycle_time(Formula::f4, input), 4'456'600 * kNanosecond);
}

TEST(CycleTimeTest, CableIsCountedAsEachSourceSays) {
  TimingInput input;
  input.cable_m = 12'800;
  TimingInput bare;
  const auto cable = [&](Formula formula) { return cycle_time(formula, input) - cycle_time(formula, bare); };
  EXPECT_EQ(cable(Formula::f1), 128 * kMicrosecond);
  EXPECT_EQ(cable(Formula::f2), Duration::zero());
  EXPECT_EQ(cable(Formula::f3), 3'072 * kMicrosecond);
  EXPECT_EQ(cable(Formula::f4), 128 * kMicrosecond);
  EXPECT_EQ(cable(Formula::f5), 409'600 * kNanosecond);
}

TEST(CycleTimeTest, FourTimesTheRateIsAQuarterOfTheBits) {
  TimingInput input{4, 1, 2'000'000};
  EXPECT_EQ(cycle_time(Formula::f1, input), 450 * kMicrosecond + 91'200 * kNanosecond);
  EXPECT_EQ(cycle_time(Formula::f3, input), 200 * kMicrosecond + 69'512'500 * kernel::kPicosecond);
}

TEST(CycleTimeTest, ReactionIsTwoCycles) {
  EXPECT_EQ(reaction_time(755 * kMicrosecond), 1'510 * kMicrosecond);
}

TEST(CycleTimeTest, EveryFormulaIsDescribedUnderItsOwnName) {
  std::set<std::string_view> names;
  for (const FormulaDescription& description : formulas()) {
    EXPECT_EQ(name(description.formula), description.name);
    EXPECT_FALSE(description.source.empty());
    names.insert(description.name);
  }
  EXPECT_EQ(names, (std::set<std::string_view>{"f1", "f2", "f3", "f4", "f5"}));
}

TEST(StructuralTimeTest, PaperNetworkUnderBothReadings) {
  NetworkDescription network = paper_network();
  const TimingInput input = timing_input(network);
  EXPECT_EQ(input.user_octets, 4U);
  EXPECT_EQ(input.remote_stations, 1U);
  EXPECT_EQ(frame_time(network.rules, 4), 299 * kMicrosecond);
  EXPECT_EQ(ring_delay(network), 6 * kMicrosecond);
  EXPECT_EQ(structural_cycle_time(network), 755 * kMicrosecond);
  network.rules.end_telegrams = 2;
  EXPECT_EQ(frame_time(network.rules, 4) + ring_delay(network), 364'800 * kNanosecond);
  EXPECT_EQ(structural_cycle_time(network), 814'800 * kNanosecond);
}

TEST(StructuralTimeTest, LongestRingDelaysByCableAndStations) {
  NetworkDescription network;
  for (int n = 0; n < 512; ++n)
    network.stations.push_back({"s" + std::to_string(n), 0x0008, 25.0, false, {}});
  EXPECT_EQ(ring_delay(network), 128 * kMicrosecond + 512 * 3 * 2 * kMicrosecond);
}

RC_GTEST_PROP(StructuralTimeTest, EqualsF4AndWithTwoEndTelegramsF1, ()) {
  NetworkDescription network;
  network.rules.bit_rate = *rc::gen::element<std::int64_t>(500'000, 2'000'000);
  const auto stations = *rc::gen::inRange(0, 20);
  for (int n = 0; n < stations; ++n) {
    StationDescription station{"r" + std::to_string(n), 0x0303, 1.0 * *rc::gen::inRange(0, 400), false, {}};
    if (*rc::gen::arbitrary<bool>()) station.branch.push_back({"l" + std::to_string(n), 0x01BE, 0, true, {}});
    network.stations.push_back(station);
  }
  // Each of the three terms is rounded on its own.
  const auto apart = [&](Formula formula) {
    return std::chrono::abs(structural_cycle_time(network) - cycle_time(formula, timing_input(network)));
  };
  RC_ASSERT(apart(Formula::f4) <= Duration{2});
  network.rules.end_telegrams = 2;
  RC_ASSERT(apart(Formula::f1) <= Duration{2});
}

}  // namespace
}  // namespace fieldproof::interbus
