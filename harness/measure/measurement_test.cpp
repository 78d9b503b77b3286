#include "harness/measure/measurement.hpp"

#include <gtest/gtest.h>

namespace fieldproof::measure {
namespace {

TEST(MeasurementTest, AgreesAsItsWorstSeriesDoes) {
  Measurement measurement;
  measurement.tolerance_percent = 2;
  EXPECT_EQ(agreement(measurement), Agreement::holds);
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

}  // namespace
}  // namespace fieldproof::measure
