#include "protocols/token_bus/channel_pair.hpp"

#include <gtest/gtest.h>

#include <string>

#include "harness/segment/medium.hpp"

namespace fieldproof::token_bus {
namespace {

// A MAC on two lines, and a place beyond on each of them.
class PairOfLines : public testing::Test {
 protected:
  class Mac final : public segment::Station {
   public:
    void receive(segment::PortIndex, const line::Waveform& reception) override {
      for (const Reception& one : FrameReader(Rules{}).read(reception))
        text += one.kind == ReceptionKind::frame ? describe(*frame_of(one.octets, Rules{}), Rules{}) + ", "
                                                 : std::string(text_of(one.kind)) + ", ";
      end = reception.end();
    }
    void on_activity(segment::PortIndex, bool begins, kernel::Time) override { text += begins ? "<" : ">"; }
    void on_time(kernel::Time) override {}
    kernel::Time next_time() const override { return kernel::kNever; }

    std::string text;
    kernel::Time end{};
  };

  PairOfLines() {
    const std::size_t number = segment_.attach(pair_, "channels");
    segment::MediumPort& a = a_.attach("mac/A", number, 0, {});
    segment::MediumPort& b = b_.attach("mac/B", number, 1, {});
    a.sense_activity();
    b.sense_activity();
    pair_.wire(a, b);
  }

  static line::Waveform wave(kernel::Time start, const Frame& frame) {
    return {start, 2 * Rules{}.phy_bit_rate, levels_of(frame, Rules{})};
  }
  static Frame token(Address from) { return {.kind = FrameKind::token, .destination = 4, .source = from}; }
  void carry(const std::optional<Frame>& on_a, const std::optional<Frame>& on_b,
             std::size_t levels_of_a = 0) {
    const kernel::Time start = segment_.now();
    if (on_a) {
      line::Waveform sent = wave(start, *on_a);
      if (levels_of_a != 0) sent.levels = sent.levels.slice(0, levels_of_a);
      beyond_a_.drive(sent);
    }
    if (on_b) {
      line::Waveform sent = wave(start, *on_b);
      beyond_b_.drive(sent);
    }
    segment_.run_for(200 * kernel::kMicrosecond);
  }
  std::string take() { return std::exchange(mac_.text, {}); }

  segment::Segment segment_;
  kernel::Random random_{1};
  segment::Medium a_{segment_, "A", segment::ContentionRule::noise, random_};
  segment::Medium b_{segment_, "B", segment::ContentionRule::noise, random_};
  segment::MediumPort& beyond_a_ = a_.listen("beyond/A", {});
  segment::MediumPort& beyond_b_ = b_.listen("beyond/B", {});
  Mac mac_;
  std::string events_;
  ChannelReader reader_{Rules{}};
  ChannelPair pair_{segment_, segment_.attach(mac_, "mac"), Rules{}, reader_,
                    [this](const ChannelEvent& event, kernel::Time) {
                      events_ +=
                          std::string(text_of(event.channel)) + " " + std::string(text_of(event.kind)) + ", ";
                    }};
};

TEST_F(PairOfLines, GivesWhatBothHaveOnceAndLateByTheSkew) {
  carry(token(2), token(2));
  EXPECT_EQ(take(), "<" + describe(token(2), Rules{}) + ", >");
  EXPECT_EQ(mac_.end, kernel::kStart + frame_time(Rules{}, 0) + mac_symbols(Rules{}, 8));
  EXPECT_EQ(events_, "");
}

TEST_F(PairOfLines, GivesTheOtherWhereOneIsDeadAndSaysSo) {
  carry(std::nullopt, token(2));
  carry(token(6), std::nullopt);
  EXPECT_EQ(take(), "<" + describe(token(2), Rules{}) + ", ><" + describe(token(6), Rules{}) + ", >");
  EXPECT_EQ(events_, "A no start delimiter, B no start delimiter, ");
  EXPECT_TRUE(pair_.has_fault(Channel::a));
}

// What has begun on a channel is not continued by the other one.
TEST_F(PairOfLines, NeverChangesWithinAFrame) {
  carry(token(2), token(2), 300);
  EXPECT_EQ(take(), "<frame fragment, >");
  carry(std::nullopt, token(2));
  carry(token(6), token(6));
  EXPECT_EQ(take(), "<" + describe(token(2), Rules{}) + ", ><" + describe(token(6), Rules{}) + ", >");
}

TEST_F(PairOfLines, SendsOnBoth) {
  class Ear final : public segment::Tap {
   public:
    void on_wave(const line::Waveform&) override { ++waves; }
    unsigned waves = 0;
  } on_a, on_b;
  beyond_a_.tap_arrived(on_a);
  beyond_b_.tap_arrived(on_b);
  line::Waveform sent = wave(segment_.now(), token(2));
  pair_.drive(sent);
  segment_.run_for(kernel::kMillisecond);
  EXPECT_EQ(on_a.waves, 1U);
  EXPECT_EQ(on_b.waves, 1U);
  EXPECT_EQ(take(), "") << "a MAC does not receive itself";
}

}  // namespace
}  // namespace fieldproof::token_bus
