#include "harness/measure/two_channel_recorder.hpp"

#include <gtest/gtest.h>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

using kernel::kMillisecond;
using kernel::kStart;

class TwoChannelRecorderTest : public testing::Test {
 protected:
  TwoChannelRecorderTest() { generator_.trigger(kStart, 10); }

  kernel::Time at(std::int64_t milliseconds) const { return kStart + milliseconds * kMillisecond; }

  SignalGenerator generator_{{Frequency::from_hertz(50)}};  // edges at 0, 10, 20 ... ms
  TwoChannelRecorder recorder_{generator_};
  EdgeCode code_;
};

TEST_F(TwoChannelRecorderTest, TheInputIsTheGenerator) {
  EXPECT_EQ(recorder_.input(kStart - kMillisecond), code_.word(0));
  EXPECT_EQ(recorder_.input(at(5)), code_.word(1));
  EXPECT_EQ(recorder_.input(at(10)), code_.word(2));
}

TEST_F(TwoChannelRecorderTest, AnOutputWordIsTheEdgeThatItShows) {
  recorder_.on_output(at(2), code_.word(1));
  recorder_.on_output(at(3), code_.word(1));   // nothing new
  recorder_.on_output(at(34), code_.word(4));  // two edges were not shown
  ASSERT_EQ(recorder_.output_edges().size(), 2U);
  EXPECT_EQ(recorder_.output_edges()[0].number, 1U);
  EXPECT_EQ(recorder_.output_edges()[1].number, 4U);
  EXPECT_EQ(recorder_.output_edges()[1].when, at(34));
  EXPECT_TRUE(recorder_.foreign_words().empty());
}

TEST_F(TwoChannelRecorderTest, WhatTheInputDidNotShowIsForeign) {
  recorder_.on_output(at(22), code_.word(3));
  recorder_.on_output(at(23), code_.word(2));                                     // older than what was shown
  recorder_.on_output(at(24), code_.word(4));                                     // comes at 30 ms only
  recorder_.on_output(at(25), static_cast<std::uint16_t>(code_.word(3) ^ 0x40));  // a wrong bit
  recorder_.on_output(at(26), code_.word(3));                                     // back again: no edge
  EXPECT_EQ(recorder_.foreign_words().size(), 3U);
  EXPECT_EQ(recorder_.output_edges().size(), 1U);
}

TEST_F(TwoChannelRecorderTest, TimeDoesNotRunBackwards) {
  recorder_.on_output(at(12), code_.word(1));
  EXPECT_THROW(recorder_.on_output(at(11), code_.word(1)), kernel::BrokenInvariant);
}

}  // namespace
}  // namespace fieldproof::measure
