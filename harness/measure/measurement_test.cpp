#include "harness/measure/measurement.hpp"

#include <gtest/gtest.h>

namespace fieldproof::measure {
namespace {

TEST(MeasurementTest, AgreesAsItsWorstSeriesDoes) {
  Measurement measurement;
  measurement.tolerance_percent = 2;
  Series series;
  series.comparisons.push_back({"cycle time", "us", 100, 101, 100, "of the theory"});
  measurement.series.push_back(series);
  EXPECT_EQ(agreement(measurement), Agreement::holds);
  series.comparisons.front().measured = 103;
  measurement.series.push_back(series);
  EXPECT_EQ(agreement(measurement), Agreement::differs);
  measurement.tolerance_percent = 4;
  EXPECT_EQ(agreement(measurement), Agreement::holds);
}

TEST(MeasurementTest, IsOpenWhereNothingWasComparedWhileQuiet) {
  Measurement measurement;
  measurement.tolerance_percent = 2;
  EXPECT_EQ(agreement(measurement), Agreement::open);
  Series series;
  series.comparisons = {{"cycle time", "us", 100, 100, 100, "of the theory", 0, false, Phase::burst}};
  measurement.series.push_back(series);
  EXPECT_EQ(agreement(measurement), Agreement::open);
}

// What bursts make of a cycle is told apart, and refutes no theory of a quiet network.
TEST(MeasurementTest, EachPhaseAgreesByItself) {
  Measurement measurement;
  measurement.tolerance_percent = 2;
  Series series;
  series.comparisons = {{"cycle time", "us", 100, 101, 100, "of the theory"},
                        {"cycle time", "us", 100, 900, 100, "of the theory", 0, false, Phase::burst}};
  measurement.series.push_back(series);
  EXPECT_EQ(agreement(measurement), Agreement::holds);
  EXPECT_EQ(agreement(measurement, Phase::quiet), Agreement::holds);
  EXPECT_EQ(agreement(measurement, Phase::burst), Agreement::differs);
  EXPECT_EQ(agreement(measurement, Phase::recovery), std::nullopt);
}

}  // namespace
}  // namespace fieldproof::measure
