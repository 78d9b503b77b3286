#include "conformance/fieldbus_dll/isa_las_acceptor.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaEventKind;
using fieldbus_dll::IsaService;
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

kernel::Duration octets_of_time(std::int64_t count) {
  return fieldbus_dll::octets({}, count);
}

IsaLasAcceptor acceptor_of(std::vector<fieldbus_dll::IsaScheduleItem> items) {
  fieldbus_dll::IsaConfiguration configuration;
  configuration.address = 0x10;
  configuration.schedule = {.version = 0x0102, .period = octets_of_time(200), .items = std::move(items)};
  return {configuration, kernel::kStart};
}

// An ET for 21 at 20, an ES for 22 at 100, anew each 200.
IsaLasAcceptor acceptor() {
  return acceptor_of({{octets_of_time(20), IsaType::et, 0x21, Priority::normal, 0},
                      {octets_of_time(100), IsaType::es, 0x22, Priority::normal, 40}});
}

bool submit_to(IsaLasAcceptor& one, Priority priority, const Octets& data) {
  return one.submit(IsaService::unit_data, priority, 0x22, data, las_octet_at(0));
}

std::string las_reports_of(IsaLasAcceptor& one) {
  std::string text;
  for (const IsaReport& report : one.take_reports({})) text += report.text() + "; ";
  return text;
}

// An EE of the holder.
Octets ee_of(std::uint8_t holder) {
  return {0x64, 0x10, holder, 0};
}

const Octets kEt{0x42, 0x21, 0x10};
const Octets kEs{0x52, 0x22, 0x10, 0, 40};

TEST(IsaLasAcceptor, ItemsComeInTheirOrderAndTime) {
  IsaLasAcceptor one = acceptor();
  EXPECT_EQ(one.silent_until(), las_octet_at(28) + kernel::kNanosecond);
  EXPECT_EQ(las_reason_in(acceptor().say(las_said_at(11, kEt))), "delegation_early");
  EXPECT_EQ(las_reason_in(acceptor().say(las_said_at(20, kEs))), "delegation_wrong");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(12, kEt))), "");
  one.hear(ee_of(0x21), las_octet_at(37));
  EXPECT_EQ(las_reason_in(one.say(las_said_at(100, kEs))), "");
  one.hear(ee_of(0x22), las_octet_at(127));
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
  one.hear({0x32, 0x22, 0x21, 7}, las_octet_at(120));
  EXPECT_EQ(las_reason_in(one.say(las_said_at(151, kEs))), "talks_into_token");
}

// A DU of one octet takes 9 octet durations, V(MID) 8 and an EE 9: 26 before an item at 20 are none.
TEST(IsaLasAcceptor, OwnDataEndWithAReturnBeforeTheNextItem) {
  IsaLasAcceptor one = acceptor();
  EXPECT_FALSE(submit_to(one, Priority::urgent, Octets(65)));
  ASSERT_TRUE(submit_to(one, Priority::normal, {7}));
  ASSERT_TRUE(submit_to(one, Priority::urgent, {8}));
  IsaLasAcceptor early = one;
  EXPECT_EQ(las_reason_in(early.say(las_said_at(8, {0x33, 0x22, 0x10, 8}))), "own_data_over_due");
  ASSERT_EQ(las_reason_in(one.say(las_said_at(20, kEt))), "");
  one.hear(ee_of(0x21), las_octet_at(45));
  // Begun until 61 they must be sent.
  EXPECT_EQ(one.silent_until(), las_octet_at(61) + kernel::kNanosecond);
  IsaLasAcceptor other = one;
  EXPECT_EQ(las_reason_in(other.say(las_said_at(53, {0x32, 0x22, 0x10, 7}))), "sends_other_data");
  IsaLasAcceptor late = one;
  EXPECT_EQ(las_reason_in(late.say(las_said_at(75, {0x33, 0x22, 0x10, 8}))), "own_data_over_due");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(74, {0x33, 0x22, 0x10, 8}))), "");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(90, {0x32, 0x22, 0x10, 7}))), "answers_too_early");
  EXPECT_EQ(las_reason_in(acceptor().say(las_said_at(8, {0x32, 0x22, 0x10, 7}))), "sends_other_data");
}

// A CD takes 8, V(RR) 32, the longest DT of normal priority 136, V(MID) 8 and an EE 9.
TEST(IsaLasAcceptor, ACdOfItsOwnIsAwaited) {
  const Octets cd{0x12, 0x22, 0x10};
  IsaLasAcceptor one = acceptor_of({{octets_of_time(201), IsaType::et, 0x21, Priority::normal, 0}});
  ASSERT_TRUE(one.submit(IsaService::compel, Priority::normal, 0x22, {}, las_octet_at(0)));
  ASSERT_TRUE(submit_to(one, Priority::normal, {7}));
  IsaLasAcceptor late = one;
  EXPECT_EQ(las_reason_in(late.say(las_said_at(9, cd))), "own_data_over_due");
  ASSERT_EQ(las_reason_in(one.say(las_said_at(8, cd))), "");
  IsaLasAcceptor early = one;
  EXPECT_EQ(las_reason_in(early.say(las_said_at(47, {0x32, 0x22, 0x10, 7}))), "talks_into_reply");
  IsaLasAcceptor silent = one;
  EXPECT_EQ(las_reason_in(silent.say(las_said_at(48, {0x32, 0x22, 0x10, 7}))), "");
  EXPECT_EQ(las_reports_of(silent), "reply missing of 22; ");
  IsaLasAcceptor dropped = one;
  dropped.hear({0x32, 0x10, 0x2A, 9}, las_octet_at(35));
  EXPECT_EQ(las_reports_of(dropped), "token dropped of 2A; ");
  one.hear({0x26, 0x10, 0x22, 9}, las_octet_at(35));
  EXPECT_EQ(las_reports_of(one), "DT normal 22 -> 10 final: 09; ");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(43, {0x32, 0x22, 0x10, 7}))), "");
}

