#include "conformance/fieldbus_dll/ff_model.hpp"

#include <gtest/gtest.h>

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;
using kernel::Time;

constexpr std::uint8_t kRt = 0x34;

// In octet durations from the start.
Time octet_at(std::int64_t count) {
  return kernel::kStart + fieldbus_dll::octets({}, count);
}

DrivenDlpdu said_at(std::int64_t begin, Octets octets) {
  const auto on_line = static_cast<std::int64_t>(octets.size()) + 5;
  return {octet_at(begin), octet_at(begin + on_line), true, true, std::move(octets)};
}

Octets dt1_said(unsigned control, const Octets& data) {
  Octets octets{static_cast<std::uint8_t>(control), 0x22, 0x30, 0x21, 0x01};
  octets.insert(octets.end(), data.begin(), data.end());
  return octets;
}

FfModel model_of_device() {
  fieldbus_dll::FfConfiguration configuration;
  configuration.node = 0x21;
  configuration.published = {0x2120};
  return FfModel(configuration);
}

fieldbus_dll::FfRequest request_of(Priority priority, Octets data) {
  return {priority, 0x2230, std::move(data)};
}

// To the device: a PT, a CD.
Octets pt_for(Priority least, unsigned duration) {
  return {static_cast<std::uint8_t>(0x30U | static_cast<unsigned>(least)), 0x21,
          static_cast<std::uint8_t>(duration >> 8), static_cast<std::uint8_t>(duration & 0xFFU)};
}
Octets cd_for(unsigned address, Priority priority) {
  return {static_cast<std::uint8_t>(0xA0U | static_cast<unsigned>(priority)),
          static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address & 0xFFU)};
}
const Octets kPnForIt{0x26, 0x21};
const Octets kData{0xD2, 0x22, 0x30, 0x23, 0x01, 7};
const Octets kTd{0x11, 0, 0, 0, 0, 0, 1};

std::string reason_in(const std::optional<LinkObjection>& objection) {
  return objection ? objection->reason : "";
}

TEST(FfModel, AnUnusedTokenIsReturnedInTime) {
  FfModel model = model_of_device();
  model.hear(pt_for(Priority::normal, 100), octet_at(10));
  EXPECT_EQ(reason_in(model.be_silent()), "token_not_returned");
  model.hear(pt_for(Priority::normal, 100), octet_at(10));
  EXPECT_EQ(reason_in(model.say(said_at(18, {kRt}))), "");
  EXPECT_EQ(reason_in(model.say(said_at(40, {kRt}))), "speaks_unasked");
  model.hear(pt_for(Priority::normal, 100), octet_at(60));
  EXPECT_EQ(reason_in(model.say(said_at(67, {kRt}))), "answers_too_early");
  model.hear(pt_for(Priority::normal, 100), octet_at(80));
  EXPECT_EQ(reason_in(model.say(said_at(113, {kRt}))), "answers_too_late");
}

TEST(FfModel, AnRtThatDoesNotFitIsNotMissed) {
  FfModel model = model_of_device();
  model.hear(pt_for(Priority::normal, 13), octet_at(10));
  EXPECT_EQ(reason_in(model.be_silent()), "");
  model.hear(pt_for(Priority::normal, 13), octet_at(10));
  EXPECT_EQ(reason_in(model.say(said_at(18, {kRt}))), "longer_than_the_token");
}

TEST(FfModel, WantsTheMostUrgentFirstAndAll) {
  FfModel model = model_of_device();
  ASSERT_TRUE(model.submit(request_of(Priority::normal, {1})));
  ASSERT_TRUE(model.submit(request_of(Priority::urgent, {2})));
  EXPECT_FALSE(model.submit(request_of(Priority::urgent, Octets(65))));
  model.hear(pt_for(Priority::normal, 200), octet_at(10));
  EXPECT_EQ(reason_in(model.say(said_at(18, dt1_said(0xD3, {2})))), "");
  EXPECT_EQ(reason_in(model.say(said_at(37, dt1_said(0xD6, {1})))), "");
  EXPECT_EQ(reason_in(model.be_silent()), "");
}

