#include "protocols/valve_bus/attached_host.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "harness/iut/acting_device.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"

namespace fieldproof::valve_bus {
namespace {

using iut::ActingDevice;
using kernel::kMillisecond;
using kernel::kNever;
using kernel::kStart;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr kernel::Time kCalledAt{20 * kMillisecond};

class AttachedHostTest : public testing::Test, private HostApplication {
 protected:
  AttachedHostTest() {
    host_.wire(line_.attach("host/in", segment_.attach(host_, "host"), 0, {}), *this);
    host_.set_power(true, kStart);
  }
  // What is told about an implementation that acts so; empty when there is nothing wrong with it.
  std::string complaint(ActingDevice::Act act) {
    device_.at_time = std::move(act);
    try {
      host_.on_time(kCalledAt);
    } catch (const iut::Misbehaviour& done) {
      EXPECT_EQ(done.reason(), iut::reasons::kImpossible);
      return done.what();
    }
    return {};
  }

  HostConfiguration configuration_{.rules = {}, .dip = 3, .receives_own_echo = true};
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  ActingDevice device_{iut::UnitKind::levels};
  AttachedHost host_{iut::Attachment{&device_, nullptr, {}}, configuration_, "valve_bus/host/x", 7};
  std::vector<std::string> told_;

 private:
  void on_response(const HostResponse& response, kernel::Time when) override {
    EXPECT_EQ(when, kCalledAt);
    told_.push_back(fmt::format("{:02X}: {:02X} {:02X}{}", response.id, response.data0, response.data1,
                                response.is_old ? " old" : ""));
  }
  void on_error(const HostError& error, kernel::Time) override {
    told_.push_back(fmt::format("{:02X}: {}", error.id, describe(error.kind)));
  }
};

TEST_F(AttachedHostTest, SettingsComeBack) {
  HostConfiguration configuration{.rules = {}, .dip = 2, .receives_own_echo = true, .verifies_writes = true};
  configuration.rules.characters = CharacterProfile::even_parity;
  configuration.rules.answers_writes = true;
  const HostConfiguration back = host_configuration_of({"x", 1, host_settings(configuration)});
  EXPECT_EQ(back.rules, configuration.rules);
  EXPECT_EQ(host_settings(back), host_settings(configuration));
  EXPECT_EQ(device_.told.settings, host_settings(configuration_));
}

TEST_F(AttachedHostTest, OctetsOfThePcAreCharactersAtItsPort) {
  std::vector<std::uint8_t> octets(5000, 0x17);
  octets.back() = 0xFE;
  host_.write(octets, kCalledAt);
  std::vector<std::uint16_t> told;
  for (const ActingDevice::Heard& heard : device_.heard) {
    EXPECT_EQ(heard.port, kPcPort);
    EXPECT_EQ(heard.now, kCalledAt);
    told.push_back(heard.character.data);
  }
  EXPECT_TRUE(std::ranges::equal(told, octets));
}

TEST_F(AttachedHostTest, ResponsesAndErrorsAreToldToThePc) {
  EXPECT_EQ(complaint([](iut::Bench& bench) {
              bench.write(kResponse, 0x01'34'12'05, kCalledAt);
              bench.write(kError, 0x02'63, kCalledAt);
            }),
            "");
  EXPECT_THAT(told_, ElementsAre("05: 12 34 old", "63: no response"));
}

TEST_F(AttachedHostTest, WordsThatThePcLooksAtAreKept) {
  EXPECT_EQ(complaint([](iut::Bench& bench) {
              bench.write(kFifoRoom, 508, kCalledAt);
              bench.write(kOverflow, 1, kCalledAt);
              bench.write(kTimeouts + 99, 4, kCalledAt);
              bench.write(kRetries + 99, 2, kCalledAt);
            }),
            "");
  EXPECT_EQ(host_.fifo_room(), 508U);
  EXPECT_TRUE(host_.has_overflowed());
  EXPECT_EQ(host_.counters(99), (HostCounters{.timeouts = 4, .rejected = 0, .late = 0, .retries = 2}));
  EXPECT_EQ(host_.counters(98), HostCounters{});
}

TEST_F(AttachedHostTest, SwitchesAreReadAsTheyStand) {
  std::vector<std::uint64_t> read;
  const auto look = [&](iut::Bench& bench) { read.push_back(bench.read(kDip, kCalledAt)); };
  EXPECT_EQ(complaint(look), "");
  host_.set_dip(1);
  EXPECT_EQ(complaint(look), "");
  EXPECT_THAT(read, ElementsAre(3, 1));
}

struct WrongAct {
  const char* sentence;
  void (*act)(iut::Bench&);
};

class AttachedHostActs : public AttachedHostTest, public testing::WithParamInterface<WrongAct> {};

TEST_P(AttachedHostActs, IsImpossible) {
  EXPECT_THAT(complaint(GetParam().act), HasSubstr(GetParam().sentence));
  EXPECT_TRUE(told_.empty());
  EXPECT_EQ(host_.next_time(), kNever);
}

INSTANTIATE_TEST_SUITE_P(
    All, AttachedHostActs,
    testing::Values(
        WrongAct{"as a response", [](iut::Bench& bench) { bench.write(kResponse, 0x0200'0000, kCalledAt); }},
        WrongAct{"error of kind 9", [](iut::Bench& bench) { bench.write(kError, 0x0905, kCalledAt); }},
        WrongAct{"writes 2 to item 4", [](iut::Bench& bench) { bench.write(kOverflow, 2, kCalledAt); }},
        WrongAct{"item 5, which a host does not have",
                 [](iut::Bench& bench) { bench.write(5, 0, kCalledAt); }},
        WrongAct{"item 1280, which", [](iut::Bench& bench) { bench.write(0x500, 0, kCalledAt); }},
        WrongAct{"item 0, which", [](iut::Bench& bench) { bench.write(kDip, 0, kCalledAt); }},
        WrongAct{"reads item 1", [](iut::Bench& bench) { bench.read(kResponse, kCalledAt); }},
        WrongAct{"reports something to its PC at",
                 [](iut::Bench& bench) { bench.write(kFifoRoom, 0, kCalledAt - kMillisecond); }},
        WrongAct{"drives port 1", [](iut::Bench& bench) { bench.set_driver(1, true, kCalledAt); }}));

}  // namespace
}  // namespace fieldproof::valve_bus
