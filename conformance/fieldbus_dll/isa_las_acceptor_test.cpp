#include "conformance/fieldbus_dll/isa_las_acceptor.hpp"

#include <gtest/gtest.h>

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;
using kernel::Time;

// In octet durations from the start.
Time las_octet_at(std::int64_t count) {
  return kernel::kStart + fieldbus_dll::octets({}, count);
}

DrivenDlpdu las_said_at(std::int64_t begin, Octets octets) {
  const auto on_line = static_cast<std::int64_t>(octets.size()) + 5;
  return {las_octet_at(begin), las_octet_at(begin + on_line), true, true, std::move(octets)};
}

std::string las_reason_in(const std::optional<LinkObjection>& objection) {
  return objection ? objection->reason : "";
}

// An ET for 21 at 20, an ES for 22 at 100, anew each 200.
IsaLasAcceptor acceptor() {
  fieldbus_dll::IsaConfiguration configuration;
  configuration.address = 0x10;
  configuration.schedule = {
      .version = 0x0102,
      .period = fieldbus_dll::octets({}, 200),
      .items = {{fieldbus_dll::octets({}, 20), IsaType::et, 0x21, Priority::normal, 0},
                {fieldbus_dll::octets({}, 100), IsaType::es, 0x22, Priority::normal, 40}}};
  return {configuration, kernel::kStart};
}

const Octets kEt{0x42, 0x21, 0x10};
const Octets kEs{0x52, 0x22, 0x10, 0, 40};

TEST(IsaLasAcceptor, ItemsComeInTheirOrderAndTime) {
  IsaLasAcceptor one = acceptor();
  EXPECT_EQ(one.silent_until(), las_octet_at(28) + kernel::kNanosecond);
  EXPECT_EQ(las_reason_in(acceptor().say(las_said_at(11, kEt))), "delegation_early");
  EXPECT_EQ(las_reason_in(acceptor().say(las_said_at(20, kEs))), "delegation_wrong");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(12, kEt))), "");
  one.hear_return(las_octet_at(37));
  EXPECT_EQ(las_reason_in(one.say(las_said_at(100, kEs))), "");
  one.hear_return(las_octet_at(127));
  EXPECT_EQ(one.silent_until(), las_octet_at(228) + kernel::kNanosecond);
  EXPECT_EQ(las_reason_in(one.say(las_said_at(220, kEt))), "");
}

TEST(IsaLasAcceptor, ATokenThatIsOutIsNotTalkedInto) {
  IsaLasAcceptor one = acceptor();
  ASSERT_EQ(las_reason_in(one.say(las_said_at(90, kEt))), "");
  // Until 98, V(RR) is 32.
  EXPECT_EQ(one.silent_until(), las_octet_at(138) + kernel::kNanosecond);
  IsaLasAcceptor early = one;
  EXPECT_EQ(las_reason_in(early.say(las_said_at(129, kEs))), "talks_into_token");
  IsaLasAcceptor late = one;
  EXPECT_EQ(las_reason_in(late.say(las_said_at(130, kEs))), "");
  one.hear_data(las_octet_at(120));
  EXPECT_EQ(las_reason_in(one.say(las_said_at(151, kEs))), "talks_into_token");
}

TEST(IsaLasAcceptor, OwnDataEndsBeforeTheNextItem) {
  IsaLasAcceptor one = acceptor();
  EXPECT_FALSE(one.submit(Priority::urgent, 0x22, Octets(65), las_octet_at(0)));
  ASSERT_TRUE(one.submit(Priority::normal, 0x22, {7}, las_octet_at(0)));
  ASSERT_TRUE(one.submit(Priority::urgent, 0x22, {8}, las_octet_at(0)));
  IsaLasAcceptor other = one;
  EXPECT_EQ(las_reason_in(other.say(las_said_at(8, {0x32, 0x22, 0x10, 7}))), "sends_other_data");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(8, {0x33, 0x22, 0x10, 8}))), "");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(20, {0x32, 0x22, 0x10, 7}))), "answers_too_early");
  EXPECT_EQ(las_reason_in(acceptor().say(las_said_at(8, {0x32, 0x22, 0x10, 7}))), "sends_other_data");
  IsaLasAcceptor late = acceptor();
  ASSERT_TRUE(late.submit(Priority::normal, 0x22, {7}, las_octet_at(0)));
  EXPECT_EQ(las_reason_in(late.say(las_said_at(12, {0x32, 0x22, 0x10, 7}))), "own_data_over_due");
}

TEST(IsaLasAcceptor, WhoHandedOverIsSilentUntilItIsHandedBack) {
  const Octets tl{0x70, 0x12, 0x10, 1, 2};
  EXPECT_EQ(las_reason_in(acceptor().say(las_said_at(8, tl))), "transfer_unasked");
  IsaLasAcceptor one = acceptor();
  one.order_transfer(0x12);
  ASSERT_EQ(las_reason_in(one.say(las_said_at(8, tl))), "");
  IsaLasAcceptor early = one;
  EXPECT_EQ(las_reason_in(early.say(las_said_at(40, kEt))), "talks_into_transfer");
  one.hear_heir(las_octet_at(40));
  EXPECT_EQ(one.silent_until(), kernel::kNever);
  IsaLasAcceptor standby = one;
  EXPECT_EQ(las_reason_in(standby.say(las_said_at(60, kEt))), "speaks_unasked");
  one.hear_transfer(las_octet_at(300));
  EXPECT_EQ(las_reason_in(one.say(las_said_at(308, {0x31, 0xFF, 0x10}))), "");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(324, kEt))), "");
}

TEST(IsaLasAcceptor, TheLowerAddressStays) {
  IsaLasAcceptor one = acceptor();
  one.hear_scheduler(0x11, las_octet_at(10));
  EXPECT_FALSE(one.is_standby());
  one.hear_scheduler(0x0F, las_octet_at(20));
  EXPECT_TRUE(one.is_standby());
}

}  // namespace
}  // namespace fieldproof::conformance