TEST(FfModel, ObjectsToOtherDataAndToDataHeldBack) {
  FfModel model = model_of_device();
  ASSERT_TRUE(model.submit(request_of(Priority::normal, {1})) &&
              model.submit(request_of(Priority::urgent, {2})));
  model.hear(pt_for(Priority::normal, 200), octet_at(10));
  EXPECT_EQ(reason_in(model.say(said_at(18, dt1_said(0xD2, {1})))), "sends_other_data");
  model.hear(pt_for(Priority::normal, 200), octet_at(100));
  EXPECT_EQ(reason_in(model.say(said_at(108, {kRt}))), "data_held_back");
  model.hear(pt_for(Priority::normal, 200), octet_at(200));
  EXPECT_EQ(reason_in(model.say(said_at(208, dt1_said(0xD7, {2})))), "data_held_back");
  model.hear(pt_for(Priority::urgent, 200), octet_at(300));
  EXPECT_EQ(reason_in(model.say(said_at(308, dt1_said(0xD6, {1})))), "sends_other_data");
}

TEST(FfModel, PublishesTheLastWriteWithItsNumber) {
  FfModel model = model_of_device();
  model.hear(cd_for(0x2120, Priority::normal), octet_at(10));
  EXPECT_EQ(reason_in(model.say(said_at(18, {0x17, 1}))), "");
  EXPECT_FALSE(model.write(0x2121, {1}));
  ASSERT_TRUE(model.write(0x2120, {1}) && model.write(0x2120, {7}));
  model.hear(cd_for(0x2120, Priority::urgent), octet_at(40));
  EXPECT_EQ(reason_in(model.say(said_at(48, {0x57, 0x21, 0x20, 2, 7}))), "");
  model.hear(cd_for(0x2120, Priority::urgent), octet_at(80));
  EXPECT_EQ(reason_in(model.say(said_at(88, {0x57, 0x21, 0x20, 1, 7}))), "published_wrong");
  model.hear(cd_for(0x2120, Priority::urgent), octet_at(120));
  EXPECT_EQ(reason_in(model.be_silent()), "no_answer");
  model.hear(cd_for(0x2121, Priority::urgent), octet_at(160));
  EXPECT_EQ(reason_in(model.be_silent()), "no_answer");
  model.hear(cd_for(0x2120, Priority::urgent), octet_at(200));
  EXPECT_EQ(reason_in(model.say(said_at(208, {0x53, 0x21, 0x20, 2, 7}))), "published_wrong");
}

// While the answer to a CD is due, the device takes its buffer when it likes, but as a whole.
TEST(FfModel, ABufferThatIsWrittenWhileItsAnswerIsDueIsPublishedWholeAsItWasOrIs) {
  const auto answered = [](const Octets& answer) {
    FfModel model = model_of_device();
    EXPECT_TRUE(model.write(0x2120, {1, 1}));
    model.hear(cd_for(0x2120, Priority::urgent), octet_at(40));
    EXPECT_TRUE(model.write(0x2120, {2, 2}) && model.write(0x2120, {3, 3}));
    return reason_in(model.say(said_at(48, answer)));
  };
  EXPECT_EQ(answered({0x57, 0x21, 0x20, 1, 1, 1}), "");
  EXPECT_EQ(answered({0x57, 0x21, 0x20, 2, 2, 2}), "");
  EXPECT_EQ(answered({0x57, 0x21, 0x20, 3, 3, 3}), "");
  EXPECT_EQ(answered({0x57, 0x21, 0x20, 2, 1, 1}), "published_wrong");
  EXPECT_EQ(answered({0x57, 0x21, 0x20, 3, 3, 2}), "published_wrong");
  EXPECT_EQ(answered({0x57, 0x21, 0x20, 4, 3, 3}), "published_wrong");
}