TEST(IsaLasAcceptor, ItsUserIsGivenWhatBecameOfEachToken) {
  IsaLasAcceptor one = acceptor();
  ASSERT_EQ(las_reason_in(one.say(las_said_at(20, kEt))), "");
  ASSERT_EQ(las_reason_in(one.say(las_said_at(100, kEs))), "");
  EXPECT_EQ(las_reports_of(one), "token reclaimed of 21; ");
  one.hear({0x32, 0x10, 0x22, 7}, las_octet_at(127));
  EXPECT_EQ(las_reports_of(one), "DU normal 22 -> 10: 07; ");
  ASSERT_EQ(las_reason_in(one.say(las_said_at(220, kEt))), "");
  EXPECT_EQ(las_reports_of(one), "token overrun of 22; ");
  one.hear({0x32, 0x22, 0x21, 7}, las_octet_at(240));
  one.hear({0x32, 0x22, 0x21, 7}, las_octet_at(260));
  EXPECT_EQ(las_reports_of(one), "token overrun of 21; ");
  one.hear({0x42, 0x22, 0x11}, las_octet_at(280));
  one.hear({0x42, 0x22, 0x0F}, las_octet_at(300));
  EXPECT_EQ(las_reports_of(one), "second scheduler of 11; second scheduler of 0F; scheduler left of 0F; ");
  one.hear({0x70, 0x10, 0x0F, 0, 9}, las_octet_at(340));
  EXPECT_EQ(las_reports_of(one), "scheduler taken of 0F; ");
}

// Who returns its token with faults may have used it.
TEST(IsaLasAcceptor, AfterNoiseEitherEventIsRight) {
  for (const IsaEventKind kind : {IsaEventKind::token_reclaimed, IsaEventKind::token_overrun}) {
    IsaLasAcceptor one = acceptor();
    ASSERT_EQ(las_reason_in(one.say(las_said_at(20, kEt))), "");
    one.hear(ee_of(0x21), las_octet_at(45));
    ASSERT_EQ(las_reason_in(one.say(las_said_at(100, kEs))), "");
    one.hear_noise(las_octet_at(127));
    ASSERT_EQ(las_reason_in(one.say(las_said_at(220, kEt))), "");
    const std::vector<IsaReport> actual{{{}, {kind, 0x22}}};
    EXPECT_EQ(one.take_reports(actual), actual);
  }
}

TEST(IsaLasAcceptor, WhoIsCompelledByAHolderReplies) {
  IsaLasAcceptor one = acceptor();
  ASSERT_TRUE(one.submit(IsaService::reply_data, Priority::normal, 0x22, {7}, las_octet_at(0)));
  ASSERT_EQ(las_reason_in(one.say(las_said_at(20, kEt))), "");
  one.hear({0x13, 0x10, 0x21}, las_octet_at(45));
  EXPECT_EQ(one.silence().reason, "no_reply");
  EXPECT_EQ(one.silent_until(), las_octet_at(69) + kernel::kNanosecond);
  IsaLasAcceptor less = one;
  // Less urgent data do not answer an urgent CD.
  EXPECT_EQ(las_reason_in(less.say(las_said_at(53, {0x26, 0x21, 0x10, 7}))), "reply_wrong");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(53, {0x27, 0x21, 0x10}))), "");
}

TEST(IsaLasAcceptor, WhoHandedOverIsSilentUntilItIsHandedBack) {
  const Octets tl{0x70, 0x12, 0x10, 1, 2};
  EXPECT_EQ(las_reason_in(acceptor().say(las_said_at(8, tl))), "transfer_unasked");
  IsaLasAcceptor one = acceptor();
  one.order_transfer(0x12, las_octet_at(0));
  ASSERT_EQ(las_reason_in(one.say(las_said_at(8, tl))), "");
  IsaLasAcceptor early = one;
  EXPECT_EQ(las_reason_in(early.say(las_said_at(40, kEt))), "talks_into_transfer");
  one.hear({0x32, 0x22, 0x12, 7}, las_octet_at(40));
  EXPECT_EQ(one.silent_until(), kernel::kNever);
  IsaLasAcceptor standby = one;
  EXPECT_EQ(las_reason_in(standby.say(las_said_at(60, kEt))), "speaks_unasked");
  one.hear({0x70, 0x10, 0x12, 0, 9}, las_octet_at(300));
  IsaLasAcceptor nothing = one;
  EXPECT_EQ(las_reason_in(nothing.say(las_said_at(308, {0x30, 0xFF, 0x10}))), "sends_other_data");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(308, {0x31, 0xFF, 0x10}))), "");
  EXPECT_EQ(las_reason_in(one.say(las_said_at(324, kEt))), "");
}

TEST(IsaLasAcceptor, TheLowerAddressStays) {
  IsaLasAcceptor one = acceptor();
  one.hear({0x42, 0x22, 0x11}, las_octet_at(10));
  EXPECT_FALSE(one.is_standby());
  one.hear({0x42, 0x22, 0x0F}, las_octet_at(20));
  EXPECT_TRUE(one.is_standby());
}

}  // namespace
}  // namespace fieldproof::conformance
