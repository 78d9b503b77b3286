#include "protocols/fieldbus_dll/isa_las.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "protocols/fieldbus_dll/test_link.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::uint8_t kLas = 0x10;
constexpr std::uint8_t kHeir = 0x11;
constexpr kernel::Duration kOctet = 256 * kernel::kMicrosecond;

IsaConfiguration link_master(std::uint8_t address, std::vector<IsaScheduleItem> items,
                             kernel::Duration period = {}, bool begins = true) {
  IsaConfiguration configuration;
  configuration.address = address;
  configuration.schedule = {.version = 3, .period = period, .items = std::move(items)};
  configuration.begins_as_scheduler = begins;
  return configuration;
}

IsaScheduleItem es_at(std::int64_t at, std::uint16_t duration) {
  return {at * kOctet, IsaType::es, kNode, Priority::time_available, duration};
}
IsaScheduleItem et_at(std::int64_t at) {
  return {at * kOctet, IsaType::et, kNode, Priority::time_available, 0};
}

// A scheduler and, where it is wanted, stations to delegate to.
class IsaLasTest : public testing::Test {
 protected:
  IsaTestLink::User& start(std::vector<IsaScheduleItem> items, kernel::Duration period = {}) {
    las_ = std::make_unique<IsaLas>(link_master(kLas, std::move(items), period));
    IsaTestLink::User& user = link_.add(*las_);
    las_->start(link_.now());
    link_.refresh();
    return user;
  }
  void submit(IsaDevice& station, IsaService service, Octets octets = {}, std::uint8_t to = kNode) {
    ASSERT_TRUE(station.submit({service, Priority::normal, to, std::move(octets)}, link_.now()));
    link_.refresh();
  }

  IsaTestLink link_;
  std::unique_ptr<IsaLas> las_;
};

TEST_F(IsaLasTest, RunsItsScheduleAgainAndAgain) {
  IsaDle node({.rules = {}, .address = kNode});
  link_.add(node);
  start({et_at(20), es_at(60, 40)}, 100 * kOctet);
  link_.wait(190);
  EXPECT_EQ(link_.heard(),
            "@20 ET time-available 10 -> 21\n@36 EE 21 -> 10, nothing to send\n"
            "@60 ES time-available 10 -> 21 for 40 octets\n@78 EE 21 -> 10, nothing to send\n"
            "@120 ET time-available 10 -> 21\n@136 EE 21 -> 10, nothing to send\n"
            "@160 ES time-available 10 -> 21 for 40 octets\n@178 EE 21 -> 10, nothing to send\n");
}

TEST_F(IsaLasTest, SendsWhatItsUserSubmitsWhereItFitsBeforeTheNextItem) {
  start({et_at(50)});
  link_.wait(12);
  submit(*las_, IsaService::unit_data, {1, 2});
  link_.wait(1);
  submit(*las_, IsaService::unit_data, {3});  // ends behind the begin of the item, with what must follow it
  link_.wait(140);
  EXPECT_EQ(link_.heard(),
            "@12 DU normal 10 -> 21: 01 02\n@50 ET time-available 10 -> 21\n@90 DU normal 10 -> 21: 03\n");
}

TEST_F(IsaLasTest, CompelsForItsUserAndGoesOn) {
  IsaDle node({.rules = {}, .address = kNode});
  link_.add(node);
  submit(node, IsaService::reply_data, {7});
  IsaTestLink::User& user = start({});
  link_.wait(20);
  submit(*las_, IsaService::compel);
  link_.wait(60);
  EXPECT_EQ(user.take(), "DT normal 21 -> 10 final: 07\n");
  submit(*las_, IsaService::compel, {}, 0x33);
  link_.wait(100);
  EXPECT_EQ(user.take(), "reply missing 51\n");
}

TEST_F(IsaLasTest, RepliesToTheHolderOfItsToken) {
  IsaDle node({.rules = {}, .address = kNode});
  IsaTestLink::User& user = link_.add(node);
  start({et_at(20), et_at(30)});
  submit(node, IsaService::compel, {}, kLas);
  ASSERT_TRUE(las_->submit({IsaService::reply_data, Priority::normal, 0, Octets(100, 0x55)}, link_.now()));
  link_.wait(400);
  EXPECT_EQ(user.take().substr(0, 22), "DT normal 10 -> 21 fin");
  // The next token waits for the reply of 105 octets and for the EE after it.
  EXPECT_TRUE(
      link_.heard().ends_with("@168 EE 21 -> 10, single frame done\n@185 ET time-available 10 -> 21\n"
                              "@201 EE 21 -> 10, nothing to send\n"));
  EXPECT_EQ(las_->las_state(), LasState::scheduling);
}

