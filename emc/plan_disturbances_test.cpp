#include "emc/plan_disturbances.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "emc/coupling.hpp"
#include "emc/effective_time.hpp"
#include "emc/profile.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kSecond;
using kernel::kStart;
using kernel::Time;

constexpr std::int64_t kBitRate = 500'000;
constexpr std::size_t kSentBits = 182;

fault::Plan plan_of(const std::string& members) {
  const auto document = config::Document::parse("{\"disturbances\": [{" + members + "}]}", "plan.json");
  return fault::read_plan(document.root(), {.disturbances = plan_disturbances()});
}

std::string refusal_of(const std::string& members) {
  try {
    plan_of(members);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    return error.what();
  }
  return "none";
}

// The two receivers "a" and "b" under a plan; transmissions of 182 idle bits go to both.
class TwoReceivers final : private trace::Recorder {
 public:
  explicit TwoReceivers(const std::string& members, std::uint64_t seed = 1)
      : places_{trace_.add_channel("a"), trace_.add_channel("b")},
        plan_(plan_of(members), trace_, kernel::Random(seed)),
        channels_{plan_.channel_for({"a", places_[0], kBitRate}),
                  plan_.channel_for({"b", places_[1], kBitRate})} {
    trace_.set_recorder(this);
  }

  // Of all transmissions of the span, end to end.
  void send(Time from, Time to) {
    line::Waveform sent;
    sent.rate = kBitRate;
    sent.levels.append_idle(kSentBits);
    for (sent.start = from; sent.start < to; sent.start = sent.end()) {
      for (fault::Channel* channel : channels_) {
        arrivals_.clear();
        if (channel != nullptr) channel->pass(sent, arrivals_);
      }
      sent_bits_ += kSentBits;
    }
  }

  const std::vector<Time>& faults(int receiver) const {
    return faults_.at(static_cast<std::size_t>(receiver));
  }
  // Of these the flipped bits.
  const std::vector<Time>& flips(int receiver) const { return flips_.at(static_cast<std::size_t>(receiver)); }
  std::uint64_t sent_bits() const { return sent_bits_; }

 private:
  void on_driven(trace::Channel, const line::Waveform&) override {}
  void on_observation(trace::Channel, Time, std::string_view, std::uint64_t) override {}
  void on_fault(trace::Channel channel, Time time, std::string_view what) override {
    const std::size_t receiver = channel == places_[0] ? 0 : 1;
    faults_.at(receiver).push_back(time);
    if (what == "flipped bit") flips_.at(receiver).push_back(time);
  }

  trace::Trace trace_;
  std::array<trace::Channel, 2> places_;
  fault::InstalledPlan plan_;
  std::array<fault::Channel*, 2> channels_;
  std::array<std::vector<Time>, 2> faults_;
  std::array<std::vector<Time>, 2> flips_;
  line::Waveforms arrivals_;
  std::uint64_t sent_bits_ = 0;
};

// ---- files ----

TEST(PlanDisturbances, AreReadAgainFromTheirText) {
  const char* const disturbances[] = {
      R"("bursts": {"level": 3})",
      R"("bursts": {"level": 3, "repetition": "5kHz", "polarity": "+", "profile": "A"})",
      R"("bursts": {"volts": 1234.5, "repetition": "2.5kHz", "polarity": "-", "first_burst": "0 s"})",
      R"("bursts": {"level": 1, "profile": {"name": "line_7", "title": "line \"7\"", "based_on": "B",
                                            "coupling": {"shield_db": 24.1, "common_mode_limit_v": null}}})",
      R"("binary_symmetric": {"flip_probability": 1e-300})",
      R"("gilbert_elliott": {"to_bad": 0.1, "to_good": 1, "good_flip": 0, "bad_flip": 0.5})",
      R"("gilbert_elliott": {"fitted_to": {"level": 2, "repetition": "100kHz"}})",
      R"("flipped_bits": [{"transmission": 7, "bits": [3, 1]}, {"transmission": 2, "bits": [100000]}])"};
  for (const char* one : disturbances) {
    const fault::Plan plan = plan_of(one);
    const std::string text = fault::canonical_text(plan);
    const auto document = config::Document::parse(text, "again.json");
    const auto again = fault::read_plan(document.root(), {.disturbances = plan_disturbances()});
    EXPECT_EQ(again, plan) << text;
    EXPECT_EQ(fault::canonical_text(again), text);
  }
  EXPECT_EQ(plan_of(disturbances[0]), plan_of(disturbances[1]))
      << "what is as it would be anyway says nothing";
}

