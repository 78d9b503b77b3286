#include "protocols/token_bus/channel_selection.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <utility>

namespace fieldproof::token_bus {
namespace {

using enum Channel;
using enum Carried;

// Time is octets of a slot time of 28; the skew is one octet.
class OneSelection : public testing::Test, private ChannelUser {
 protected:
  OneSelection() { selection_.wire(*this); }

  static kernel::Time at(std::int64_t octet) { return kernel::kStart + octets(Rules{}, octet); }
  void begins(Channel channel, std::int64_t octet) { selection_.on_start_delimiter(channel, at(octet)); }
  void is_bad(Channel channel, std::int64_t octet) { selection_.on_bad_signal(channel, at(octet)); }
  void ends(Channel channel, std::int64_t octet, Carried carried = clean) {
    selection_.on_end(channel, carried, at(octet));
  }
  void passes(std::int64_t octet) { selection_.on_time(at(octet)); }
  // The same on both, as each carries it; 100 octets later the next one may begin.
  void both_carry(Carried on_a, Carried on_b) {
    begins(A, now_);
    begins(B, now_);
    ends(A, now_ + 20, on_a);
    ends(B, now_ + 20, on_b);
    now_ += 100;
    passes(now_);
  }
  void one_carries(Channel channel, Carried carried = clean) {
    begins(channel, now_);
    ends(channel, now_ + 20, carried);
    now_ += 100;
    passes(now_);
  }
  std::string take() { return std::exchange(text_, {}); }

  static constexpr Channel A = a;
  static constexpr Channel B = b;
  ChannelSelection selection_{Rules{}, ChannelRules{}};
  std::int64_t now_ = 1'000;

 private:
  std::int64_t octets_of(kernel::Time when) { return (when - kernel::kStart) / octets(Rules{}, 1); }
  void on_selected(Channel channel, kernel::Time start_delimiter) override {
    text_ += std::string(text_of(channel)) + "@" + std::to_string(octets_of(start_delimiter)) + " ";
  }
  void on_channel_event(const ChannelEvent& event, kernel::Time when) override {
    text_ += "[" + std::string(text_of(event.channel)) + " " + std::string(text_of(event.kind)) + " " +
             std::to_string(octets_of(when)) + "] ";
  }

