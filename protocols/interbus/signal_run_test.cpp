// Subject: square waves through a ring.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/fault/channel.hpp"
#include "harness/kernel/error.hpp"
#include "harness/network/signal_run.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::kSecond;
using measure::Frequency;
using measure::Phase;
using network::SignalRecord;
using network::SignalSettings;

SignalRecord record_signal(const NetworkDescription& description, const SignalSettings& settings,
                           const RunningStations& stations = {}) {
  RunningNetwork network(description, stations);
  return network::record_signal(network, settings);
}

SignalSettings settings_at(std::int64_t hertz, kernel::Duration duration = 2 * kSecond) {
  SignalSettings settings;
  settings.wave.frequency = Frequency::from_hertz(hertz);
  settings.duration = duration;
  return settings;
}

NetworkDescription paper_at(kernel::Duration cycle) {
  NetworkDescription network = paper_network();
  network.cycle_time = cycle;
  return network;
}

TEST(SignalRunTest, EveryPulseOfEveryTrainIsSeen) {
  const SignalRecord record = record_signal(paper_at(kPaperBestCycle), settings_at(200));
  ASSERT_EQ(record.paths.size(), 1U);
  const measure::EdgeSkew& skew = record.paths.front().skew;
  EXPECT_EQ(record.paths.front().path.name, "di16 word 0 to do16 word 0");
  EXPECT_GT(record.trains, 40);
  EXPECT_EQ(skew.pulses, static_cast<std::uint64_t>(8 * record.trains));
  EXPECT_EQ(skew.lost_pulses + skew.lost_pauses + skew.foreign_words, 0U);
  EXPECT_EQ(skew.rise_delays.total().count(), skew.pulses);
  EXPECT_EQ(skew.widths.total().count(), skew.pulses);
  EXPECT_EQ(record.unserved_exchanges + record.service_exchanges, 0U);
  EXPECT_EQ(record.cycles.front().times.total().min(), kPaperBestCycle.count());
  EXPECT_EQ(record.cycles.front().times.total().max(), kPaperBestCycle.count());
}

TEST(SignalRunTest, ASeedDecidesEverything) {
  const auto delays = [](std::uint64_t seed) {
    SignalSettings settings = settings_at(150);
    settings.seed = seed;
    return record_signal(paper_at(kPaperBestCycle), settings).paths.front().skew.rise_delays.total().mean();
  };
  EXPECT_EQ(delays(1), delays(1));
  EXPECT_NE(delays(1), delays(2));
}

TEST(SignalRunTest, OneTrainIsTheLeast) {
  const SignalRecord record = record_signal(paper_network(), settings_at(50, kernel::kPicosecond));
  EXPECT_EQ(record.trains, 1);
  EXPECT_EQ(record.paths.front().skew.pulses, 8U);
}

