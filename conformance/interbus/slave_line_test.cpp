#include "conformance/interbus/slave_line.hpp"

#include <gtest/gtest.h>

#include "harness/segment/segment.hpp"

namespace fieldproof::conformance {
namespace {

using kernel::kMillisecond;
using kernel::kStart;

// A view of a link that nobody hears.
class LineViewTest : public testing::Test, private segment::Station {
 protected:
  LineViewTest()
      : link_(segment_.connect("line", segment_.attach(*this, "end"), 0, kernel::Duration{})),
        view_(segment_, line::shared_telegram_code(rules_.telegram), rules_.bit_rate) {
    link_.tap_driven(view_);
  }
  // Of one status telegram.
  void drive(kernel::Time start) {
    TrainWriter writer(rules_);
    writer.status(1);
    line::Waveform wave{start, rules_.bit_rate, writer.levels()};
    link_.drive(wave);
  }

  interbus::Rules rules_;
  segment::Segment segment_;
  segment::Link& link_;
  LineView view_;

 private:
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }
};

TEST_F(LineViewTest, WhatIsDrivenAheadIsThereWhenItsTimeHasCome) {
  drive(kStart);
  drive(kStart + kMillisecond);
  EXPECT_EQ(view_.status_count(), 1U);
  EXPECT_EQ(view_.waves().size(), 1U);
  segment_.run_until(kStart + kMillisecond);
  EXPECT_EQ(view_.status_count(), 2U);
  EXPECT_EQ(view_.waves().size(), 2U);
}

TEST_F(LineViewTest, WhatIsDrivenAheadIsNotCleared) {
  drive(kStart);
  drive(kStart + kMillisecond);
  view_.clear();
  EXPECT_EQ(view_.status_count(), 0U);
  segment_.run_until(kStart + kMillisecond);
  ASSERT_EQ(view_.telegrams().size(), 1U);
  EXPECT_EQ(view_.start_of(view_.telegrams().front()), kStart + kMillisecond);
}

}  // namespace
}  // namespace fieldproof::conformance