  std::string text_;
};

TEST_F(OneSelection, BeginsWithAAndStaysWithWhatItHas) {
  both_carry(clean, clean);
  both_carry(clean, clean);
  EXPECT_EQ(take(), "A@1000 A@1100 ");
  EXPECT_EQ(selection_.serving(), std::nullopt);
}

TEST_F(OneSelection, WaitsForThePreferredChannelAsLongAsTheSkew) {
  begins(B, 10);
  EXPECT_EQ(selection_.next_time(), at(11));
  begins(A, 11);
  EXPECT_EQ(take(), "A@11 ");
  ends(B, 30);
  ends(A, 31);
  begins(B, 100);
  passes(101);
  EXPECT_EQ(take(), "B@100 ");
  begins(A, 102);
  EXPECT_EQ(selection_.serving(), B);
  ends(B, 120);
  ends(A, 122);
  passes(200);
  EXPECT_EQ(take(), "") << "later than the skew is no fault";
  EXPECT_EQ(selection_.preferred(), B) << "it was selected last";
}

TEST_F(OneSelection, FindsAFaultWhereNoStartDelimiterComesForASlotTime) {
  one_carries(B);
  EXPECT_EQ(take(), "B@1000 [A no start delimiter 1028] ");
  one_carries(B);
  EXPECT_EQ(take(), "B@1100 ") << "reported once";
  EXPECT_TRUE(selection_.has_fault(A));
  begins(B, now_);
  ends(B, now_ + 11);
  begins(A, now_ + 28);
  EXPECT_EQ(selection_.next_time(), kernel::kNever) << "within the slot time it is none, and the same again";
}

TEST_F(OneSelection, NeverLeavesATransmissionThatMayComplete) {
  begins(A, 10);
  begins(B, 10);
  ends(B, 15, spoiled);
  begins(B, 16);
  EXPECT_EQ(take(), "A@10 ");
  begins(A, 20);
  EXPECT_EQ(selection_.serving(), A) << "a second frame of the same transmission";
  ends(A, 40);
  EXPECT_EQ(take(), "");
}

TEST_F(OneSelection, TakesTheNextTransmissionWhereTheServingOneIsSpoiledOrEndless) {
  begins(A, 10);
  begins(B, 10);
  is_bad(A, 20);
  ends(B, 30);
  EXPECT_EQ(take(), "A@10 [A bad signal 21] ");
  EXPECT_EQ(selection_.serving(), A);
  EXPECT_EQ(selection_.preferred(), B);
  begins(B, 60);
  EXPECT_EQ(take(), "B@60 ");
  ends(B, 80);
  selection_.reset();
  begins(A, 1'000);
  begins(B, 1'000);
  ends(B, 1'020);
  begins(B, 9'193);
  passes(9'200);
  EXPECT_EQ(selection_.serving(), A);
  ends(B, 9'200);
  begins(B, 9'300);
  passes(9'301);
  EXPECT_EQ(selection_.serving(), B);
}

TEST_F(OneSelection, BadSignalOfBothIsACollision) {
  for (const Channel first : kChannels) {
    begins(A, now_);
    begins(B, now_);
    is_bad(first, now_ + 10);
    is_bad(other_than(first), now_ + 11);
    ends(A, now_ + 20, spoiled);
    ends(B, now_ + 20, spoiled);
    now_ += 100;
    passes(now_);
  }
  EXPECT_EQ(take(), "A@1000 A@1100 ");
}

TEST_F(OneSelection, BadSignalCountsUpToASlotTimeAfterTheOtherStartDelimiter) {
  begins(A, 10);
  begins(B, 10);
  is_bad(A, 39);
  ends(A, 50, spoiled);
  ends(B, 50);
  EXPECT_EQ(take(), "A@10 ");
  begins(A, 100);
  begins(B, 100);
  is_bad(A, 128);
  EXPECT_EQ(selection_.next_time(), at(129));
  passes(129);
  EXPECT_EQ(take(), "A@100 [A bad signal 129] ");
}

TEST_F(OneSelection, NoiseInPlaceOfAStartDelimiterIsBadSignal) {
  is_bad(A, 8);
  begins(B, 10);
  is_bad(A, 12);
  passes(40);
  EXPECT_EQ(take(), "B@10 [A bad signal 13] ");
}

TEST_F(OneSelection, ThreeSpoiledInARowAreAFault) {
  both_carry(spoiled, clean);
  both_carry(spoiled, clean);
  both_carry(clean, clean);
  both_carry(spoiled, clean);
  both_carry(spoiled, clean);
  EXPECT_EQ(take(), "A@1000 A@1100 A@1200 A@1300 A@1400 ");
  both_carry(spoiled, spoiled);
  both_carry(spoiled, neither);
  EXPECT_EQ(take(), "A@1500 A@1600 ") << "what the other does not carry well says nothing";
  both_carry(spoiled, clean);
  EXPECT_EQ(take(), "A@1700 [A frame errors 1720] ");
  both_carry(spoiled, clean);
  EXPECT_EQ(take(), "B@1800 ");
}

// It is not compared with what both carry later: that has its own other half.
TEST_F(OneSelection, WhatOneCarriesAloneHasNoOther) {
  both_carry(clean, spoiled);
  both_carry(clean, spoiled);
  one_carries(B);
  begins(A, now_);
  ends(A, now_ + 15);
  begins(B, now_ + 20);
  ends(B, now_ + 40);
  now_ += 100;
  passes(now_);
  both_carry(clean, spoiled);
  EXPECT_FALSE(selection_.has_fault(B)) << "a clean one came in between: " << take();
  both_carry(clean, spoiled);
  both_carry(clean, spoiled);
  EXPECT_TRUE(selection_.has_fault(B));
}

TEST_F(OneSelection, ThreeCleanInARowEndAFault) {
  one_carries(A);
  EXPECT_EQ(take(), "A@1000 [B no start delimiter 1028] ");
  both_carry(clean, clean);
  both_carry(clean, clean);
  both_carry(clean, spoiled);
  both_carry(clean, clean);
  both_carry(clean, neither);
  both_carry(clean, clean);
  EXPECT_TRUE(selection_.has_fault(B));
  both_carry(clean, clean);
  EXPECT_EQ(take(), "A@1100 A@1200 A@1300 A@1400 A@1500 A@1600 A@1700 [B clean again 1720] ");
  one_carries(A);
  EXPECT_EQ(take(), "A@1800 [B no start delimiter 1828] ");
}

TEST_F(OneSelection, ATransmissionThatEndsWhileItWaitsIsSelectedAllTheSame) {
  selection_.on_start_delimiter(B, at(10));
  selection_.on_end(B, spoiled, at(10));
  passes(11);
  EXPECT_EQ(take(), "B@10 ");
  EXPECT_EQ(selection_.serving(), std::nullopt);
}

// Whatever is on both, at most a skew apart: nobody changes, and nothing is reported.
RC_GTEST_PROP(ChannelSelection, WhatBothShowIsNoFaultAndNoChange, ()) {
  struct Quiet final : ChannelUser {
    void on_selected(Channel channel, kernel::Time) override { RC_ASSERT(channel == a); }
    void on_channel_event(const ChannelEvent&, kernel::Time) override { RC_FAIL("an event"); }
  } user;
  ChannelSelection selection{Rules{}, ChannelRules{}};
  selection.wire(user);
  const Channel first = *rc::gen::element(a, b);
  const kernel::Duration late = octets(Rules{}, 1) / 8 * *rc::gen::inRange(0, 9);
  kernel::Time now = kernel::kStart;
  const auto frames = *rc::gen::container<std::vector<std::pair<unsigned, Carried>>>(
      rc::gen::pair(rc::gen::inRange(9U, 60U), rc::gen::element(clean, spoiled, neither)));
  for (const auto& [length, carried] : frames) {
    const kernel::Duration frame = octets(Rules{}, length);
    const auto on_both = [&](kernel::Time when, const auto& act) {
      act(first, when);
      act(other_than(first), when + late);
    };
    on_both(now, [&](Channel one, kernel::Time when) { selection.on_start_delimiter(one, when); });
    if (carried == spoiled) {
      on_both(now + frame / 2, [&](Channel one, kernel::Time when) { selection.on_bad_signal(one, when); });
    }
    on_both(now + frame, [&](Channel one, kernel::Time when) { selection.on_end(one, carried, when); });
    now += frame + octets(Rules{}, 8);
    selection.on_time(now);
  }
}

TEST(Carried, IsTheWorstOfItsFrames) {
  const auto of = [](ReceptionKind one, ReceptionKind two) {
    return carried_by(std::vector<Reception>{{.kind = one}, {.kind = two}});
  };
  using enum ReceptionKind;
  EXPECT_EQ(of(frame, frame), clean);
  EXPECT_EQ(of(frame, fcs_error), spoiled);
  EXPECT_EQ(of(fragment, e_bit_error), spoiled);
  EXPECT_EQ(of(e_bit_error, fragment), spoiled);
  EXPECT_EQ(of(frame, e_bit_error), neither);
  EXPECT_EQ(of(too_long, frame), neither);
}

}  // namespace
}  // namespace fieldproof::token_bus
