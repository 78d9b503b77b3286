// Subject: a link of Foundation Fieldbus under bursts. Schedulers that die at random instants, and a control
// loop.
#include "papers/link_bursts.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "harness/kernel/campaign.hpp"
#include "protocols/fieldbus_dll/control_loop.hpp"
#include "protocols/fieldbus_dll/take_over_run.hpp"

namespace fieldproof::papers {
namespace {

using fieldbus_dll::ControlLoop;
using fieldbus_dll::ControlLoopSetting;
using fieldbus_dll::TakeOver;

emc::BurstSettings strongest(emc::Repetition repetition) {
  emc::BurstSettings settings;
  settings.level = emc::Level::standard(emc::PortKind::signal, 4);
  settings.repetition = repetition;
  return settings;
}

// Counts what it changes.
class CountingChannel final : public fault::Channel {
 public:
  CountingChannel(std::unique_ptr<fault::Channel> channel, std::uint64_t& changed)
      : channel_(std::move(channel)), changed_(changed) {}
  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    const bool is_changed = channel_->pass(sent, arrivals);
    if (is_changed) ++changed_;
    return is_changed;
  }

 private:
  std::unique_ptr<fault::Channel> channel_;
  std::uint64_t& changed_;
};

fieldbus_dll::FfDisturb counting(const fieldbus_dll::FfDisturb& disturb, std::uint64_t& changed) {
  return [disturb, &changed](segment::Segment& segment, const segment::MediumPort& place) {
    return std::make_unique<CountingChannel>(disturb(segment, place), changed);
  };
}

struct Line {
  const char* profile;
  std::int64_t bit_rate;
  emc::Repetition repetition;
};

class TakeOverUnderBursts : public testing::TestWithParam<Line> {};

TEST_P(TakeOverUnderBursts, IsByTheLowestLinkMasterInTimeAndAlone) {
  const auto& [profile, bit_rate, repetition] = GetParam();
  const kernel::Duration silence = fieldbus_dll::take_over_silence(bit_rate);
  std::uint64_t changed = 0;
  for (std::uint64_t seed = 1; seed <= kernel::campaign_count("FIELDPROOF_INSTANTS", 10); ++seed) {
    const TakeOver found = fieldbus_dll::run_take_over(
        {.seed = seed,
         .bit_rate = bit_rate,
         .disturb = counting(bursts_on_link(emc::Profile::named(profile), strongest(repetition), bit_rate,
                                            kernel::kStart, seed),
                             changed)});
    ASSERT_EQ(found.claimer, 0x11) << seed;
    ASSERT_EQ(found.claims, 1U) << seed;
    ASSERT_GE(found.silence, silence) << seed;
    ASSERT_LE(found.silence, silence + kernel::levels_duration(8, bit_rate)) << seed;
    ASSERT_EQ(found.foreign_frames, 0U) << seed;
    ASSERT_LE(found.not_compelled, found.due_meanwhile) << seed;
  }
  EXPECT_GT(changed, 0U);
  RecordProperty("changed_transmissions", std::to_string(changed));
}

INSTANTIATE_TEST_SUITE_P(Lines, TakeOverUnderBursts,
                         testing::Values(Line{"E2", 31'250, emc::Repetition::khz_5},
                                         Line{"E2", 31'250, emc::Repetition::khz_100},
                                         Line{"F", 1'000'000, emc::Repetition::khz_5},
                                         Line{"F", 1'000'000, emc::Repetition::khz_100}));

TEST(ControlLoopUnderBursts, MissesSamplesWhereTheLineIsHit) {
  ControlLoopSetting setting;
  setting.disturb = bursts_on_link(emc::Profile::named("E2"), strongest(emc::Repetition::khz_100), 31'250,
                                   kernel::kStart + fieldbus_dll::loop_begin(31'250), 1);
  const ControlLoop loop = run_control_loop(setting);
  EXPECT_GT(loop.to_controller.missing + loop.to_valve.missing, 0U);
  EXPECT_EQ(loop.to_controller.lost + loop.to_valve.lost, 0U);
}

}  // namespace
}  // namespace fieldproof::papers