TEST_F(IsaLasTest, TakesATokenBackFromWhoIsSilentAndTellsWhy) {
  IsaTestLink::User& user = start({es_at(20, 400), et_at(30)});
  link_.wait(200);
  EXPECT_EQ(link_.heard(), "@20 ES time-available 10 -> 21 for 400 octets\n@62 ET time-available 10 -> 21\n");
  EXPECT_EQ(user.take(), "token reclaimed 33\ntoken reclaimed 33\n");
}

TEST_F(IsaLasTest, TellsWhoSendsMoreThanOneFrame) {
  IsaTestLink::User& user = start({et_at(20)});
  link_.wait(40);
  link_.say(data(IsaType::du, 0x22, kNode, {}));
  link_.wait(8);
  link_.say(data(IsaType::du, 0x22, kNode, {}));
  link_.wait(60);
  EXPECT_EQ(user.take(), "token overrun 33\ntoken reclaimed 33\n");
}

TEST_F(IsaLasTest, HandsTheLinkToAnotherAndBack) {
  IsaLas heir(link_master(kHeir, {et_at(0)}, 100 * kOctet, false));
  IsaTestLink::User& heirs_user = link_.add(heir);
  IsaDle node({.rules = {}, .address = kNode});
  link_.add(node);
  IsaTestLink::User& user = start({et_at(20)}, 100 * kOctet);
  heir.start(link_.now());
  link_.wait(50);
  las_->order_transfer(kHeir, link_.now());
  link_.refresh();
  link_.wait(150);
  EXPECT_EQ(las_->las_state(), LasState::standby);
  EXPECT_NE(heir.las_state(), LasState::standby);
  EXPECT_EQ(user.take(), "transferred 17\n");
  EXPECT_EQ(heirs_user.take(), "scheduler taken 16\n");
  EXPECT_EQ(link_.heard(),
            "@20 ET time-available 10 -> 21\n@36 EE 21 -> 10, nothing to send\n@53 TL 10 -> 11, schedule 3\n"
            "@71 ET time-available 11 -> 21\n@87 EE 21 -> 11, nothing to send\n"
            "@163 ET time-available 11 -> 21\n@179 EE 21 -> 11, nothing to send\n");
  heir.order_transfer(kLas, link_.now());
  link_.refresh();
  link_.wait(200);
  EXPECT_EQ(heir.las_state(), LasState::standby);
  EXPECT_NE(las_->las_state(), LasState::standby);
}

TEST_F(IsaLasTest, ShowsItselfWhenItsScheduleHasTime) {
  las_ = std::make_unique<IsaLas>(link_master(kLas, {et_at(500)}, {}, false));
  link_.add(*las_);
  las_->start(link_.now());
  link_.wait(20);
  link_.say({.type = IsaType::tl, .destination = kLas, .source = kHeir});
  link_.wait(100);
  EXPECT_EQ(link_.heard(), "@38 DU time-available 10 -> FF\n");
}

TEST_F(IsaLasTest, TakesTheLinkBackFromAnHeirThatIsNotThere) {
  IsaTestLink::User& user = start({et_at(80)});
  link_.wait(20);
  las_->order_transfer(kHeir, link_.now());
  link_.refresh();
  link_.wait(75);
  EXPECT_EQ(link_.heard(), "@20 TL 10 -> 11, schedule 3\n@80 ET time-available 10 -> 21\n");
  EXPECT_EQ(user.take(), "transfer failed 17\n");
}

TEST_F(IsaLasTest, LeavesToALowerAddressOnly) {
  IsaTestLink::User& user = start({et_at(90)});
  link_.wait(20);
  link_.say(token(IsaType::et, Priority::normal, 0x22, 0, kHeir));
  EXPECT_EQ(las_->las_state(), LasState::scheduling);
  link_.wait(40);
  link_.say(token(IsaType::et, Priority::normal, 0x22, 0, 0x0F));
  EXPECT_EQ(las_->las_state(), LasState::standby);
  link_.wait(100);
  EXPECT_EQ(user.take(), "second scheduler 17\nsecond scheduler 15\nscheduler left 15\n");
  EXPECT_EQ(link_.heard(), "");
  // It is a station as any other then.
  submit(*las_, IsaService::unit_data, {4});
  link_.say(token(IsaType::et, Priority::normal, kLas, 0, 0x0F));
  link_.wait(60);
  EXPECT_EQ(link_.heard(), "@192 DU normal 10 -> 21: 04\n@209 EE 10 -> 0F, single frame done\n");
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