TEST(PlanDisturbances, RefuseWhatMeansNothing) {
  const auto is_refused = [](const std::string& members, std::string_view place, std::string_view why) {
    const std::string refusal = refusal_of(members);
    const std::string begin = fmt::format("plan.json:1: /disturbances/0/{}: ", place);
    EXPECT_TRUE(refusal.starts_with(begin) && refusal.find(why) != std::string::npos) << refusal;
  };
  is_refused(R"("bursts": {})", "bursts", "write either \"level\" or \"volts\"");
  is_refused(R"("bursts": {"volts": 10001})", "bursts/volts", "10000");
  is_refused(R"("bursts": {"level": 1, "profile": "G"})", "bursts/profile", "B2");
  is_refused(R"("bursts": {"level": 1, "profile": {"name": "mine", "coupling": {"ring_q": "x"}}})",
             "bursts/profile/coupling/ring_q", "number");
  is_refused(R"("bursts": {"level": 1, "repetition": "5 MHz"})", "bursts/repetition", "5kHz");
  is_refused(R"("gilbert_elliott": {"to_bad": 0, "to_good": 0})", "gilbert_elliott", "ever left");
  is_refused(R"("gilbert_elliott": {"fitted_to": {"level": 1}, "to_bad": 1})", "gilbert_elliott/to_bad",
             "known");
  is_refused(R"("gilbert_elliott": {"fitted_to": {"level": 1, "first_burst": "0 s"}})",
             "gilbert_elliott/fitted_to", "leave out");
  is_refused(R"("flipped_bits": [])", "flipped_bits", "");
  is_refused(R"("flipped_bits": [{"transmission": 1, "bits": [2]}, {"transmission": 1, "bits": [2]}])",
             "flipped_bits", "twice");
}

// A file in which one character is another one is a plan that works, or is refused at a place.
RC_GTEST_PROP(PlanDisturbancesProperty, ATypingErrorIsReadOrRefused, ()) {
  std::string members = *rc::gen::element<std::string>(
      R"("bursts": {"volts": 1000, "repetition": "100kHz", "polarity": "-", "first_burst": "1 ms",
         "profile": {"name": "x", "coupling": {"ring_q": 4, "pulse": "double_exponential"}}})",
      R"("gilbert_elliott": {"to_bad": 0.1, "to_good": 0.2, "good_flip": 0, "bad_flip": 1})",
      R"("gilbert_elliott": {"fitted_to": {"level": 2, "repetition": "100kHz"}})",
      R"("flipped_bits": [{"transmission": 7, "bits": [3, 1]}], "receiver": "a")");
  members.at(*rc::gen::inRange<std::size_t>(0, members.size())) = *rc::gen::inRange<char>(32, 127);
  const std::string refusal = refusal_of(members);
  RC_ASSERT(refusal == "none" || refusal.starts_with("plan.json:"));
  if (refusal == "none") TwoReceivers(members).send(kStart, kStart + 2 * kMillisecond);
}

TEST(PlanDisturbances, OfAnyStrengthHaveAChannel) {
  for (const char* bursts :
       {R"({"volts": 10000, "repetition": "100kHz", "profile": {"name": "slow", "coupling":
                                 {"recovery_ns": 10000, "common_mode_limit_v": 1}}})",
        R"({"volts": 1})"}) {
    for (const char* kind : {"\"bursts\": ", "\"gilbert_elliott\": {\"fitted_to\": "}) {
      const std::string end = kind[1] == 'g' ? "}" : "";
      TwoReceivers(std::string(kind) + bursts + end).send(kStart, kStart + 400 * kMillisecond);
    }
  }
}

// ---- bursts ----

TEST(PlannedBursts, AreOneGeneratorForAllReceivers) {
  TwoReceivers line(R"("bursts": {"level": 4, "first_burst": "3 ms"})");
  line.send(kStart, kStart + 20 * kMillisecond);
  EXPECT_EQ(line.faults(0), line.faults(1));
  // 75 pulses of 200 us, each with the tolerances, of which this profile shows every one.
  EXPECT_GT(line.faults(0).size(), 40U);
  EXPECT_LT(line.faults(0).size(), 100U);
}

TEST(PlannedBursts, BeginWhereTheyAreWanted) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TwoReceivers line(R"("from": "100 ms", "bursts": {"level": 4, "first_burst": "3 ms"})", seed);
    line.send(kStart, kStart + 110 * kMillisecond);
    ASSERT_FALSE(line.faults(0).empty());
    EXPECT_NEAR(static_cast<double>((line.faults(0).front() - kStart).count()), 103e9, 0.1e9);
  }
}

