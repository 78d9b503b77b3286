#include "protocols/fieldbus_dll/attached_ff_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "harness/iut/acting_device.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/fieldbus_dll/test_link.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using Sent = std::vector<std::uint16_t>;

using iut::ActingDevice;
using kernel::kMillisecond;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr kernel::Time kAct{20 * kMillisecond};

FfConfiguration full_configuration() {
  FfConfiguration configuration;
  configuration.rules.link = {1'000'000, 3, 9, 5, 10, {200, 100, 50}};
  configuration.rules.codes.pt = 0x70;
  configuration.rules.first_unpolled = 0x30;
  configuration.rules.unpolled = 7;
  configuration.rules.token_holding_octets = 999;
  configuration.rules.target_rotation = 7 * kMillisecond;
  configuration.rules.steers_by_three_steps = false;
  configuration.rules.returns_with_last_data = false;
  configuration.node = 0x44;
  configuration.supports_long_addresses = false;
  configuration.begins_as_scheduler = true;
  configuration.published = {0x4420, 0x12344421};
  configuration.subscribed = {0x2020};
  configuration.live = {0x11, 0x12};
  configuration.schedule = {9, 16'000, {{100, 0x4420, Priority::urgent}, {900, 0x2020, Priority::normal}}};
  return configuration;
}

TEST(FfSettings, ComeBackAsTheyWere) {
  for (const FfConfiguration& configuration : {full_configuration(), FfConfiguration{}}) {
    const FfConfiguration back = ff_configuration_of({"x", 1, ff_settings(configuration)});
    EXPECT_EQ(back.rules, configuration.rules);
    EXPECT_EQ(ff_settings(back), ff_settings(configuration));
  }
}

TEST(FfSettings, ThatAreNotToldAreThoseOfTheReference) {
  EXPECT_EQ(ff_settings(ff_configuration_of({"x", 1, {}})), ff_settings({}));
}

TEST(FfSettings, ThatAreImpossibleAreRefused) {
  const field::Settings impossible{
      {"bit_rate", 0}, {"node", 4'711}, {"published", 1'000'000}, {"preamble_octets", -3}};
  for (const auto& one : impossible) {
    try {
      ff_configuration_of({"x", 1, {one}});
      ADD_FAILURE() << one.first;
    } catch (const kernel::Error& refused) {
      EXPECT_THAT(refused.what(), HasSubstr("'" + one.first + "' is " + std::to_string(one.second)));
    }
  }
}

class AttachedFfDeviceTest : public testing::Test, private FfUser {
 protected:
  explicit AttachedFfDeviceTest(iut::UnitKind unit = iut::UnitKind::levels) : device_(unit) {
    seat_ = segment_.attach(station_, "station");
    segment::MediumPort& place = line_.attach("station/in", seat_, 0, {});
    place.sense_activity();
    tester_ = &line_.attach("tester/in", segment_.attach(nobody_, "tester"), 0, {});
    place.tap_driven(ear_);
    station_.wire(place, *this);
    EXPECT_TRUE(station_.start(kernel::kStart));
  }

  // What is told about an implementation that acts so; empty when there is nothing wrong with it.
  std::string complaint(ActingDevice::Act act) {
    device_.at_time = std::move(act);
    device_.next = kAct;
    segment_.refresh(seat_);
    try {
      segment_.run_until(kAct + 100 * kMillisecond);
    } catch (const iut::Misbehaviour& done) {
      const bool delivers =
          std::string_view(done.what()).find("delivers to its user") != std::string_view::npos;
      EXPECT_EQ(done.reason(), delivers ? iut::reasons::kNoneDelivered : iut::reasons::kImpossible);
      EXPECT_EQ(done.evidence().size(), delivers ? 1U : 0U);
      return done.what();
    }
    return {};
  }
  struct Nobody final : segment::Station {
    void receive(segment::PortIndex, const line::Waveform&) override {}
    void on_time(kernel::Time) override {}
    kernel::Time next_time() const override { return kernel::kNever; }
  };
  struct Ear final : segment::Tap {
    void on_wave(const line::Waveform& wave) override { starts.push_back(wave.start); }
    std::vector<kernel::Time> starts;
  };

  ActingDevice device_;
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  AttachedFfDevice station_{iut::Attachment{&device_, nullptr, {}}, full_configuration(), "x", 7};
  Nobody nobody_;
  Ear ear_;
  std::size_t seat_ = 0;
  segment::MediumPort* tester_ = nullptr;
  std::vector<std::string> told_;

 private:
  void on_data(const FfDlpdu& dlpdu, kernel::Time) override { told_.push_back(describe(dlpdu)); }
  void on_published(const FfDlpdu& dlpdu, kernel::Time) override { told_.push_back(describe(dlpdu)); }
  void on_event(const FfEvent& event, kernel::Time) override {
    told_.push_back(std::string(text_of(event.kind)) + " " + std::to_string(event.node));
  }
};

class AttachedFfFrames : public AttachedFfDeviceTest {
 protected:
  AttachedFfFrames() : AttachedFfDeviceTest(iut::UnitKind::telegrams) {}

  void say(const Octets& octets, unsigned preamble_octets) {
    LinkRules rules = full_configuration().rules.link;
    rules.preamble_octets = preamble_octets;
    LineEnd end(rules);
    end.wire(*tester_);
    segment_.run_until(end.transmit(octets, segment_.now()));
  }
};

TEST_F(AttachedFfDeviceTest, IsToldItsCaseAndItsSupply) {
  EXPECT_EQ(device_.told.settings, ff_settings(full_configuration()));
  EXPECT_THAT(device_.power, ElementsAre(true));
}

TEST_F(AttachedFfDeviceTest, RequestsOfTheUserAreOctetsAtItsPort) {
  EXPECT_TRUE(station_.submit({Priority::urgent, 0x12342030, {0xAA, 0xBB}}, kernel::kStart));
  EXPECT_TRUE(station_.write(0x4420, Octets{1}, kernel::kStart));
  station_.order_transfer(0x11, kernel::kStart);
  std::string octets;
  for (const ActingDevice::Heard& heard : device_.heard) {
    EXPECT_EQ(heard.port, kUserPort);
    octets += std::to_string(heard.character.data) + " ";
  }
  EXPECT_EQ(octets, "1 3 18 52 32 48 170 187 2 0 0 68 32 1 3 17 ");
}

TEST_F(AttachedFfDeviceTest, WhatItTellsItsUserArrivesThere) {
  EXPECT_EQ(complaint([](iut::Bench& bench) {
              bench.send(kUserPort, kAct, Sent{1, 0xD2, 0x44, 0x30, 0x20, 0x01, 0xAA});
              bench.write(kEvent, 0x4400, kAct);
            }),
            "");
  EXPECT_THAT(told_, ElementsAre("DT1 normal to 4430 from 2001: AA", "activated 68"));
}

TEST_F(AttachedFfDeviceTest, WhatItDrivesAheadIsOnTheLineWhenItsTimeHasCome) {
  constexpr kernel::Time kLater = kAct + 5 * kMillisecond;
  EXPECT_EQ(complaint([&](iut::Bench& bench) {
              line::Waveform wave{kLater, 2'000'000, {}};
              wave.levels.append(0b0101, 4);
              bench.transmit(kLinePort, wave);
              EXPECT_TRUE(ear_.starts.empty());
            }),
            "");
  EXPECT_THAT(ear_.starts, ElementsAre(kLater));
}

TEST_F(AttachedFfFrames, AreToldAsTheirOctetsAndDrivenFromThem) {
  say({0x72, 0x44, 0x00, 0x64}, 3);
  std::vector<std::uint16_t> told;
  for (const ActingDevice::Heard& heard : device_.heard) {
    if (heard.port == kLinePort) told.push_back(heard.character.data);
  }
  ASSERT_EQ(told.size(), 6U);
  EXPECT_EQ(told[0], 0x72);
  EXPECT_EQ(complaint([](iut::Bench& bench) { bench.send(kLinePort, kAct, Sent{0x34, 1, 2}); }), "");
  EXPECT_THAT(ear_.starts, ElementsAre(kAct));
}

TEST_F(AttachedFfFrames, OfAnotherKindDoNotApply) {
  EXPECT_THROW(say({0x72, 0x44, 0x00, 0x64}, 1), iut::CannotBeDone);
}

TEST(AttachedFfCharacters, AreRefused) {
  ActingDevice device{iut::UnitKind::characters};
  EXPECT_THROW(AttachedFfDevice(iut::Attachment{&device, nullptr, {}}, {}, "x", 1), kernel::Error);
}

struct WrongAct {
  const char* sentence;
  iut::UnitKind unit;
  void (*act)(iut::Bench&);
};

class AttachedFfActs : public AttachedFfDeviceTest, public testing::WithParamInterface<WrongAct> {
 protected:
  AttachedFfActs() : AttachedFfDeviceTest(GetParam().unit) {}
};

TEST_P(AttachedFfActs, AreImpossible) {
  EXPECT_THAT(complaint(GetParam().act), HasSubstr(GetParam().sentence));
  EXPECT_TRUE(told_.empty());
  EXPECT_EQ(station_.next_time(), kernel::kNever);
}

constexpr auto kLevels = iut::UnitKind::levels;
constexpr auto kFrames = iut::UnitKind::telegrams;

INSTANTIATE_TEST_SUITE_P(
    All, AttachedFfActs,
    testing::Values(WrongAct{"nothing is asked of it", kLevels,
                             [](iut::Bench& bench) { bench.write(kRefused, 1, kAct); }},
                    WrongAct{"writes item 2", kLevels, [](iut::Bench& bench) { bench.write(2, 0, kAct); }},
                    WrongAct{"reports Bh as an event", kLevels,
                             [](iut::Bench& bench) { bench.write(kEvent, 0x0B, kAct); }},
                    WrongAct{"reads item 0", kLevels, [](iut::Bench& bench) { bench.read(0, kAct); }},
                    WrongAct{"neither 01 and a DT1", kLevels,
                             [](iut::Bench& bench) { bench.send(kUserPort, kAct, Sent{4, 0x34}); }},
                    WrongAct{"what is no DT1 here", kLevels,
                             [](iut::Bench& bench) { bench.send(kUserPort, kAct, Sent{1, 0x34}); }},
                    WrongAct{"what is no DT3 here", kLevels,
                             [](iut::Bench& bench) { bench.send(kUserPort, kAct, Sent{2}); }},
                    WrongAct{"neither 01 and a DT1", kLevels,
                             [](iut::Bench& bench) { bench.send(kUserPort, kAct, Sent{}); }},
                    WrongAct{"reports no octets to its user", kLevels,
                             [](iut::Bench& bench) { bench.send(kUserPort, kAct, Sent{1, 0x100}); }},
                    WrongAct{"drives port 1", kFrames,
                             [](iut::Bench& bench) { bench.send(1, kAct, Sent{1}); }},
                    WrongAct{"drives telegrams, having announced levels", kLevels,
                             [](iut::Bench& bench) { bench.send(kLinePort, kAct, Sent{1}); }},
                    WrongAct{"a frame of 0 octets", kFrames,
                             [](iut::Bench& bench) { bench.send(kLinePort, kAct, Sent{}); }},
                    WrongAct{"drives 256 as an octet", kFrames,
                             [](iut::Bench& bench) { bench.send(kLinePort, kAct, Sent{0x100}); }},
                    WrongAct{"drives a frame at", kFrames,
                             [](iut::Bench& bench) {
                               const kernel::Time past = kAct - kMillisecond;
                               bench.send(kLinePort, past, Sent{1});
                             }},
                    WrongAct{"drives already until", kFrames, [](iut::Bench& bench) {
                               bench.send(kLinePort, kAct, Sent{1});
                               bench.send(kLinePort, kAct, Sent{1});
                             }}));

}  // namespace
}  // namespace fieldproof::fieldbus_dll
