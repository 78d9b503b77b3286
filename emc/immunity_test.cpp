#include "emc/immunity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ranges>
#include <utility>

#include "emc/frame_residual.hpp"
#include "emc/interbus/undetected_cycle.hpp"
#include "emc/profile.hpp"
#include "emc/random_flips.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"
#include "protocols/interbus/slave.hpp"

namespace fieldproof::emc {
namespace {

using interbus::Master;
using interbus::RunningStations;
using interbus::Slave;

ImmunitySettings settings_of(const Level& level, Repetition repetition = Repetition::khz_5,
                             Polarity polarity = Polarity::positive) {
  ImmunitySettings settings;
  settings.bursts.level = level;
  settings.bursts.repetition = repetition;
  settings.bursts.polarity = polarity;
  settings.duration = 3 * kernel::kSecond;
  return settings;
}

ImmunityResult under(const std::string& profile, const ImmunitySettings& settings,
                     const RunningStations& stations = {}) {
  const LineResponse response(Profile::named(profile).coupling);
  interbus::RunningNetwork network(interbus::paper_network(), stations);
  return run_immunity(network, response, settings);
}

// What the paper saw on a remote bus with a proper shield.
TEST(Immunity, AShieldBondedAllAroundLetsNothingThroughFrom1000To4500V) {
  for (int volts = 1000; volts <= 4500; volts += 500) {
    for (const Polarity polarity : {Polarity::positive, Polarity::negative}) {
      const ImmunityResult result = under("C", settings_of(Level::free(volts), Repetition::khz_5, polarity));
      ASSERT_TRUE(result.came_up);
      EXPECT_EQ(result.criterion, Criterion::a) << volts;
      EXPECT_EQ(result.counts.corrupted, 0U) << volts;
      EXPECT_GT(result.counts.sent, 3000U);
      // On a line without an error the recovery is as many cycles as it says, the first of them begun before.
      const auto cycle = static_cast<double>(result.cycles.front().kind.theory.count());
      const double recovery = static_cast<double>(result.recovery_time.count()) / cycle;
      EXPECT_GT(recovery, static_cast<double>(result.recovery_exchanges) - 1.01);
      EXPECT_LT(recovery, static_cast<double>(result.recovery_exchanges) + 0.01);
    }
  }
}

// Windows add up to the statistics, and a window with an error has bursts in it or follows one.
TEST(Immunity, ErrorsOverTimeAddUpAndComeWithBursts) {
  for (const int volts : {60, 250, 2000}) {
    const ImmunityResult result = under("A", settings_of(Level::free(volts)));
    ImmunityCourse::Window sum;
    for (const ImmunityCourse::Window& one : result.course.windows()) {
      sum.exchanges += one.exchanges;
      sum.rejected += one.rejected;
      sum.accepted_wrong += one.accepted_wrong;
      sum.stops += one.stops;
    }
    EXPECT_EQ(sum.exchanges, result.counts.sent) << volts;
    EXPECT_EQ(sum.rejected, result.counts.refused) << volts;
    EXPECT_EQ(sum.accepted_wrong, result.counts.wrong_exchanges) << volts;
    EXPECT_EQ(sum.stops, result.stops) << volts;
    std::uint64_t bursts = 0;
    for (const measure::Band& band : result.course.bursts()) {
      EXPECT_LT(band.from, band.to);
      EXPECT_LE(band.to, result.course.length());
      bursts += band.disturbances;
    }
    EXPECT_EQ(bursts, result.bursts) << volts;
    const auto width = result.course.length() / ImmunityCourse::kWindows;
    const auto first = std::ranges::find_if(
        result.course.windows(), [](const auto& one) { return one.rejected + one.accepted_wrong > 0; });
    ASSERT_NE(first, result.course.windows().end()) << volts;
    EXPECT_GE((first - result.course.windows().begin() + 1) * width, result.course.bursts().front().from);
  }
}

TEST(Immunity, AnUnshieldedLineFailsAtLevelOneAndRecovers) {
  for (const Repetition repetition : {Repetition::khz_5, Repetition::khz_100}) {
    const ImmunityResult result = under("A", settings_of(Level::standard(PortKind::signal, 1), repetition));
    EXPECT_NE(result.criterion, Criterion::a);
    EXPECT_NE(result.criterion, Criterion::d);
    EXPECT_GT(result.counts.detected, 0U);
    EXPECT_GE(result.counts.corrupted, result.counts.detected);
    EXPECT_EQ(result.counts.accepted_wrong(), 0U);
    EXPECT_TRUE(result.recovered_by_itself);
    EXPECT_LE(result.recovery_exchanges, interbus::Rules{}.published_recovery_cycles);
  }
}

TEST(Immunity, BelowTheThresholdNothingIsCorrupted) {
  const LineResponse response(Profile::named("A").coupling);
  const ImmunityResult result = under("A", settings_of(Level::free(response.threshold_volts() * 0.9)));
  EXPECT_EQ(result.criterion, Criterion::a);
  EXPECT_EQ(result.counts.corrupted, 0U);
  EXPECT_EQ(result.line.hit_transmissions, 0U);
}

TEST(Immunity, OneSeedGivesOneLedger) {
  const ImmunitySettings settings = settings_of(Level::standard(PortKind::signal, 3));
  const ImmunityResult once = under("A", settings);
  const ImmunityResult again = under("A", settings);
  EXPECT_EQ(once.counts.corrupted, again.counts.corrupted);
  EXPECT_EQ(once.counts.detected, again.counts.detected);
  EXPECT_EQ(once.line.pulses, again.line.pulses);
  ImmunitySettings other = settings;
  other.seed = 2;
  EXPECT_NE(under("A", other).line.pulses, once.line.pulses);
}

// Where every third cycle is corrupted hardly one passes, and not more than may; as printed, with end
// telegrams, many do.
TEST(Immunity, NoMoreWrongCyclesPassThanTheTheoryAllows) {
  static constexpr double kFlips = 0.0005;
  ImmunitySettings settings;
  settings.duration = 60 * kernel::kSecond;
  settings.make_channel = [](kernel::Random random) {
    return std::make_unique<BernoulliChannel>(kFlips, random);
  };
  const LineResponse response(Profile::named("A").coupling);
  for (const auto& network : {interbus::paper_network(), interbus::paper_network_as_printed()}) {
    interbus::RunningNetwork running(network);
    const ImmunityResult result = run_immunity(running, response, settings);
    ASSERT_TRUE(result.came_up);
    EXPECT_TRUE(result.recovered_by_itself || result.recovered_after_start);
    EXPECT_EQ(result.receivers, 2U) << "one cable, two directions; local buses lie in no clamp";
    EXPECT_GT(result.counts.corrupted, 10'000U);
    EXPECT_GT(result.line.changed_transmissions, result.counts.corrupted);
    const double allowed =
        static_cast<double>(result.counts.sent * result.receivers) * undetected_cycle(network, kFlips).any();
    EXPECT_GT(chance_of_at_least(result.counts.wrong_exchanges, allowed), 1e-3)
        << network.name << ": " << result.counts.wrong_exchanges << " where " << allowed << " may come";
    if (network.rules.end_telegrams > 0) {
      // On the way to the station, not on the way back: 12 to 30 of some 50, by seed.
      EXPECT_GT(static_cast<double>(result.counts.wrong_exchanges), allowed / 8);
    }
  }
}

// Flips the control level of the last data telegram of every fourth data cycle, or nothing.
class FlipsControlOfLastOctet final : public fault::Channel {
 public:
  explicit FlipsControlOfLastOctet(bool is_on) : is_on_(is_on) {}

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    const auto last = last_of_data(sent);
    if (!is_on_ || !last || ++cycles_ % 4 != 0) return false;
    line::Waveform& arrival = arrivals.add(sent);
    arrival.levels.flip(*last + control_);
    return true;
  }

 private:
  std::optional<std::size_t> last_of_data(const line::Waveform& wave) const {
    std::optional<std::size_t> last;
    bool has_check = false;
    code_.decode(wave.levels, 0, [&](const line::Telegram& telegram) {
      if (!telegram.is_data() || (telegram.header & line::kSelect) != 0) return;
      if ((telegram.header & line::kControl) != 0) {
        has_check = true;
      } else {
        last = telegram.level;
      }
    });
    return has_check ? last : std::nullopt;
  }

  static constexpr line::TelegramLayout kLayout{};

  const line::TelegramCode& code_ = line::shared_telegram_code(kLayout);
  const std::size_t control_ =
      1 + static_cast<std::size_t>(std::ranges::distance(
              kLayout.header.begin(), std::ranges::find(kLayout.header, line::HeaderLevel::control)));
  bool is_on_;
  unsigned cycles_ = 0;
};

// One flipped level in every fourth cycle, the control level of the last data telegram at the first slave.
TEST(Immunity, AFlippedControlLevelPassesASlaveOneTimeIn256) {
  ImmunitySettings settings;
  settings.duration = 300 * kernel::kSecond;
  std::size_t receiver = 0;
  settings.make_channel = [&receiver](kernel::Random) {
    return std::make_unique<FlipsControlOfLastOctet>(receiver++ == 0);
  };
  const ImmunityResult result = under("A", settings);
  ASSERT_TRUE(result.came_up);
  const double expected =
      static_cast<double>(result.counts.corrupted) * passing_shifts(interbus::paper_network()).early_check;
  ASSERT_GT(expected, 100);
  EXPECT_NEAR(static_cast<double>(result.counts.wrong_exchanges), expected, 4 * std::sqrt(expected));
  EXPECT_EQ(result.counts.accepted_wrong_inputs, 0U) << "a master counts telegrams";
}

struct IgnoresItsCheck final : Master {
  using Master::Master;
  bool accepts_check(const interbus::ReturnedCycle&) const override { return true; }
};
struct ZeroesInputsOnError final : Master {
  using Master::Master;
  void on_rejected_inputs(std::span<const std::uint16_t>) override {
    std::ranges::fill(inputs(), std::uint16_t{0});
  }
};

TEST(Immunity, AMasterThatGivesOnWhatItShouldRejectIsD) {
  ImmunitySettings settings = settings_of(Level::standard(PortKind::signal, 3));
  settings.duration = 20 * kernel::kSecond;
  const auto criterion_of = [&](auto make) { return under("A", settings, {.make_master = make}); };
  const ImmunityResult ignores = criterion_of([](const interbus::MasterConfiguration& configuration) {
    return std::make_unique<IgnoresItsCheck>(configuration);
  });
  EXPECT_EQ(ignores.criterion, Criterion::d);
  EXPECT_GT(ignores.counts.wrong_exchanges, 0U);
  EXPECT_LE(ignores.counts.wrong_exchanges, ignores.counts.accepted_wrong());
  EXPECT_GT(ignores.counts.accepted_wrong_inputs, 0U);
  const ImmunityResult zeroes = criterion_of([](const interbus::MasterConfiguration& configuration) {
    return std::make_unique<ZeroesInputsOnError>(configuration);
  });
  EXPECT_EQ(zeroes.criterion, Criterion::d);
}

// Says that it runs and that every cycle was good, and drives nothing.
class Pretends final : public interbus::MasterDevice {
 public:
  void wire(segment::Port&) override {}
  void start(kernel::Time now) override { at_ = now; }
  void stop(kernel::Time) override { at_ = kernel::kNever; }
  void request_id_cycle(kernel::Time) override {}
  void write_output(unsigned, std::uint16_t, kernel::Time) override {}
  std::uint16_t output(unsigned) const override { return 0; }
  std::uint16_t input(unsigned) const override { return 0; }
  interbus::MasterStatus status() const override {
    interbus::MasterStatus status;
    status.state = interbus::MasterState::run;
    return status;
  }
  void on_cycle_end(CycleHook hook) override { hook_ = std::move(hook); }
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time now) override {
    at_ = now + kernel::kMillisecond;
    hook_(now, true, true);
  }
  kernel::Time next_time() const override { return at_; }

