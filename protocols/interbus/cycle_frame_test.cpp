#include "protocols/interbus/cycle_frame.hpp"

#include <gtest/gtest.h>

#include <array>

#include "protocols/interbus/cycle_supervision.hpp"
#include "protocols/interbus/returned_cycle.hpp"

namespace fieldproof::interbus {
namespace {

std::vector<line::Telegram> telegrams_of(const CycleWriter& writer, const line::Levels& levels) {
  std::vector<line::Telegram> telegrams;
  writer.code().decode(levels, 0, [&](const line::Telegram& telegram) { telegrams.push_back(telegram); });
  return telegrams;
}

TEST(CycleWriter, puts_telegrams_at_the_mean_pitch_without_drift) {
  const Rules rules;
  const CycleWriter writer(rules);
  const std::vector<std::uint8_t> octets(1026, 0x5A);
  line::Levels levels;
  writer.append_frame(levels, octets, 0x1234, kDataCycle);
  const auto telegrams = telegrams_of(writer, levels);
  ASSERT_EQ(telegrams.size(), writer.telegram_count(1024));
  for (std::size_t k = 0; k < telegrams.size(); ++k) {
    EXPECT_EQ(telegrams[k].level, 13 * k + k * 1950 / 1000) << k;
  }
  EXPECT_EQ(levels.size(), telegrams.size() * 14950 / 1000);
  // 10 telegrams of 14.95 bit at 500 kbit/s.
  EXPECT_EQ(writer.frame_time(10), 299 * kernel::kMicrosecond);
}

TEST(CycleWriter, writes_phases_check_status_and_end_telegrams) {
  Rules rules;
  rules.end_telegrams = 2;
  const CycleWriter writer(rules);
  const std::array<std::uint8_t, 4> octets{0xA5, 0x5A, 0x12, 0x34};
  line::Levels levels;
  writer.append_frame(levels, octets, 0xBEEF, kIdCycle);
  const auto telegrams = telegrams_of(writer, levels);
  ASSERT_EQ(telegrams.size(), 10U);
  const std::array<std::uint8_t, 10> expected{0xA5, 0x5A, 0x12, 0x34, 0xBE, 0xEF, 0, 0, 0, 0};
  for (std::size_t k = 0; k < telegrams.size(); ++k) {
    EXPECT_EQ(telegrams[k].data, expected.at(k));
    EXPECT_EQ(telegrams[k].header, k < 4 ? (line::kDataTelegram | line::kSelect)
                                         : (line::kDataTelegram | line::kSelect | line::kControl));
  }
}

TEST(CycleWriter, status_telegrams_end_before_the_next_cycle) {
  const Rules rules;
  const CycleWriter writer(rules);
  for (std::size_t end = 0; end < 600; ++end) {
    line::Levels levels;
    writer.append_status(levels, end);
    EXPECT_LE(levels.size(), end);
    const std::size_t count = telegrams_of(writer, levels).size();
    EXPECT_EQ(count, end < 5 ? 0 : (end - 5) / 6 + 1) << end;
  }
}

TEST(ReturnedCycle, keeps_octets_and_what_differs) {
  ReturnedCycle returned;
  const CycleHeaders headers = kDataCycle;
  returned.begin(6, 2, false);
  for (std::uint8_t n = 0; n < 6; ++n) {
    const std::uint8_t header = n < 2 ? headers.transfer : headers.check;
    EXPECT_EQ(returned.add({.level = 0, .header = header, .data = n}), n == 5);
  }
  returned.finish();
  EXPECT_TRUE(returned.has_exact_count() && returned.is_in_phase() && !returned.is_stop_missing());
  EXPECT_EQ(returned.word(0), 0x0001);
  EXPECT_EQ(returned.check(), 0x0203);
  EXPECT_EQ(returned.status(), 0x0405);
  returned.add({.level = 0, .header = headers.check, .data = 9});
  EXPECT_FALSE(returned.has_exact_count());
  EXPECT_EQ(returned.count(), 7U);

  returned.begin(6, 2, false);
  returned.add({.level = 0, .header = headers.check, .data = 1});
  EXPECT_FALSE(returned.is_in_phase());
  returned.add_broken();
  EXPECT_TRUE(returned.is_stop_missing());
  returned.finish();
  EXPECT_FALSE(returned.has_exact_count());
  EXPECT_EQ(returned.status(), 0);
}

TEST(CycleSupervision, quality_bit_needs_the_whole_number_within_the_window) {
  Rules rules;
  rules.quality_bad_cycles = 3;
  rules.quality_window_cycles = 10;
  CycleSupervision supervision(rules);
  // Bad cycles 1, 6 and 10 lie within ten cycles.
  for (int n = 1; n <= 10; ++n) {
    EXPECT_FALSE(supervision.quality_bit());
    supervision.count_data_cycle(n != 1 && n != 6 && n != 10);
  }
  EXPECT_TRUE(supervision.quality_bit());
  supervision.count_data_cycle(true);  // the first one leaves the window
  EXPECT_FALSE(supervision.quality_bit());
  supervision.count_data_cycle(false);
  EXPECT_TRUE(supervision.quality_bit());
  EXPECT_EQ(supervision.rejected_data_cycles(), 4U);
  EXPECT_EQ(supervision.data_cycles(), 12U);
}

}  // namespace
}  // namespace fieldproof::interbus
