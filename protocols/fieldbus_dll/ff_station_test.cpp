#include "protocols/fieldbus_dll/ff_station.hpp"

#include <gtest/gtest.h>

#include "protocols/fieldbus_dll/test_link.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr FfAddress kPublished = 0x2120;

FfConfiguration basic() {
  FfConfiguration configuration;
  configuration.node = kNode;
  configuration.published = {kPublished, 0x2121};
  configuration.subscribed = {0x2220};
  return configuration;
}

class FfStationTest : public testing::Test {
 protected:
  FfStationTest() : user_(link_.add(station_)) {
    link_.wait(20);
    link_.say(activation(kNode));
    link_.wait(20);
    EXPECT_EQ(user_.take(), "activated 33\n");
  }
  void submit(Priority priority, Octets octets, FfAddress to = 0x2230) {
    ASSERT_TRUE(station_.submit({priority, to, std::move(octets)}, link_.now()));
    link_.refresh();
  }
  // What is said after it, within 200 octets.
  std::string behind(const FfDlpdu& dlpdu) {
    link_.say(dlpdu);
    link_.wait(200);
    const std::string all = link_.heard();
    std::string without_times;
    for (std::size_t at = 0; at < all.size();) {
      const std::size_t end = all.find('\n', at);
      without_times += all.substr(all.find(' ', at) + 1, end - all.find(' ', at));
      at = end + 1;
    }
    return without_times;
  }

  FfTestLink link_;
  FfStation station_{basic()};
  FfTestLink::User& user_;
};

TEST_F(FfStationTest, SendsByPriorityAndReturnsTheTokenWithItsLastFrame) {
  submit(Priority::time_available, {3});
  submit(Priority::normal, {2});
  submit(Priority::urgent, {1});
  EXPECT_EQ(behind(pt(kNode, Priority::normal, 500)),
            "DT1 urgent to 2230 from 2101: 01\nDT1 normal to 2230 from 2101 final: 02\n");
  EXPECT_EQ(behind(pt(kNode, Priority::urgent, 500)), "RT\n");
  EXPECT_EQ(behind(pt(kNode, Priority::time_available, 500)),
            "DT1 time-available to 2230 from 2101 final: 03\n");
}

TEST_F(FfStationTest, SendsWhatFitsAndNothingElse) {
  submit(Priority::normal, Octets(50));  // 50 + 5 + 2 octets in a frame of 60
  submit(Priority::normal, Octets(50));
  EXPECT_EQ(behind(pt(kNode, Priority::normal, 67)), "RT\n");
  EXPECT_EQ(behind(pt(kNode, Priority::normal, 68 + 8 + 59)).substr(0, 34),
            "DT1 normal to 2230 from 2101 final");
  EXPECT_EQ(behind(pt(kNode, Priority::normal, 68)).substr(0, 34), "DT1 normal to 2230 from 2101 final");
  EXPECT_EQ(behind(pt(kNode, Priority::normal, 13)), "");
}

TEST_F(FfStationTest, IsSilentWithoutAToken) {
  submit(Priority::urgent, {1});
  EXPECT_EQ(behind(pt(0x22, Priority::normal, 500)), "");
  EXPECT_EQ(behind({.type = FfType::pn, .node = 0x22}), "");
  EXPECT_EQ(behind({.type = FfType::idle}), "");
}

TEST_F(FfStationTest, ASchedulerThatSpeaksHasTakenTheTokenBack) {
  submit(Priority::urgent, {1});
  link_.say(pt(kNode, Priority::normal, 500));
  link_.wait(2);
  EXPECT_EQ(behind(pt(0x22, Priority::normal, 500)), "");
  EXPECT_EQ(station_.state(), FfState::idle);
}

TEST_F(FfStationTest, AnswersAProbe) {
  EXPECT_EQ(behind({.type = FfType::pn, .node = kNode}), "PR 21\n");
}

TEST_F(FfStationTest, PublishesItsBufferAndHowOftenItWasWritten) {
  const FfDlpdu cd{.type = FfType::cd, .priority = Priority::normal, .destination = kPublished};
  EXPECT_EQ(behind(cd), "SR, nothing written final\n");
  ASSERT_TRUE(station_.write(kPublished, {1, 2}, link_.now()));
  EXPECT_EQ(behind(cd), "DT3 normal from 2120 final, write 1: 01 02\n");
  EXPECT_EQ(behind(cd), "DT3 normal from 2120 final, write 1: 01 02\n");
  ASSERT_TRUE(station_.write(kPublished, {3, 4}, link_.now()));
  EXPECT_EQ(behind(cd), "DT3 normal from 2120 final, write 2: 03 04\n");
  EXPECT_EQ(behind({.type = FfType::cd, .priority = Priority::normal, .destination = 0x2155}),
            "SR, unknown address final\n");
  EXPECT_EQ(behind({.type = FfType::cd, .priority = Priority::normal, .destination = 0x2220}), "");
  EXPECT_FALSE(station_.write(0x2155, {1}, link_.now()));
}

TEST_F(FfStationTest, DeliversWhatItIsMeantToHear) {
  EXPECT_EQ(behind({.type = FfType::dt3, .priority = Priority::normal, .source = 0x2220, .writes = 9}), "");
  EXPECT_EQ(behind({.type = FfType::dt3, .priority = Priority::normal, .source = 0x2221}), "");
  const FfDlpdu dt1{
      .type = FfType::dt1, .priority = Priority::normal, .destination = 0x2130, .source = 0x2230};
  EXPECT_EQ(behind(dt1), "");
  FfDlpdu other = dt1;
  other.destination = 0x2330;
  EXPECT_EQ(behind(other), "");
  EXPECT_EQ(user_.take(), "DT3 normal from 2220, write 9\nDT1 normal to 2130 from 2230\n");
}

TEST_F(FfStationTest, KeepsTheTimeOfTheLink) {
  const kernel::Time before = link_.now();
  link_.say({.type = FfType::td, .link_time = 1'000'000});
  EXPECT_EQ(station_.link_time(link_.now()), 1'000'000U);
  link_.wait(125);  // 32 ms
  EXPECT_EQ(station_.link_time(link_.now()), 1'001'024U);
  EXPECT_LT(before, link_.now());
  link_.say({.type = FfType::td, .link_time = 0xFFFF'FFFF'FFFF});
  EXPECT_EQ(station_.link_time(link_.now()), 0xFFFF'FFFF'FFFFU);
}

TEST(FfStationRules, AreRefusedWhenTheyCannotBe) {
  FfConfiguration configuration = basic();
  configuration.rules.link.inter_pdu_delay_octets = 25;  // (4 - 1) * 8 = 24
  FfStation station(configuration);
  FfTestLink link;
  FfTestLink::User& user = link.add(station);
  EXPECT_EQ(station.state(), FfState::stopped);
  link.wait(20);
  link.say(activation(kNode));
  link.say({.type = FfType::pn, .node = kNode});
  link.wait(100);
  EXPECT_EQ(link.heard(), "");
  EXPECT_EQ(user.take(), "");
  EXPECT_EQ(*impossible(configuration.rules), "inter_pdu_delay_octets is 25, and may be 0 to 24");
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
