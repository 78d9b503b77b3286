// Subject: a master that says its telegrams ahead of their time. What it announces is no accusation.
// A right master may say ahead what is certain to come.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "conformance/interbus/whole_cases.hpp"
#include "protocols/interbus/master.hpp"

namespace fieldproof::conformance {
namespace {

// Drives 40 ms of status telegrams within the order to start, longer than any silence may be.
struct SaysAhead final : interbus::Master {
  using Master::Master;
  void wire(segment::Port& out) override {
    out_ = &out;
    Master::wire(out);
  }
  void start(kernel::Time now) override {
    if (std::exchange(has_started_, true)) return Master::start(now);
    line::Waveform wave;
    wave.start = now;
    wave.rate = rules().bit_rate;
    const line::TelegramCode& code = line::shared_telegram_code(rules().telegram);
    const auto levels = static_cast<std::size_t>(40 * wave.rate / 1'000);
    while (wave.levels.size() < levels) {
      code.append(wave.levels, 0, 0);
      wave.levels.append_idle(rules().status_pitch_bits - line::kStatusTelegramLevels);
    }
    const kernel::Time end = wave.end();
    out_->drive(wave);
    Master::start(end);
  }
  segment::Port* out_ = nullptr;
  bool has_started_ = false;
};

TEST(MasterAhead, WhatIsDrivenWithinTheOrderToStartIsNoSilence) {
  const auto found = std::ranges::find(master_cases(), "interbus/master/compared/id_cycles_asked_for_twice",
                                       [](const MasterCase& one) { return one.test_case.id; });
  ASSERT_NE(found, master_cases().end());
  MasterSetting setting{.make_device =
                            [](const interbus::MasterConfiguration& configuration) {
                              return std::make_unique<SaysAhead>(configuration);
                            },
                        .volume = Volume::quick};
  const judge::CaseResult result = run_whole(*found, setting);
  EXPECT_EQ(result.verdict, judge::Verdict::pass) << result.reason;
}

}  // namespace
}  // namespace fieldproof::conformance