TEST(FfModel, ABufferThatIsWrittenFirstWhileItsAnswerIsDueIsPublishedOrIsNot) {
  const auto model_of_write_after_cd = [] {
    FfModel model = model_of_device();
    model.hear(cd_for(0x2120, Priority::normal), octet_at(10));
    EXPECT_TRUE(model.write(0x2120, {7}));
    return model;
  };
  EXPECT_EQ(reason_in(model_of_write_after_cd().say(said_at(18, {0x17, 1}))), "");
  EXPECT_EQ(reason_in(model_of_write_after_cd().say(said_at(18, {0x56, 0x21, 0x20, 1, 7}))), "");
  EXPECT_EQ(reason_in(model_of_write_after_cd().say(said_at(18, {0x56, 0x21, 0x20, 0, 7}))),
            "published_wrong");
  EXPECT_EQ(reason_in(model_of_write_after_cd().be_silent()), "no_answer");
  // Of the other buffer it says nothing.
  FfModel model = model_of_write_after_cd();
  model.hear(cd_for(0x2121, Priority::normal), octet_at(60));
  EXPECT_TRUE(model.write(0x2120, {8}));
  EXPECT_EQ(reason_in(model.say(said_at(68, {0x56, 0x21, 0x20, 2, 8}))), "dlpdu_wrong");
}

TEST(FfModel, WhatIsHeardTakesBackWhatIsDue) {
  FfModel model = model_of_device();
  model.hear(kPnForIt, octet_at(10));
  model.hear(kData, octet_at(20));
  EXPECT_EQ(reason_in(model.say(said_at(28, {0x27, 0x21}))), "speaks_unasked");
  model.hear(pt_for(Priority::normal, 200), octet_at(50));
  model.hear(kData, octet_at(60));
  EXPECT_EQ(reason_in(model.say(said_at(68, {kRt}))), "");
  model.hear(pt_for(Priority::normal, 200), octet_at(100));
  model.hear(kTd, octet_at(110));
  EXPECT_EQ(reason_in(model.be_silent()), "");
}

TEST(FfModel, NoiseDelaysAnAnswerUntilItIsNotDueAnyMore) {
  FfModel model = model_of_device();
  model.hear(kPnForIt, octet_at(10));
  model.hear_noise(octet_at(20));
  EXPECT_EQ(reason_in(model.say(said_at(28, {0x27, 0x21}))), "");
  model.hear(kPnForIt, octet_at(100));
  model.hear_noise(octet_at(125));
  EXPECT_EQ(reason_in(model.be_silent()), "");
}

TEST(FfModel, TheLastDatumReturnsTheTokenWhereItIsSetSo) {
  for (const bool returns_with_last_data : {true, false}) {
    fieldbus_dll::FfConfiguration configuration;
    configuration.node = 0x21;
    configuration.rules.returns_with_last_data = returns_with_last_data;
    const auto said = [&](unsigned control) {
      FfModel model(configuration);
      EXPECT_TRUE(model.submit(request_of(Priority::normal, {1})));
      model.hear(pt_for(Priority::normal, 200), octet_at(10));
      return reason_in(model.say(said_at(18, dt1_said(control, {1}))));
    };
    EXPECT_EQ(said(0xD6), returns_with_last_data ? "" : "returned_with_data");
    EXPECT_EQ(said(0xD2), returns_with_last_data ? "last_without_final" : "");
  }
}

TEST(FfModel, ReportsWhatItsUserIsGiven) {
  FfModel model = model_of_device();
  const Octets to_its_user{0xD2, 0x21, 0x40, 0x22, 0x30, 7};
  const Octets between_entities{0xD2, 0x21, 0x00, 0x10, 0x00, 2};
  const Octets empty_between_entities{0xD2, 0x21, 0x00, 0x10, 0x00};
  for (const Octets& one : {to_its_user, between_entities, empty_between_entities, kData})
    model.hear(one, octet_at(10));
  EXPECT_EQ(model.take_reports().size(), 2U);
  model.set_supply(false);
  model.hear(to_its_user, octet_at(50));
  EXPECT_TRUE(model.take_reports().empty());
  model.set_supply(true);
  model.hear(pt_for(Priority::normal, 200), octet_at(100));
  EXPECT_EQ(reason_in(model.be_silent()), "");
  model.hear({0xD2, 0x21, 0x00, 0x10, 0x00, 1}, octet_at(200));
  ASSERT_EQ(model.take_reports().size(), 1U);
  model.hear(pt_for(Priority::normal, 200), octet_at(300));
  EXPECT_EQ(reason_in(model.be_silent()), "token_not_returned");
}

}  // namespace
}  // namespace fieldproof::conformance
