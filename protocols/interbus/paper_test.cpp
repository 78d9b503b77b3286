#include "protocols/interbus/paper.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

void expect_equal(const std::vector<StationDescription>& built, const std::vector<StationDescription>& read) {
  ASSERT_EQ(built.size(), read.size());
  for (std::size_t n = 0; n < built.size(); ++n) {
    EXPECT_EQ(built[n].name, read[n].name);
    EXPECT_EQ(built[n].id_code, read[n].id_code);
    EXPECT_EQ(built[n].cable_m, read[n].cable_m);
    EXPECT_EQ(built[n].is_local, read[n].is_local);
    expect_equal(built[n].branch, read[n].branch);
  }
}

void expect_equal(const NetworkDescription& built, const char* file) {
  const auto read =
      NetworkDescription::load(std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "examples" / file);
  EXPECT_FALSE(check(built).has_value());
  EXPECT_EQ(built.name, read.name);
  EXPECT_EQ(built.formula, read.formula);
  EXPECT_EQ(built.cycle_time, read.cycle_time);
  EXPECT_EQ(built.rules.bit_rate, read.rules.bit_rate);
  EXPECT_EQ(built.rules.end_telegrams, read.rules.end_telegrams);
  EXPECT_EQ(built.rules.software_time, read.rules.software_time);
  expect_equal(built.stations, read.stations);
  ASSERT_EQ(built.copy.size(), 1U);
  ASSERT_EQ(read.copy.size(), 1U);
  EXPECT_EQ(built.copy[0].from, read.copy[0].from);
  EXPECT_EQ(built.copy[0].input_word, read.copy[0].input_word);
  EXPECT_EQ(built.copy[0].to, read.copy[0].to);
  EXPECT_EQ(built.copy[0].output_word, read.copy[0].output_word);
}

TEST(PaperTest, NetworksAreThoseOfTheExamples) {
  expect_equal(paper_network(), "paper.json");
  expect_equal(paper_network_as_printed(), "paper_printed_reading.json");
}

TEST(PaperTest, TheTwoReadingsAreTwoTelegramsApart) {
  EXPECT_EQ(structural_cycle_time(paper_network()), 755 * kernel::kMicrosecond);
  EXPECT_EQ(structural_cycle_time(paper_network_as_printed()) - structural_cycle_time(paper_network()),
            59'800 * kernel::kNanosecond);
}

}  // namespace
}  // namespace fieldproof::interbus