// Also where another burst would have run when the generator was switched on.
TEST(PlannedBursts, DoNotComeBeforeTheFirst) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    TwoReceivers line(R"("from": "10 ms", "bursts": {"level": 4, "first_burst": "400 ms"})", seed);
    line.send(kStart, kStart + 409 * kMillisecond);
    EXPECT_TRUE(line.faults(0).empty()) << seed;
    line.send(kStart + 409 * kMillisecond, kStart + 420 * kMillisecond);
    EXPECT_FALSE(line.faults(0).empty()) << seed;
  }
}

TEST(PlannedBursts, ComeAnywhereInAPeriodWhenNothingIsSaid) {
  int early = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    TwoReceivers line(R"("bursts": {"level": 4})", seed);
    line.send(kStart, kStart + 150 * kMillisecond);
    early += line.faults(0).empty() ? 0 : 1;
  }
  EXPECT_TRUE(early > 15 && early < 50) << early;  // a half and a little more
}

TEST(PlannedBursts, OfProfileCDisturbNobody) {
  TwoReceivers line(R"("bursts": {"volts": 4500, "profile": "C", "first_burst": "0 s"})");
  line.send(kStart, kStart + 20 * kMillisecond);
  EXPECT_TRUE(line.faults(0).empty());
}

// ---- channels that flip bits ----

TEST(PlannedFlips, OfABinarySymmetricChannelAreAsManyAsItSaysAndOthersAtEachReceiver) {
  TwoReceivers line(R"("binary_symmetric": {"flip_probability": 0.001})");
  line.send(kStart, kStart + 2 * kSecond);
  const double expected = 0.001 * static_cast<double>(line.sent_bits());
  for (const int receiver : {0, 1}) {
    EXPECT_NEAR(static_cast<double>(line.faults(receiver).size()), expected, 4.5 * std::sqrt(expected));
  }
  EXPECT_NE(line.faults(0), line.faults(1));
}

TEST(PlannedFlips, OfAFittedGilbertElliottChannelAreAsManyAsThePulsesWouldFlip) {
  const WrongOutput wrong = LineResponse(Profile::named("A").coupling).wrong_output(2000, Polarity::positive);
  const double per_pulse = flips_per_pulse(wrong, {}, kBitRate);
  TwoReceivers line(R"("gilbert_elliott": {"fitted_to": {"level": 4}})");
  line.send(kStart, kStart + 600 * kSecond);
  const double pulses = 75 * 600 / 0.3;
  // The states last geometrically, which scatters more than the flips themselves.
  EXPECT_NEAR(static_cast<double>(line.faults(0).size()) / (per_pulse * pulses), 1, 0.1);
}

// Levels of what bursts have rewritten are parts of bits.
TEST(PlannedFlips, BehindBurstsAreStillBits) {
  const auto flips_beside = [](const std::string& first, const std::string& then) {
    TwoReceivers line(first + "}, {" + then);
    line.send(kStart, kStart + 20 * kMillisecond);
    return line.flips(0);
  };
  const std::string bursts = R"("bursts": {"level": 4, "first_burst": "0 s"})";
  for (const std::string flips :
       {R"("flipped_bits": [{"transmission": 1, "bits": [0, 64]}, {"transmission": 2, "bits": [17]}])",
        R"("binary_symmetric": {"flip_probability": 0.01})"}) {
    // The streams are those of the places in the plan, so an idle disturbance takes the place of the bursts.
    const std::string nothing = R"("binary_symmetric": {"flip_probability": 0})";
    EXPECT_EQ(flips_beside(bursts, flips), flips_beside(nothing, flips));
    EXPECT_FALSE(flips_beside(bursts, flips).empty());
  }
}

TEST(PlannedFlips, OfAListAreThoseOfTheListAndNoOthers) {
  TwoReceivers line(
      R"("from": "1 ms", "to": "3 ms", "flipped_bits": [{"transmission": 1, "bits": [0, 64, 181]},
                      {"transmission": 1000, "bits": [0]}])");
  line.send(kStart, kStart + 10 * kMillisecond);
  // Transmissions last 364 us; the first one within the window begins at 1092 us.
  const auto at = [](std::int64_t bit) { return kStart + 1456 * kMicrosecond + bit * 2 * kMicrosecond; };
  const std::vector<Time> expected{at(0), at(64), at(181)};
  EXPECT_EQ(line.faults(0), expected);
  EXPECT_EQ(line.faults(1), expected);
}

}  // namespace
}  // namespace fieldproof::emc