// At 50 Hz and a cycle of 0.8 ms a period is exactly 25 cycles: a continuous signal meets the cycle at one
// phase, and the delays of its edges look like a constant. Trains of one signal show the whole distribution.
TEST(SignalRunTest, ACommensurableSignalShowsOneDelayOnlyWithoutTrains) {
  const NetworkDescription network = paper_at(800 * kernel::kMicrosecond);
  SignalSettings settings = settings_at(50, 20 * kSecond);
  const auto trains = record_signal(network, settings).paths.front().skew.rise_delays.total();
  EXPECT_NEAR(trains.standard_deviation() / 800e6, 0.2887, 0.01);
  settings.periods_per_train = 1'000;
  settings.duration = kernel::kPicosecond;
  const SignalRecord continuous = record_signal(network, settings);
  EXPECT_EQ(continuous.trains, 1);
  const auto delays = continuous.paths.front().skew.rise_delays.total();
  EXPECT_EQ(delays.count(), 1'000U);
  EXPECT_EQ(delays.min(), delays.max());
}

TEST(SignalRunTest, TheTraceIsThatOfTheFirstTrain) {
  const auto trace = record_signal(paper_network(), settings_at(50)).paths.front().trace;
  ASSERT_EQ(trace.input.size(), 16U);
  ASSERT_EQ(trace.output.size(), 16U);
  for (std::size_t n = 0; n < 16; ++n) {
    EXPECT_EQ(trace.input[n].level, n % 2 == 0);
    EXPECT_EQ(trace.output[n].level, n % 2 == 0);
    EXPECT_LT(trace.input[n].when, trace.output[n].when);
  }
  EXPECT_GT(trace.length, trace.output.back().when);
}

// Loses every n-th transmission that reaches the master.
class LossyReturn final : public fault::Channel {
 public:
  bool pass(const line::Waveform&, line::Waveforms&) override { return ++count_ % 50 == 0; }

 private:
  int count_ = 0;
};

TEST(SignalRunTest, ADisturbanceIsPutOnTheRingAndToldApart) {
  LossyReturn lossy;
  SignalSettings settings = settings_at(50, 4 * kSecond);
  settings.disturb = [&](network::Network& network) {
    const auto places = network.places();
    std::ranges::find(places, "master/in", &network::Place::name)->receiver->set_channel(&lossy);
  };
  // The second of two seconds is said to be the burst.
  settings.phase_during = [](kernel::Time from, kernel::Time) {
    return (from - kernel::kStart) / kSecond % 2 == 1 ? Phase::burst : Phase::quiet;
  };
  const SignalRecord record = record_signal(paper_network(), settings);
  EXPECT_GT(record.unserved_exchanges, 50U);
  EXPECT_GE(record.service_exchanges, record.unserved_exchanges);
  const measure::EdgeSkew& skew = record.paths.front().skew;
  EXPECT_GT(skew.rise_delays.in(Phase::burst).count(), 20U);
  EXPECT_GT(skew.rise_delays.in(Phase::quiet).count(), 20U);
  // A rejected cycle makes edges late, but no word wrong.
  const auto cycle = structural_cycle_time(paper_network());
  EXPECT_GT(skew.rise_delays.total().max(), kernel::Duration(5 * cycle / 2).count());
  EXPECT_EQ(skew.foreign_words, 0U);
  EXPECT_GT(record.cycles.front().times.total().max(), kernel::Duration(cycle).count());
}

TEST(SignalRunTest, TheCourseSaysWhenCyclesWereLongAndWhenItWasDisturbed) {
  LossyReturn lossy;
  SignalSettings settings = settings_at(50, 4 * kSecond);
  settings.disturb = [&](network::Network& network) {
    const auto places = network.places();
    std::ranges::find(places, "master/in", &network::Place::name)->receiver->set_channel(&lossy);
  };
  settings.phase_during = [](kernel::Time from, kernel::Time) {
    return (from - kernel::kStart) / kSecond % 2 == 1 ? Phase::burst : Phase::quiet;
  };
  settings.next_disturbance = [](kernel::Time after) -> std::optional<measure::Span> {
    const auto number = (after - kernel::kStart) / kSecond;
    const kernel::Time from = kernel::kStart + (number + (number % 2 == 1 ? 0 : 1)) * kSecond;
    return measure::Span{from, from + kSecond};
  };
  settings.most_windows = 40;
  const SignalRecord record = record_signal(paper_network(), settings);
  const measure::TimeCourse& course = record.cycles.front().course;
  const measure::Distribution all = record.cycles.front().times.total();
  EXPECT_EQ(course.length(), record.lasted);
  EXPECT_EQ(course.longest().front().value, all.max());
  std::uint64_t count = 0;
  std::int64_t max = 0;
  std::map<Phase, std::uint64_t> by_phase;
  for (const auto& point : course.points()) {
    count += point.count;
    max = std::max(max, point.max);
    by_phase[point.phase] += point.count;
  }
  EXPECT_EQ(count, all.count());
  EXPECT_EQ(max, all.max());
  EXPECT_LE(course.points().size(), 80U) << "at most 40 windows of two phases";
  for (const Phase phase : {Phase::quiet, Phase::burst})
    EXPECT_EQ(by_phase[phase], record.cycles.front().times.in(phase).count());
  ASSERT_EQ(record.bands.size(), 2U);
  EXPECT_LT(record.bands[0].from, kSecond) << "since the begin of the trains, not of the run";
  EXPECT_EQ(record.bands[1].from - record.bands[0].from, 2 * kSecond);
}

// A slave that shifts the words of its image in time: the second one is a sample after.
class TearingSlave final : public Slave {
 public:
  using Slave::Slave;

 protected:
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override {
    Slave::sample_inputs(when, octets);
    if (octets.size() < 4) return;
    std::swap(octets[2], held_[0]);
    std::swap(octets[3], held_[1]);
  }

 private:
  std::uint8_t held_[2] = {};
};

NetworkDescription two_words() {
  NetworkDescription network = paper_network();
  network.stations[0].branch[0].id_code = 0x02BE;
  network.stations[0].branch[1].id_code = 0x02BD;
  network.copy.push_back({"di16", 1, "do16", 1});
  return network;
}

TEST(SignalRunTest, WordsOfOneStationBelongTogether) {
  SignalSettings settings = settings_at(150);
  const SignalRecord whole = record_signal(two_words(), settings);
  EXPECT_EQ(whole.paths.size(), 2U);
  EXPECT_GT(whole.images, 400U);
  EXPECT_EQ(whole.torn_images, 0U);
  const SignalRecord torn =
      record_signal(two_words(), settings, {.make_slave = [](int, const SlaveConfiguration& configuration) {
                      return std::make_unique<TearingSlave>(configuration);
                    }});
  EXPECT_GT(torn.torn_images, torn.images / 3);
}

std::string refusal_of(const NetworkDescription& network, const RunningStations& stations = {}) {
  try {
    record_signal(network, settings_at(50), stations);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.exit_code(), 65);
    return error.what();
  }
  return "";
}

TEST(SignalRunTest, ANetworkWithoutCopyOrWithoutCyclesIsRefused) {
  NetworkDescription without = paper_network();
  without.copy.clear();
  EXPECT_NE(refusal_of(without).find("/copy"), std::string::npos);
  const Ring::MakeSlave other = [](int, SlaveConfiguration configuration) {
    configuration.id_code ^= 1;  // not the station that the master expects
    return std::make_unique<Slave>(configuration);
  };
  EXPECT_NE(refusal_of(paper_network(), {.make_slave = other}).find("does not come up"), std::string::npos);
}

}  // namespace
}  // namespace fieldproof::interbus
