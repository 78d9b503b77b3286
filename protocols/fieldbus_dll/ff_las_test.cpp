#include "protocols/fieldbus_dll/ff_las.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "harness/fault/scripted_channel.hpp"
#include "protocols/fieldbus_dll/test_link.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::int64_t kOctetsPerSecond = 31'250 / 8;

// A link with a scheduler, basic devices and other link masters.
class FfLasTest : public testing::Test {
 protected:
  static FfConfiguration master(std::uint8_t node, bool begins) {
    FfConfiguration configuration;
    configuration.node = node;
    configuration.begins_as_scheduler = begins;
    configuration.schedule = {.version = 1, .macrocycle = 32'000, .items = {}};
    return configuration;
  }
  FfLas& add_master(const FfConfiguration& configuration) {
    FfLas& las = masters_.emplace_back(configuration);
    master_users_.push_back(&link_.add(las));
    return las;
  }
  FfStation& add_device(std::uint8_t node) {
    FfConfiguration configuration;
    configuration.node = node;
    configuration.published = {address_of(node, 0x20)};
    FfStation& station = devices_.emplace_back(configuration);
    device_users_.push_back(&link_.add(station));
    return station;
  }
  static std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  }

  FfTestLink link_;
  std::deque<FfLas> masters_;
  std::deque<FfStation> devices_;
  std::vector<FfTestLink::User*> master_users_;
  std::vector<FfTestLink::User*> device_users_;
};

