#include "conformance/fieldbus_dll/isa_model.hpp"

#include <gtest/gtest.h>

#include <array>

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;
using kernel::Time;

// In octet durations from the start.
Time isa_octet_at(std::int64_t count) {
  return kernel::kStart + fieldbus_dll::octets({}, count);
}

DrivenDlpdu isa_said_at(std::int64_t begin, Octets octets) {
  const auto on_line = static_cast<std::int64_t>(octets.size()) + 5;
  return {isa_octet_at(begin), isa_octet_at(begin + on_line), true, true, std::move(octets)};
}

Octets end_said(std::uint8_t reason) {
  return {0x64, 0x10, 0x21, reason};
}

std::string isa_reason_in(const std::optional<LinkObjection>& objection) {
  return objection ? objection->reason : "";
}

TEST(IsaModel, AnEtIsForOneFrameAndReturned) {
  IsaModel model({}, 0x21);
  ASSERT_TRUE(model.submit(IsaService::unit_data, Priority::normal, 0x22, {7}));
  ASSERT_TRUE(model.submit(IsaService::unit_data, Priority::normal, 0x22, {8}));
  model.hear_token(Priority::normal, {}, 0x10, isa_octet_at(10));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(18, {0x32, 0x22, 0x21, 7}))), "");
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(35, {0x32, 0x22, 0x21, 8}))), "sends_two_frames");
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(52, end_said(2)))), "");
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(80, end_said(2)))), "speaks_unasked");
}

TEST(IsaModel, AnEsIsForWhatEndsInTime) {
  IsaModel model({}, 0x21);
  ASSERT_TRUE(model.submit(IsaService::unit_data, Priority::normal, 0x22, {7}));
  // Silence of 8, the frame of 9, silence of 8, the EE of 9.
  model.hear_token(Priority::normal, 33, 0x10, isa_octet_at(10));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(18, {0x32, 0x22, 0x21, 7}))), "sends_without_time");
  model.hear_token(Priority::normal, 33, 0x10, isa_octet_at(100));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(108, end_said(1)))), "");
  model.hear_token(Priority::normal, 34, 0x10, isa_octet_at(200));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(208, end_said(1)))), "data_held_back");
  model.hear_token(Priority::normal, 34, 0x10, isa_octet_at(300));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(308, {0x32, 0x22, 0x21, 7}))), "");
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(325, end_said(0)))), "");
  // Who has begun at V(MID) always has time for an EE, or none.
  const unsigned latest = 8 + 9;
  model.hear_token(Priority::normal, latest, 0x10, isa_octet_at(400));
  EXPECT_EQ(isa_reason_in(model.be_silent()), "token_not_returned");
  model.hear_token(Priority::normal, latest - 1, 0x10, isa_octet_at(500));
  EXPECT_EQ(isa_reason_in(model.be_silent()), "");
}

TEST(IsaModel, BehindItsCdItWaits) {
  IsaModel model({}, 0x21);
  ASSERT_TRUE(model.submit(IsaService::compel, Priority::normal, 0x22, {}));
  model.hear_token(Priority::normal, {}, 0x10, isa_octet_at(10));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(18, {0x12, 0x22, 0x21}))), "");
  EXPECT_EQ(model.compelled(), 0x22);
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(40, end_said(2)))), "does_not_wait_for_reply");
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(58, end_said(2)))), "");
}

TEST(IsaModel, AReplyGoesOnAndAnotherDlpduEndsTheToken) {
  IsaModel model({}, 0x21);
  for (const std::uint8_t from : std::array<std::uint8_t, 2>{0x22, 0x23}) {
    const std::int64_t start = from * 1000;
    ASSERT_TRUE(model.submit(IsaService::compel, Priority::normal, 0x22, {}));
    model.hear_token(Priority::normal, {}, 0x10, isa_octet_at(start));
    EXPECT_EQ(isa_reason_in(model.say(isa_said_at(start + 8, {0x12, 0x22, 0x21}))), "");
    model.hear_dt(from, isa_octet_at(start + 40));
    EXPECT_EQ(isa_reason_in(model.say(isa_said_at(start + 48, end_said(2)))),
              from == 0x22 ? "" : "speaks_unasked");
  }
}

TEST(IsaModel, RepliesWithWhatIsThereInTime) {
  IsaModel model({}, 0x21);
  ASSERT_TRUE(model.submit(IsaService::reply_data, Priority::normal, 0, {5}));
  EXPECT_FALSE(model.submit(IsaService::reply_data, Priority::urgent, 0, Octets(65)));
  model.hear_cd(Priority::urgent, 0x22, isa_octet_at(10));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(18, {0x27, 0x22, 0x21}))), "");
  model.hear_cd(Priority::normal, 0x22, isa_octet_at(100));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(108, {0x26, 0x22, 0x21, 5}))), "");
  model.hear_cd(Priority::normal, 0x22, isa_octet_at(200));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(225, {0x26, 0x22, 0x21}))), "replies_too_late");
  model.hear_cd(Priority::normal, 0x22, isa_octet_at(300));
  EXPECT_EQ(isa_reason_in(model.say(isa_said_at(308, {0x26, 0x22, 0x21, 5}))), "reply_wrong");
  IsaModel usual({}, 0x21);
  usual.hear_cd(Priority::normal, 0x22, isa_octet_at(400));
  EXPECT_EQ(isa_reason_in(usual.be_silent()), "no_reply");
  model.hear_cd(Priority::normal, 0x22, isa_octet_at(500));
  model.hear_other(false, isa_octet_at(510));
  EXPECT_EQ(isa_reason_in(model.be_silent()), "");
}

TEST(IsaModel, ReportsWhatBecomesOfItsCd) {
  const auto reported = [](const Octets& dlpdu, std::int64_t begin) {
    IsaModel model({}, 0x21);
    EXPECT_TRUE(model.submit(IsaService::compel, Priority::normal, 0x22, {}));
    model.hear({0x42, 0x21, 0x10}, isa_octet_at(5), isa_octet_at(10));
    EXPECT_EQ(isa_reason_in(model.say(isa_said_at(18, {0x12, 0x22, 0x21}))), "");
    model.hear(dlpdu, isa_octet_at(begin), isa_octet_at(begin + 8));
    const std::vector<IsaReport> reports = model.take_reports();
    return reports.empty() ? std::string{} : reports.front().text();
  };
  const Octets reply{0x26, 0x21, 0x22};
  EXPECT_EQ(reported(reply, 40), "DT normal 22 -> 21 final");
  EXPECT_EQ(reported({0x26, 0x21, 0x23}, 40), "token dropped of 23");
  EXPECT_EQ(reported({0x42, 0x21, 0x10}, 40), "token dropped of 10");
  EXPECT_EQ(reported({0x42, 0x21, 0x10, 0}, 40), "");
  EXPECT_EQ(reported(reply, 58), "reply missing of 22");
}

}  // namespace
}  // namespace fieldproof::conformance
