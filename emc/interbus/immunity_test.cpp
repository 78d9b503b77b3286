#include "emc/interbus/immunity.hpp"

#include <gtest/gtest.h>

#include <ranges>

#include "emc/profile.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/slave.hpp"

namespace fieldproof::emc {
namespace {

using interbus::Master;
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
                     const InterbusStations& stations = {}) {
  const LineResponse response(Profile::named(profile).coupling);
  return run_immunity(interbus::paper_network(), stations, response, settings);
}

// What the paper saw on a remote bus with a proper shield.
TEST(Immunity, AShieldBondedAllAroundLetsNothingThroughFrom1000To4500V) {
  for (int volts = 1000; volts <= 4500; volts += 500) {
    for (const Polarity polarity : {Polarity::positive, Polarity::negative}) {
      const ImmunityResult result = under("C", settings_of(Level::free(volts), Repetition::khz_5, polarity));
      ASSERT_TRUE(result.came_up);
      EXPECT_EQ(result.criterion, Criterion::a) << volts;
      EXPECT_EQ(result.ledger.corrupted, 0U) << volts;
      EXPECT_GT(result.ledger.sent, 3000U);
    }
  }
}

TEST(Immunity, AnUnshieldedLineFailsAtLevelOneAndRecovers) {
  for (const Repetition repetition : {Repetition::khz_5, Repetition::khz_100}) {
    const ImmunityResult result = under("A", settings_of(Level::standard(PortKind::signal, 1), repetition));
    EXPECT_NE(result.criterion, Criterion::a);
    EXPECT_NE(result.criterion, Criterion::d);
    EXPECT_GT(result.ledger.detected, 0U);
    EXPECT_GE(result.ledger.corrupted, result.ledger.detected);
    EXPECT_EQ(result.ledger.accepted_wrong(), 0U);
    EXPECT_TRUE(result.recovered_by_itself);
    EXPECT_LE(result.recovery_cycles, interbus::Rules{}.published_recovery_cycles);
  }
}

TEST(Immunity, BelowTheThresholdNothingIsCorrupted) {
  const LineResponse response(Profile::named("A").coupling);
  const ImmunityResult result = under("A", settings_of(Level::free(response.threshold_volts() * 0.9)));
  EXPECT_EQ(result.criterion, Criterion::a);
  EXPECT_EQ(result.ledger.corrupted, 0U);
  EXPECT_EQ(result.line.hit_transmissions, 0U);
}

TEST(Immunity, OneSeedGivesOneLedger) {
  const ImmunitySettings settings = settings_of(Level::standard(PortKind::signal, 3));
  const ImmunityResult once = under("A", settings);
  const ImmunityResult again = under("A", settings);
  EXPECT_EQ(once.ledger.corrupted, again.ledger.corrupted);
  EXPECT_EQ(once.ledger.detected, again.ledger.detected);
  EXPECT_EQ(once.line.pulses, again.line.pulses);
  ImmunitySettings other = settings;
  other.seed = 2;
  EXPECT_NE(under("A", other).line.pulses, once.line.pulses);
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
  const auto criterion_of = [&](auto make) { return under("A", settings, {make, nullptr}); };
  const ImmunityResult ignores = criterion_of([](const interbus::MasterConfiguration& configuration) {
    return std::make_unique<IgnoresItsCheck>(configuration);
  });
  EXPECT_EQ(ignores.criterion, Criterion::d);
  EXPECT_GT(ignores.ledger.accepted_wrong_inputs, 0U);
  const ImmunityResult zeroes = criterion_of([](const interbus::MasterConfiguration& configuration) {
    return std::make_unique<ZeroesInputsOnError>(configuration);
  });
  EXPECT_EQ(zeroes.criterion, Criterion::d);
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

template <typename Deviant>
interbus::Ring::MakeSlave at_position(int wanted) {
  return [wanted](int position, const interbus::SlaveConfiguration& configuration) -> std::unique_ptr<Slave> {
    if (position != wanted) return nullptr;
    return std::make_unique<Deviant>(configuration);
  };
}

TEST(Immunity, ASlaveThatHidesAnErrorIsDAndOneThatDropsItsOutputsIsSeen) {
  const ImmunitySettings settings = settings_of(Level::standard(PortKind::signal, 3));
  const ImmunityResult hides = under("A", settings, {nullptr, at_position<DoesNotMark>(1)});
  EXPECT_EQ(hides.criterion, Criterion::d);
  EXPECT_GT(hides.ledger.accepted_wrong_outputs, 0U);
  const ImmunityResult clears = under("A", settings, {nullptr, at_position<ClearsOnRejected>(3)});
  EXPECT_EQ(under("A", settings).ledger.cleared_outputs, 0U);
  EXPECT_GT(clears.ledger.cleared_outputs, 0U);
}

}  // namespace
}  // namespace fieldproof::emc