TEST_F(FfLasTest, FindsTheNodesOfItsLinkAndPassesThemTheToken) {
  add_master(master(0x10, true));
  add_device(0x11);
  add_device(0x13);
  link_.run_to(300);
  EXPECT_EQ(
      link_.heard(),
      "@8 TD 163\n@28 PN 11\n@43 PR 11\n@58 DT1 normal to 1100 from 1000: 01\n"
      "@77 DT1 normal to FFFF from 1000: 02 01 00 00 C0 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 00 00 00 00 00 00 00 00\n"
      "@129 PT normal 11 for 280 octets, first\n@146 RT\n@160 PN 12\n"
      "@199 PT time-available 11 for 280 octets, first\n@216 RT\n@230 PN 13\n@245 PR 13\n"
      "@260 DT1 normal to 1300 from 1000: 01\n");
  link_.run_to(2'000);
  EXPECT_TRUE(masters_[0].live()[0x11] && masters_[0].live()[0x13] && !masters_[0].live()[0x12]);
  EXPECT_EQ(device_users_[1]->take(), "activated 19\n");
  const std::string all = link_.heard();
  EXPECT_EQ(count(all, "no DLPDU"), 0U);
  EXPECT_NE(all.find("PT time-available 13 for 280 octets\n"), std::string::npos);
}

// All addresses that are polled are live: it probes nobody, and not itself.
TEST_F(FfLasTest, ProbesNobodyWhereAllAreLive) {
  FfConfiguration las = master(0x10, true);
  las.rules.first_unpolled = 0x15;
  las.rules.unpolled = 228;
  las.rules.last_node = 0xF8;
  las.live = {0x11, 0x12, 0x13, 0x14};
  add_master(las);
  for (const std::uint8_t node : las.live) add_device(node);
  // Two circulations: who was not activated misses its tokens, and is looked for later on.
  link_.run_to(380);
  const std::string all = link_.heard();
  EXPECT_EQ(count(all, " PN "), 0U) << all;
  EXPECT_GE(count(all, " PT "), 5U) << all;
  EXPECT_GE(count(all, " IDLE"), 1U) << all;
}

TEST_F(FfLasTest, CompelsByItsScheduleToTheTick) {
  FfConfiguration configuration = master(0x10, true);
  configuration.live = {0x11, 0x12};
  // 100 ms; 20.03125 and 60 ms
  configuration.schedule = {.version = 1,
                            .macrocycle = 3'200,
                            .items = {{641, 0x1120, Priority::normal}, {1'920, 0x1220, Priority::urgent}}};
  add_master(configuration);
  FfStation& first = add_device(0x11);
  FfStation& second = add_device(0x12);
  link_.run_to(5);
  link_.say(activation(0x11));
  link_.wait(40);
  first.write(0x1120, {1}, link_.now());
  second.write(0x1220, {2}, link_.now());
  link_.run_to(20 * kOctetsPerSecond);
  const std::string all = link_.heard();
  EXPECT_EQ(count(all, "CD normal to 1120\n"), 200U);
  EXPECT_EQ(count(all, "CD urgent to 1220\n"), 200U);
  EXPECT_GE(count(all, "DT3 normal from 1120 final, write 1: 01"), 199U);
  // 10020.03125 ms are 39140.6 octet durations: told as 39140.
  EXPECT_NE(all.find("@39140 CD normal to 1120\n"), std::string::npos);
}

TEST_F(FfLasTest, RemovesWhoMissesThreeTokensAndFindsItAgain) {
  FfConfiguration configuration = master(0x10, true);
  configuration.live = {0x11};
  add_master(configuration);
  link_.run_to(1'000);
  const std::string told = master_users_[0]->take();
  EXPECT_EQ(told.substr(0, told.find("removed")), "token missed 17\ntoken missed 17\ntoken missed 17\nnode ");
  add_device(0x11);
  link_.run_to(4'000);
  EXPECT_NE(master_users_[0]->take().find("node found 17\n"), std::string::npos);
  EXPECT_TRUE(masters_[0].live()[0x11]);
}

TEST_F(FfLasTest, IsFollowedByTheLowestLinkMasterWhenItFallsSilent) {
  FfConfiguration configuration = master(0x10, true);
  add_master(configuration);
  add_master(master(0x14, false));
  add_master(master(0x12, false));
  add_device(0x20);
  link_.run_to(3'000);
  EXPECT_FALSE(masters_[1].is_scheduler() || masters_[2].is_scheduler());
  link_.heard();
  // From now on nobody hears it, and it hears nobody.
  class Gone final : public segment::Port {
    void drive(line::Waveform& wave) override { wave.levels.clear(); }
  } gone;
  masters_[0].wire(gone, *master_users_[0]);
  link_.run_to(6'000);
  EXPECT_TRUE(masters_[2].is_scheduler());
  EXPECT_FALSE(masters_[1].is_scheduler());
  const std::string all = link_.heard();
  EXPECT_EQ(count(all, "CL 12"), 1U);
  EXPECT_EQ(count(all, "CL 14"), 0U);
  EXPECT_GT(count(all, "PT urgent 20"), 0U) << "it knows who is live";
}

TEST_F(FfLasTest, ClaimsALinkOnWhichNobodySpeaks) {
  add_master(master(0x11, false));
  link_.run_to(200);
  // 8 * 17 + 2 octets
  EXPECT_EQ(link_.heard().substr(0, 11), "@138 CL 11\n");
  EXPECT_EQ(master_users_[0]->take(), "claimed 17\n");
}

// What the line was like before it had a supply it does not know.
TEST_F(FfLasTest, ClaimsAsLongAfterItsSupplyComesBack) {
  FfLas& las = add_master(master(0x11, false));
  las.stop(link_.now());
  link_.refresh();
  link_.run_to(1'000);
  EXPECT_EQ(link_.heard(), "");
  EXPECT_TRUE(las.start(link_.now()));
  link_.refresh();
  link_.run_to(1'200);
  EXPECT_EQ(link_.heard().substr(0, 12), "@1138 CL 11\n");
}

TEST_F(FfLasTest, HandsTheLinkOver) {
  add_master(master(0x10, true));
  add_master(master(0x14, false));
  link_.run_to(2'000);
  masters_[0].order_transfer(0x14, link_.now());
  link_.refresh();
  link_.run_to(3'000);
  EXPECT_FALSE(masters_[0].is_scheduler());
  EXPECT_TRUE(masters_[1].is_scheduler());
  EXPECT_NE(master_users_[0]->take().find("transferred 20\n"), std::string::npos);
  masters_[1].order_transfer(0x33, link_.now());  // nobody
  link_.refresh();
  link_.run_to(4'000);
  EXPECT_TRUE(masters_[1].is_scheduler());
  EXPECT_NE(master_users_[1]->take().find("transfer failed 51\n"), std::string::npos);
}

// What it may have begun is nobody's any more when the line is silent, and no sooner.
TEST_F(FfLasTest, AnHeirThatCannotBeUnderstoodMayGoOn) {
  add_master(master(0x10, true));
  fault::ScriptedChannel channel;
  link_.place(0).set_channel(&channel);
  link_.run_to(130);
  masters_[0].order_transfer(0x33, link_.now());
  link_.refresh();
  while (link_.heard().find("TL 33") == std::string::npos) link_.wait(1);
  link_.wait(20);
  constexpr std::size_t kInAnOctet = 40;
  channel.on_next().flip(kInAnOctet);
  FfDlpdu long_one = activation(0x22);
  long_one.data.resize(30);
  link_.say(long_one);
  link_.heard();
  link_.wait(31);
  EXPECT_EQ(link_.heard(), "");
  link_.wait(60);
  EXPECT_NE(link_.heard(), "");
  EXPECT_NE(master_users_[0]->take().find("transfer failed 51\n"), std::string::npos);
}

TEST_F(FfLasTest, LeavesWhenAnotherIsTheScheduler) {
  add_master(master(0x10, true));
  link_.run_to(130);
  link_.say(pt(0x22, Priority::normal, 100));
  link_.heard();
  link_.run_to(260);
  EXPECT_EQ(link_.heard(), "");
  EXPECT_FALSE(masters_[0].is_scheduler());
}

TEST_F(FfLasTest, SteersThePriorityByTheRotation) {
  FfConfiguration configuration = master(0x10, true);
  configuration.rules.target_rotation = 20 * kernel::kMillisecond;  // 78 octets
  add_master(configuration);
  FfStation& device = add_device(0x11);
  link_.run_to(600);
  EXPECT_EQ(masters_[0].token_priority(), Priority::time_available);
  // Long frames make the rotation slow.
  for (int n = 0; n < 40; ++n)
    ASSERT_TRUE(device.submit({Priority::urgent, 0x1030, Octets(60)}, link_.now()));
  link_.refresh();
  link_.run_to(2'500);
  EXPECT_GT(masters_[0].rotation(), configuration.rules.target_rotation);
  EXPECT_EQ(masters_[0].token_priority(), Priority::urgent);
}

TEST_F(FfLasTest, KeepsTheLineActiveWhenItMayNotPassTheToken) {
  FfConfiguration configuration = master(0x10, true);
  configuration.rules.least_token_octets = 3'000;
  configuration.live = {0x11};
  configuration.schedule = {.version = 1, .macrocycle = 6'400, .items = {{3'200, 0x1120, Priority::normal}}};
  add_master(configuration);
  link_.run_to(2 * kOctetsPerSecond);
  const std::string all = link_.heard();
  EXPECT_GT(count(all, "IDLE"), 50U);
  EXPECT_EQ(count(all, "CD normal to 1120"), 10U);
}

// A TD is 12 octets with what is around it, V(MSO) 16 and V(MID) 8: from the end of a CT to the item 44.
TEST_F(FfLasTest, AnswersACtThatHasTimeBeforeTheItemThatIsDue) {
  FfConfiguration configuration = master(0x10, true);
  // 200 ms are 781.25 octet durations.
  configuration.schedule = {.version = 1, .macrocycle = 32'000, .items = {{6'400, 0x1120, Priority::normal}}};
  configuration.rules.time_distribution_period = 3'600 * kernel::kSecond;
  for (const bool has_time : {true, false}) {
    FfTestLink link;
    FfLas las(configuration);
    link.add(las);
    const std::int64_t ct_octets = 2 + 2 + 3;
    link.run_to(781 - ct_octets - (has_time ? 45 : 43));
    const std::string before = link.heard();
    link.say({.type = FfType::ct, .node = 0x22});
    link.run_to(781);
    EXPECT_EQ(count(link.heard(), " TD "), has_time ? 1U : 0U) << before;
  }
}

TEST_F(FfLasTest, RefusesAScheduleThatCannotBe) {
  FfConfiguration configuration = master(0x10, true);
  configuration.schedule = {.version = 1, .macrocycle = 100, .items = {{100, 0x1120, Priority::normal}}};
  add_master(configuration);
  EXPECT_FALSE(masters_[0].is_scheduler());
  link_.run_to(1'000);
  EXPECT_EQ(link_.heard(), "");
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
