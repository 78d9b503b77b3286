#include "protocols/fieldbus_dll/attached_isa_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "harness/iut/acting_device.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using iut::ActingDevice;
using kernel::kMillisecond;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr kernel::Time kIsaAct{20 * kMillisecond};

IsaConfiguration full_isa_configuration() {
  IsaConfiguration configuration;
  configuration.rules.link.bit_rate = 2'500'000;
  configuration.rules.codes.et = 0x80;
  configuration.rules.reply_wait_octets = 40;
  configuration.rules.last_address = 0xF0;
  configuration.address = 0x33;
  configuration.begins_as_scheduler = false;
  configuration.schedule = {7,
                            50 * kMillisecond,
                            {{kMillisecond, IsaType::et, 0x21, Priority::urgent, 0},
                             {2 * kMillisecond, IsaType::es, 0x22, Priority::normal, 300}}};
  return configuration;
}

TEST(IsaSettings, ComeBackAsTheyWere) {
  for (const IsaConfiguration& configuration : {full_isa_configuration(), IsaConfiguration{}}) {
    const IsaConfiguration back = isa_configuration_of({"x", 1, isa_settings(configuration)});
    EXPECT_EQ(back.rules, configuration.rules);
    EXPECT_EQ(isa_settings(back), isa_settings(configuration));
  }
}

class AttachedIsaDeviceTest : public testing::Test, private IsaUser {
 protected:
  AttachedIsaDeviceTest() {
    segment::MediumPort& place = line_.attach("station/in", segment_.attach(station_, "station"), 0, {});
    station_.wire(place, *this);
    station_.start(kernel::kStart);
  }
  std::string complaint(ActingDevice::Act act) {
    device_.at_time = std::move(act);
    device_.next = kIsaAct;
    try {
      station_.on_time(kIsaAct);
    } catch (const iut::Misbehaviour& done) {
      const bool delivers =
          std::string_view(done.what()).find("delivers to its user") != std::string_view::npos;
      EXPECT_EQ(done.reason(), delivers ? iut::reasons::kNoneDelivered : iut::reasons::kImpossible);
      EXPECT_EQ(done.evidence().size(), delivers ? 1U : 0U);
      return done.what();
    }
    return {};
  }

  ActingDevice device_{iut::UnitKind::levels};
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  AttachedIsaDevice station_{iut::Attachment{&device_, nullptr, {}}, full_isa_configuration(), "x", 7};
  std::vector<std::string> told_;

 private:
  void on_data(const IsaDlpdu& dlpdu, kernel::Time) override { told_.push_back(describe(dlpdu)); }
  void on_event(const IsaEvent& event, kernel::Time) override {
    told_.push_back(std::string(text_of(event.kind)) + " " + std::to_string(event.node));
  }
  bool is_reply_coming(Priority least, kernel::Time) override { return least == Priority::urgent; }
};

TEST_F(AttachedIsaDeviceTest, RequestsOfTheUserAreOctetsAtItsPort) {
  EXPECT_TRUE(station_.submit({IsaService::reply_data, Priority::urgent, 0x22, {0xAA}}, kernel::kStart));
  EXPECT_TRUE(station_.order_transfer(0x11, kernel::kStart));
  EXPECT_TRUE(station_.ask({7, 1}, kernel::kStart));
  std::vector<std::uint16_t> octets;
  for (const ActingDevice::Heard& heard : device_.heard) octets.push_back(heard.character.data);
  EXPECT_THAT(octets, ElementsAre(1, 2, 3, 0x22, 0xAA, 3, 0x11, 7, 1));
}

TEST_F(AttachedIsaDeviceTest, TellsAndAsksItsUser) {
  std::vector<std::uint64_t> answers;
  EXPECT_EQ(complaint([&](iut::Bench& bench) {
              bench.send(kUserPort, kIsaAct, std::vector<std::uint16_t>{1, 0x33, 0xFF, 0x21, 0x00});
              bench.write(kEvent, 0x2200, kIsaAct);
              for (const int priority : {1, 2, 3})
                answers.push_back(bench.read(static_cast<iut::Item>(kReplyComing + priority), kIsaAct));
            }),
            "");
  EXPECT_THAT(told_, ElementsAre("DU urgent 21 -> FF: 00", "reply missing 34"));
  EXPECT_THAT(answers, ElementsAre(0U, 0U, 1U));
}

TEST_F(AttachedIsaDeviceTest, WhatCannotBeIsImpossible) {
  EXPECT_THAT(complaint([](iut::Bench& bench) { bench.read(kReplyComing, kIsaAct); }),
              HasSubstr("reads item 16"));
}

TEST_F(AttachedIsaDeviceTest, AnEventThatIsNoneIsImpossible) {
  EXPECT_THAT(complaint([](iut::Bench& bench) { bench.write(kEvent, 0x1FF09, kIsaAct); }),
              HasSubstr("as an event"));
}

TEST_F(AttachedIsaDeviceTest, DataThatAreNoneAreImpossible) {
  EXPECT_THAT(complaint([](iut::Bench& bench) {
                bench.send(kUserPort, kIsaAct, std::vector<std::uint16_t>{1, 0x42, 0x21, 0x10});
              }),
              HasSubstr("what is no DU or DT here"));
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
