#include "harness/measure/frequency.hpp"

#include <gtest/gtest.h>

#include <string>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

std::int64_t read(const std::string& text) {
  const auto frequency = Frequency::read(text);
  return frequency ? frequency->millihertz() : -1;
}

TEST(FrequencyTest, IsReadWithItsUnit) {
  EXPECT_EQ(read("50Hz"), 50'000);
  EXPECT_EQ(read("614.25 Hz"), 614'250);
  EXPECT_EQ(read("0.001Hz"), 1);
  EXPECT_EQ(read("1.5kHz"), 1'500'000);
  EXPECT_EQ(read("1000 kHz"), Frequency::kMostMillihertz);
  EXPECT_EQ(read("50.000000Hz"), 50'000);
  EXPECT_EQ(read("1MHz"), Frequency::kMostMillihertz);
  EXPECT_EQ(read("0.5 MHz"), 500'000'000);
  EXPECT_EQ(read("50mHz"), 50);
  EXPECT_EQ(read("1500 mHz"), 1'500);
}

TEST(FrequencyTest, AnythingElseIsNone) {
  for (const char* text :
       {"",         "Hz",      "50",          "50 hz",    "50  Hz", "-50Hz",
        "+1Hz",     "5O Hz",   ".5Hz",        "5.Hz",     "0Hz",    "0.0001Hz",
        "0.0005Hz", "1.2.3Hz", "1000.001kHz", "1.001MHz", "2 MHz",  "0.5mHz",
        "mHz",      "5 mhz",   "1e3Hz",       " 50Hz",    "nanHz",  "99999999999999999999Hz"}) {
    EXPECT_EQ(read(text), -1) << text;
  }
}

TEST(FrequencyTest, PeriodsDoNotAccumulateTheirRounding) {
  const Frequency third = Frequency::from_hertz(3);
  EXPECT_EQ(third.periods(1), kernel::Duration{333'333'333'333});
  EXPECT_EQ(third.periods(3), kernel::kSecond);
  EXPECT_EQ(third.periods(3'000'000), 1'000'000 * kernel::kSecond);
}

TEST(FrequencyTest, IsToldAsItIsRead) {
  for (const char* text : {"50 Hz", "614.25 Hz", "0.001 Hz", "1500 Hz"}) {
    EXPECT_EQ(describe(*Frequency::read(text)), text);
  }
  EXPECT_THROW(Frequency::from_millihertz(0), kernel::BrokenInvariant);
  EXPECT_THROW(Frequency::from_millihertz(Frequency::kMostMillihertz + 1), kernel::BrokenInvariant);
}

}  // namespace
}  // namespace fieldproof::measure
