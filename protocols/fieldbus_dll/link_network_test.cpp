#include "protocols/fieldbus_dll/link_network.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"
#include "harness/line/delimited_frame.hpp"
#include "harness/measure/frequency.hpp"
#include "harness/network/network_measurement.hpp"
#include "harness/network/quiet_run.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/ff_network.hpp"
#include "protocols/fieldbus_dll/ff_station.hpp"
#include "protocols/fieldbus_dll/isa_dle.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/fieldbus_dll/isa_network.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

std::unique_ptr<LinkNetwork> make(const LinkDescription& link) {
  if (link.profile == LinkProfile::isa) return std::make_unique<IsaNetwork>(link, 1);
  return std::make_unique<FfNetwork>(link, 1);
}

class LinkNetworkTest : public testing::TestWithParam<LinkProfile> {};

TEST_P(LinkNetworkTest, EveryWordArrivesInEveryMacrocycle) {
  for (const std::int64_t rate : {std::int64_t{31'250}, std::int64_t{1'000'000}}) {
    constexpr unsigned kCycles = kernel::kIsSanitized ? 5 : 20;
    const auto network = make(LinkDescription::built_in(GetParam(), rate));
    const network::CycleKind kind = network->cycles().front();
    const network::QuietRun run = network::run_quietly(*network, kCycles, 5);
    ASSERT_TRUE(run.came_up) << rate;
    ASSERT_EQ(run.cycles.size(), kCycles);
    EXPECT_EQ(run.counts.detected, 0U) << rate;
    EXPECT_EQ(run.counts.accepted_wrong() + run.counts.missed_outputs, 0U) << rate;
    for (const kernel::Duration cycle : run.cycles)
      EXPECT_LE(std::chrono::abs(cycle - kind.theory), kind.jitter);
  }
}

TEST_P(LinkNetworkTest, StartsAgainAfterAStop) {
  const auto network = make(LinkDescription::built_in(GetParam()));
  ASSERT_TRUE(network::run_quietly(*network, 3, 5).came_up);
  network->stop();
  EXPECT_EQ(network->state(), network::State::stopped) << "at once: nobody has a supply";
  const kernel::Time off = network->segment().now();
  network->segment().run_for(kernel::kSecond);
  EXPECT_EQ(network->state(), network::State::stopped);
  // With a pause, and where all that runs is switched off and on.
  for (int n = 0; n < 2; ++n) {
    const network::QuietRun run = network::run_quietly(*network, 5, 6);
    ASSERT_TRUE(run.came_up) << n;
    EXPECT_EQ(run.counts.detected + run.counts.accepted_wrong() + run.counts.missed_outputs, 0U) << n;
    EXPECT_EQ(run.cycles.size(), 5U) << n;
  }
  EXPECT_GT(network->segment().now(), off);
}

INSTANTIATE_TEST_SUITE_P(Profiles, LinkNetworkTest,
                         testing::Values(LinkProfile::foundation, LinkProfile::isa));

// Publishes its words with a bit turned.
class TurnsABit final : public FfStation {
 public:
  using FfStation::FfStation;
  bool write(FfAddress address, const Octets& data, kernel::Time now) override {
    Octets turned = data;
    turned.back() ^= 0x80;
    return FfStation::write(address, turned, now);
  }
};

TEST(FfNetworkTest, AWordThatNobodyGaveIsSeen) {
  FfNetwork network(LinkDescription::built_in(LinkProfile::foundation), 1,
                    {.make_device = [](std::size_t position,
                                       const FfConfiguration& configuration) -> std::unique_ptr<FfDevice> {
                      return position == 2 ? std::make_unique<TurnsABit>(configuration) : nullptr;
                    }});
  const network::QuietRun run = network::run_quietly(network, 5, 5);
  EXPECT_GT(run.counts.accepted_wrong_inputs, 3U);
}

// Gets all, and drives nothing.
template <typename Base, typename User>
class Mute final : public Base {
 public:
  using Base::Base;
  void wire(segment::Port&, User& user) override { Base::wire(nowhere_, user); }

 private:
  struct Nowhere final : segment::Port {
    void drive(line::Waveform&) override {}
  };
  Nowhere nowhere_;
};

template <typename Device, typename Given, typename Configuration>
auto given_at(std::size_t wanted) {
  return [wanted](std::size_t position, const Configuration& configuration) -> std::unique_ptr<Device> {
    return position == wanted ? std::make_unique<Given>(configuration) : nullptr;
  };
}

// A word from the first device to the second, and none for the third.
LinkDescription one_word(LinkProfile profile) {
  LinkDescription link = LinkDescription::built_in(profile, 31'250, 3);
  link.data.resize(1);
  return link;
}

void expect_absent(LinkNetwork& network, const std::string& station) {
  EXPECT_FALSE(network::run_quietly(network, 5, 5).came_up) << station;
  EXPECT_NE(network.complaint().find(station + " did not take part"), std::string::npos)
      << network.complaint();
}

TEST(FfNetworkTest, DoesNotComeUpWithoutAStationUnderTest) {
  const LinkDescription link = one_word(LinkProfile::foundation);
  for (const std::size_t position : {1U, 2U}) {
    FfNetwork network(link, 1,
                      {.make_master = given_at<FfDevice, Mute<FfLas, FfUser>, FfConfiguration>(position)});
    expect_absent(network, "ff_las@" + std::to_string(position));
  }
  for (const std::size_t position : {1U, 2U, 3U}) {
    FfNetwork network(
        link, 1, {.make_device = given_at<FfDevice, Mute<FfStation, FfUser>, FfConfiguration>(position)});
    expect_absent(network, "ff_device@" + std::to_string(position));
  }
}

TEST(IsaNetworkTest, DoesNotComeUpWithoutAStationUnderTest) {
  const LinkDescription link = one_word(LinkProfile::isa);
  IsaNetwork first(link, 1, {.make_master = given_at<IsaDevice, Mute<IsaLas, IsaUser>, IsaConfiguration>(1)});
  expect_absent(first, "isa_las@1");
  IsaNetwork sender(link, 1,
                    {.make_device = given_at<IsaDevice, Mute<IsaDle, IsaUser>, IsaConfiguration>(1)});
  expect_absent(sender, "isa_dle@1");
}

// However right it is: nothing is seen of it.
void expect_uncalled(LinkNetwork& network, const std::string& station) {
  EXPECT_FALSE(network::run_quietly(network, 5, 5).came_up) << station;
  EXPECT_NE(network.complaint().find("nothing can be seen of " + station), std::string::npos)
      << network.complaint();
  EXPECT_EQ(network.complaint().find("did not take part"), std::string::npos) << network.complaint();
}

TEST(IsaNetworkTest, SaysThatTheScheduleNeverCallsAStation) {
  const LinkDescription link = one_word(LinkProfile::isa);
  IsaNetwork master(link, 1, {.make_master = given_at<IsaDevice, IsaLas, IsaConfiguration>(2)});
  expect_uncalled(master, "isa_las@2");
  IsaNetwork device(link, 1, {.make_device = given_at<IsaDevice, IsaDle, IsaConfiguration>(3)});
  expect_uncalled(device, "isa_dle@3");
}

// Works for a while, and then does nothing any more, for good.
class Dies final : public FfStation {
 public:
  using FfStation::FfStation;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    if (reception.start < kDead) FfStation::receive(port, reception);
  }
  void on_time(kernel::Time now) override {
    if (now < kDead) FfStation::on_time(now);
  }
  kernel::Time next_time() const override {
    const kernel::Time next = FfStation::next_time();
    return next < kDead ? next : kernel::kNever;
  }

  static constexpr kernel::Time kDead = kernel::kStart + 20 * kernel::kSecond;
};

TEST(FfNetworkTest, StopsWhenAStationWithoutAWordDies) {
  FfNetwork network(one_word(LinkProfile::foundation), 1,
                    {.make_device = given_at<FfDevice, Dies, FfConfiguration>(3)});
  network.start();
  network.segment().run_until(Dies::kDead);
  EXPECT_EQ(network.state(), network::State::exchanging);
  network.segment().run_for(2 * network.bring_up_limit());
  EXPECT_EQ(network.state(), network::State::stopped);
  EXPECT_NE(network.complaint().find("ff_device@3 takes part no more"), std::string::npos)
      << network.complaint();
  network.start();
  network.segment().run_for(2 * network.bring_up_limit());
  EXPECT_EQ(network.state(), network::State::stopped);
  EXPECT_NE(network.complaint().find("ff_device@3 did not"), std::string::npos) << network.complaint();
}

TEST(FfNetworkTest, GoesOnAsLongAsAStationWithoutAWordWorks) {
  FfNetwork network(one_word(LinkProfile::foundation), 1,
                    {.make_device = given_at<FfDevice, FfStation, FfConfiguration>(3)});
  network.start();
  network.segment().run_for(20 * network.bring_up_limit());
  EXPECT_EQ(network.state(), network::State::exchanging);
}

TEST(IsaNetworkTest, WhoHasNoWordToSendTakesPartByTheOneThatItGets) {
  IsaNetwork network(one_word(LinkProfile::isa), 1,
                     {.make_device = given_at<IsaDevice, Mute<IsaDle, IsaUser>, IsaConfiguration>(2)});
  EXPECT_TRUE(network::run_quietly(network, 5, 5).came_up);
}

// A link of two masters and three devices with these words.
LinkDescription link_of(LinkProfile profile, std::vector<DataDescription> data) {
  LinkDescription link = LinkDescription::built_in(profile, 31'250, 3);
  link.data = std::move(data);
  return link;
}

constexpr kernel::Duration kSecondWord = 200 * kernel::kMillisecond;
constexpr std::uint8_t kScheduler = 0x10;
constexpr std::uint8_t kFirst = 0x12;
constexpr std::uint8_t kSecond = 0x13;
constexpr std::uint8_t kThird = 0x14;

measure::Measurement measured(const LinkDescription& link) {
  network::MeasurementSettings settings;
  settings.signals = {{.frequency = measure::Frequency::read("0.3Hz").value()}};
  settings.duration = 200 * kernel::kSecond;
  return network::measure_network([&](std::uint64_t) { return make(link); }, settings);
}

void expect_all_served(const LinkDescription& link) {
  const auto network = make(link);
  const network::QuietRun run = network::run_quietly(*network, 10, 5);
  ASSERT_TRUE(run.came_up);
  EXPECT_EQ(run.cycles.size(), 10U);
  EXPECT_GE(run.counts.sent, 9 * link.data.size());
  EXPECT_EQ(run.counts.detected + run.counts.accepted_wrong() + run.counts.missed_outputs, 0U);
  for (const kernel::Duration cycle : run.cycles) {
    EXPECT_LE(std::chrono::abs(cycle - network->cycles().front().theory), network->cycles().front().jitter);
  }
  EXPECT_NE(measure::agreement(measured(link)), measure::Agreement::differs);
}

TEST(FfNetworkTest, ASchedulerPublishesItsOwnWords) {
  expect_all_served(link_of(LinkProfile::foundation, {{kScheduler, kFirst, {}}}));
  expect_all_served(
      link_of(LinkProfile::foundation, {{kScheduler, kFirst, {}}, {kFirst, kScheduler, kSecondWord}}));
  expect_all_served(
      link_of(LinkProfile::foundation, {{kFirst, kScheduler, {}}, {kScheduler, kFirst, kSecondWord}}));
}

TEST(FfNetworkTest, WordsOfDifferentInstantsAreNoImage) {
  expect_all_served(
      link_of(LinkProfile::foundation, {{kFirst, kSecond, {}}, {kFirst, kSecond, kSecondWord}}));
}

TEST(IsaNetworkTest, AStationMaySendTwoWords) {
  expect_all_served(link_of(LinkProfile::isa, {{kFirst, kSecond, {}}, {kFirst, kThird, kSecondWord}}));
  expect_all_served(link_of(LinkProfile::isa, {{kFirst, kSecond, {}}, {kFirst, kSecond, kSecondWord}}));
}

// Receives nothing once, for so long that a token is lost.
class MissesAToken final : public IsaDle {
 public:
  using IsaDle::IsaDle;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    constexpr kernel::Time kFrom = kernel::kStart + 3 * kernel::kSecond - 10 * kernel::kMillisecond;
    if (reception.start < kFrom || reception.start > kFrom + kSecondWord / 2)
      IsaDle::receive(port, reception);
  }
};

TEST(IsaNetworkTest, AWordThatMissedItsTokenGoesWithTheNext) {
  const auto link = link_of(LinkProfile::isa, {{kFirst, kSecond, {}}, {kFirst, kThird, kSecondWord}});
  IsaNetwork network(link, 1, {.make_device = given_at<IsaDevice, MissesAToken, IsaConfiguration>(1)});
  const network::QuietRun run = network::run_quietly(network, 20, 5);
  ASSERT_TRUE(run.came_up);
  EXPECT_EQ(run.counts.missing, 1U);
  EXPECT_EQ(run.counts.detected, 1U);
  EXPECT_EQ(run.counts.accepted_wrong(), 0U);
}

// Counts what comes to it and is no whole frame.
template <typename Base>
class CountsTorn final : public Base {
 public:
  template <typename Configuration>
  CountsTorn(const Configuration& configuration, unsigned& torn) : Base(configuration), torn_(torn) {}
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    const auto frames = line::delimited_frames_in(reception, kBitRate);
    if (frames.size() != 1 || frames[0].end != line::FrameEnd::whole) ++torn_;
    Base::receive(port, reception);
  }

  static constexpr std::int64_t kBitRate = 31'250;

 private:
  unsigned& torn_;
};

// At instants that fall into frames of all kinds, and between them.
void restart_often(LinkNetwork& network, bool pauses) {
  constexpr int kRestarts = 100;
  network.start();
  for (int n = 0; n < kRestarts; ++n) {
    network.segment().run_for(600 * kernel::kMillisecond + n * 1'037 * kernel::kMicrosecond);
    if (pauses) {
      network.stop();
      network.segment().run_for(network.acceptance().pause_before_start);
    }
    network.start();
  }
  const kernel::Time end = network.segment().now() + network.bring_up_limit();
  while (network.segment().now() < end && network.state() != network::State::exchanging)
    network.segment().run_for(10 * kernel::kMillisecond);
  EXPECT_EQ(network.state(), network::State::exchanging);
}

TEST(FfNetworkTest, AStartTearsNoFrame) {
  for (const bool pauses : {false, true}) {
    unsigned torn = 0;
    FfNetwork network(LinkDescription::built_in(LinkProfile::foundation), 1,
                      {.make_device = [&](std::size_t position,
                                          const FfConfiguration& configuration) -> std::unique_ptr<FfDevice> {
                        if (position != 1) return nullptr;
                        return std::make_unique<CountsTorn<FfStation>>(configuration, torn);
                      }});
    restart_often(network, pauses);
    EXPECT_EQ(torn, 0U) << pauses;
  }
}

TEST(IsaNetworkTest, AStartTearsNoFrame) {
  for (const bool pauses : {false, true}) {
    unsigned torn = 0;
    IsaNetwork network(
        LinkDescription::built_in(LinkProfile::isa), 1,
        {.make_device = [&](std::size_t position,
                            const IsaConfiguration& configuration) -> std::unique_ptr<IsaDevice> {
          if (position != 1) return nullptr;
          return std::make_unique<CountsTorn<IsaDle>>(configuration, torn);
        }});
    restart_often(network, pauses);
    EXPECT_EQ(torn, 0U) << pauses;
  }
}

std::string refusal_of(const std::string& text) {
  try {
    const config::Document document = config::Document::parse(text, "link.json");
    LinkDescription::read(document.root());
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.exit_code(), 65);
    return error.what();
  }
  return "";
}

TEST(LinkDescriptionTest, RefusesWhatNoLinkIs) {
  const auto link = [](const std::string& rest) {
    return R"({"profile": "foundation", "name": "a", "masters": [16], )" + rest + "}";
  };
  EXPECT_EQ(refusal_of(link(R"("devices": [20, 21], "data": [{"from": 20, "to": 21, "at": "0 ms"}])")), "");
  EXPECT_NE(refusal_of(link(R"("devices": [20, 20], "data": [{"from": 20, "to": 16, "at": "0 ms"}])"))
                .find("twice"),
            std::string::npos);
  EXPECT_NE(
      refusal_of(link(R"("devices": [3], "data": [{"from": 3, "to": 16, "at": "0 ms"}])")).find("16 to 247"),
      std::string::npos);
  EXPECT_NE(
      refusal_of(link(R"("devices": [20], "data": [{"from": 20, "to": 21, "at": "0 ms"}])")).find("stations"),
      std::string::npos);
  EXPECT_NE(
      refusal_of(link(R"("devices": [20], "data": [{"from": 20, "to": 16, "at": "0.01 ms"}])")).find("1/32"),
      std::string::npos);
  EXPECT_NE(refusal_of(link(R"("devices": [20, 21], "data": [{"from": 20, "to": 21, "at": "0 ms"},
      {"from": 21, "to": 20, "at": "1 ms"}])"))
                .find("next one begins"),
            std::string::npos);
  EXPECT_NE(
      refusal_of(
          link(R"("devices": [20], "data": [{"from": 20, "to": 16, "at": "0 ms"}], "not_exposed": [9])"))
          .find("node 9"),
      std::string::npos);
}

TEST(LinkDescriptionTest, TheLargestLinkHas232Stations) {
  const LinkDescription link = LinkDescription::built_in(LinkProfile::foundation, 1'000'000, 230);
  EXPECT_FALSE(violation_of(link).has_value());
  LinkDescription more = link;
  more.masters.push_back(0x0F);
  EXPECT_NE(violation_of(more)->sentence.find("at most 232"), std::string::npos);
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