 private:
  CycleHook hook_;
  kernel::Time at_ = kernel::kNever;
};

TEST(Immunity, AMasterThatOnlyReportsCyclesDoesNotComeUp) {
  const ImmunityResult result = under(
      "A", settings_of(Level::standard(PortKind::signal, 3)),
      {.make_master = [](const interbus::MasterConfiguration&) { return std::make_unique<Pretends>(); }});
  EXPECT_FALSE(result.came_up);
}

struct DoesNotMark final : Slave {
  using Slave::Slave;
  std::uint8_t status_octet_to_send(std::uint8_t received, std::uint8_t, bool) const override {
    return received;
  }
};
struct ClearsOnRejected final : Slave {
  using Slave::Slave;
  void on_cycle_rejected(kernel::Time when, bool own_error) override {
    Slave::on_cycle_rejected(when, own_error);
    clear_outputs(when);
  }
};

template <typename Mutant>
interbus::Ring::MakeSlave at_position(int wanted) {
  return [wanted](int position, const interbus::SlaveConfiguration& configuration) -> std::unique_ptr<Slave> {
    if (position != wanted) return nullptr;
    return std::make_unique<Mutant>(configuration);
  };
}

TEST(Immunity, ASlaveThatHidesAnErrorIsDAndOneThatDropsItsOutputsIsSeen) {
  const ImmunitySettings settings = settings_of(Level::standard(PortKind::signal, 3));
  const ImmunityResult hides = under("A", settings, {.make_slave = at_position<DoesNotMark>(1)});
  EXPECT_EQ(hides.criterion, Criterion::d);
  EXPECT_GT(hides.counts.accepted_wrong_outputs, 0U);
  const ImmunityResult clears = under("A", settings, {.make_slave = at_position<ClearsOnRejected>(3)});
  EXPECT_EQ(under("A", settings).counts.cleared_outputs, 0U);
  EXPECT_GT(clears.counts.cleared_outputs, 0U);
}

}  // namespace
}  // namespace fieldproof::emc
