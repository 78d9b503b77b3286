#include "harness/fault/plan.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "harness/fault/telegram_fields.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/written_wave.hpp"

namespace fieldproof::fault {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kPicosecond;
using kernel::kStart;
using line::wave_of;
using line::Waveform;
using line::Waveforms;

constexpr std::int64_t kRate = 1'000'000;  // one microsecond per level

// "@3 0101 @9 11": start in microseconds and levels of each arrival.
std::string text(const Waveforms& arrivals) {
  std::string result;
  for (const Waveform& arrival : arrivals) {
    const Duration start = arrival.start - kStart;
    if (!result.empty()) result += " ";
    result += "@" + std::to_string(start / kMicrosecond);
    if (start % kMicrosecond != Duration{}) result += "." + std::to_string((start % kMicrosecond).count());
    result += " " + arrival.levels.text();
  }
  return result;
}

class KeptFaults final : public trace::Recorder {
 public:
  void on_driven(trace::Channel, const Waveform&) override {}
  void on_fault(trace::Channel, kernel::Time, std::string_view what) override { texts.emplace_back(what); }
  void on_observation(trace::Channel, kernel::Time, std::string_view, std::uint64_t) override {}
  std::vector<std::string> texts;
};

// One receiver "rx" after a plan.
class Bench {
 public:
  explicit Bench(Plan plan, std::uint64_t seed = 1, std::uint64_t most_work = PlanWork::kMostSteps)
      : place(trace.add_channel("rx")), installed(std::move(plan), trace, kernel::Random(seed), most_work) {
    trace.set_recorder(&faults);
    channel = installed.channel_for({"rx", place});
  }
  std::string pass(const Waveform& sent) {
    Waveforms arrivals;
    if (channel == nullptr || !channel->pass(sent, arrivals)) return "as sent";
    return text(arrivals);
  }
  std::string pass(const std::string& levels, Duration start = {}) { return pass(wave_of(levels, start)); }

  trace::Trace trace;
  trace::Channel place;
  KeptFaults faults;
  InstalledPlan installed;
  Channel* channel;
};

Rule rule_of(Effect effect, Numbers bit = {}) {
  Rule rule;
  rule.effect = std::move(effect);
  rule.when.bit = bit;
  return rule;
}

line::Levels levels_of(const std::string& levels) {
  return wave_of(levels).levels;
}

TEST(Plan, GivesNoChannelToAReceiverThatNoRuleMeans) {
  trace::Trace trace;
  const trace::Channel place = trace.add_channel("a");
  Plan plan;
  plan.add(flip_level("slave *", "data", 0));
  Rule nested = rule_of(Drop{});
  nested.when.any_of.push_back({.receiver = "master"});
  plan.add(nested);
  InstalledPlan installed(plan, trace, kernel::Random(1));
  EXPECT_EQ(installed.channel_for({"coupler", place}), nullptr);
  EXPECT_NE(installed.channel_for({"slave 1", place}), nullptr);
  EXPECT_NE(installed.channel_for({"master", place}), nullptr);
}

TEST(Plan, EachEffectDoesWhatItSays) {
  const Numbers middle{2, 3, 1};
  const auto arrives = [&](Effect effect) {
    Plan plan;
    plan.add(rule_of(std::move(effect), middle));
    return Bench(plan).pass("001011");
  };
  EXPECT_EQ(arrives(Flip{}), "@0 000111");
  EXPECT_EQ(arrives(Flip{{1, 3}}), "@0 001110");
  EXPECT_EQ(arrives(Flip{{4}}), "@0 001011") << "after the transmission there is nothing to flip";
  EXPECT_EQ(arrives(Force{false}), "@0 000011");
  EXPECT_EQ(arrives(Force{true, 1}), "@0 001011");
  EXPECT_EQ(arrives(Force{false, 4}), "@0 000000");
  EXPECT_EQ(arrives(Force{false, 0, 3 * kMicrosecond}), "@0 000001");
  EXPECT_EQ(arrives(Force{false, 0, 3 * kMicrosecond - kPicosecond}), "@0 000001");
  EXPECT_EQ(arrives(Force{false, 0, 2 * kMicrosecond}), "@0 000011");
  EXPECT_EQ(arrives(Drop{}), "@0 00 @4 11");
  EXPECT_EQ(arrives(Repeat{2}), "@0 0010101011");
  EXPECT_EQ(arrives(Repeat{1, 1 * kMicrosecond}), "@0 0010 @5 1011");
  EXPECT_EQ(arrives(Insert{levels_of("111"), false}), "@0 001111011");
  EXPECT_EQ(arrives(Insert{levels_of("000"), true}), "@0 001000011");
  EXPECT_EQ(arrives(Mute{3 * kMicrosecond}), "@0 00 @5 1");
  EXPECT_EQ(arrives(Mute{Duration{}}), "as sent");
}

TEST(Plan, ADelayedPartYieldsToWhatStartsLaterAndCutsWhatStartedBefore) {
  const auto arrives = [](Duration late) {
    Plan plan;
    plan.add(rule_of(Delay{late}, {2, 3, 1}));
    return Bench(plan).pass("110001");
  };
  EXPECT_EQ(arrives(Duration{}), "@0 110001");
  EXPECT_EQ(arrives(1 * kMicrosecond), "@0 11 @3 0 @4 01") << "one level of the part is left";
  EXPECT_EQ(arrives(1 * kMicrosecond + kPicosecond), "@0 11 @4 01") << "no whole level is left";
  EXPECT_EQ(arrives(3 * kMicrosecond), "@0 11 @4 0 @5 00") << "the rest is lost from there on";
  EXPECT_EQ(arrives(9 * kMicrosecond), "@0 11 @4 01 @11 00");
}

TEST(Plan, ADelayedTransmissionKeepsTheLineToItself) {
  Plan plan;
  Rule rule = rule_of(Delay{10 * kMicrosecond});
  rule.times = 1;
  plan.add(rule);
  Bench bench(plan);
  EXPECT_EQ(bench.pass("0101"), "@10 0101");
  EXPECT_EQ(bench.pass("00000000", 5 * kMicrosecond), "@5 00000") << "cut where the delayed one begins";
  EXPECT_EQ(bench.pass("0001", 13 * kMicrosecond), "@14 001") << "what has begun is not taken back";
  EXPECT_EQ(bench.pass("0101", 20 * kMicrosecond), "as sent");
}

TEST(Plan, FlipsAndForcesAccumulateInOrderOfInstallation) {
  Plan flip_then_force;
  flip_then_force.add(rule_of(Flip{})).add(rule_of(Force{true}, {1, 2, 1}));
  EXPECT_EQ(Bench(flip_then_force).pass("0101"), "@0 1110");
  Plan force_then_flip;
  force_then_flip.add(rule_of(Force{true}, {1, 2, 1})).add(rule_of(Flip{}));
  EXPECT_EQ(Bench(force_then_flip).pass("0101"), "@0 1000");
}

TEST(Plan, TheFirstRuleThatClaimsALevelWins) {
  Plan plan;
  plan.add(rule_of(Drop{}, {2, 3, 1}));
  plan.add(rule_of(Repeat{}, {3, 4, 1}));  // touches
  plan.add(rule_of(Repeat{}, {4, 4, 1}));  // does not
  plan.add(rule_of(Flip{{0}}));
  Bench bench(plan);
  EXPECT_EQ(bench.pass("001010"), "@0 10 @4 110");
  EXPECT_EQ(bench.installed.hits(0), 1U);
  EXPECT_EQ(bench.installed.hits(1), 0U);
  EXPECT_EQ(bench.installed.hits(2), 1U);
  EXPECT_EQ(bench.installed.hits(3), 1U);
}

TEST(Plan, ARuleIsSpentAfterItsHits) {
  Plan plan;
  Rule rule = rule_of(Drop{});
  rule.times = 2;
  plan.add(rule);
  Bench bench(plan);
  EXPECT_EQ(bench.pass("01"), "");
  EXPECT_EQ(bench.pass("01"), "");
  EXPECT_EQ(bench.pass("01"), "as sent");
  EXPECT_EQ(bench.installed.hits(0), 2U);
}

TEST(Plan, NamesItsPartsAndCutsALongNameBetweenCharacters) {
  Plan plan;
  Rule rule;
  rule.name = "short";
  plan.add(rule);
  rule.name = std::string(99, 'a') + "\xC3\xA4" + "b";  // the second octet of a letter would be the last one
  plan.add(rule);
  const std::vector<PlanPart> parts = plan.parts();
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].place, "/rules/0");
  EXPECT_EQ(parts[0].name, "short");
  EXPECT_EQ(parts[1].place, "/rules/1");
  EXPECT_EQ(parts[1].name, std::string(99, 'a') + "...");
}

TEST(Plan, TheLimitOfHitsHoldsOverAllReceivers) {
  trace::Trace trace;
  const trace::Channel place = trace.add_channel("a");
  Plan plan;
  Rule rule = rule_of(Drop{});
  rule.times = 1;
  plan.add(rule);
  InstalledPlan installed(plan, trace, kernel::Random(1));
  Channel* a = installed.channel_for({"a", place});
  Channel* b = installed.channel_for({"b", place});
  Waveforms arrivals;
  EXPECT_TRUE(b->pass(wave_of("0"), arrivals));
  EXPECT_FALSE(a->pass(wave_of("0"), arrivals));
}

TEST(Plan, CountsTransmissionsAsFramesWhereNoProtocolDoes) {
  Plan plan;
  Rule rule = rule_of(Drop{});
  rule.when.frame_kind = "transmission";
  rule.when.frame = {2, 6, 2};
  plan.add(rule);
  Bench bench(plan);
  std::string lost;
  for (int n = 1; n <= 8; ++n) {
    if (bench.pass("0", n * 10 * kMicrosecond).empty()) lost += std::to_string(n);
  }
  EXPECT_EQ(lost, "246");
}

TEST(Plan, AWindowHoldsItsFirstInstantAndNotItsLast) {
  const auto arrives = [](Effect effect, Duration from, Duration to) {
    Plan plan;
    Rule rule = rule_of(std::move(effect));
    rule.when.from = kStart + from;
    rule.when.to = kStart + to;
    plan.add(rule);
    return Bench(plan).pass("0000", 10 * kMicrosecond);
  };
  EXPECT_EQ(arrives(Drop{}, 10 * kMicrosecond, 11 * kMicrosecond), "");
  EXPECT_EQ(arrives(Drop{}, 10 * kMicrosecond + kPicosecond, 30 * kMicrosecond), "as sent");
  EXPECT_EQ(arrives(Drop{}, Duration{}, 10 * kMicrosecond), "as sent");
  EXPECT_EQ(arrives(Drop{}, Duration{}, 10 * kMicrosecond + kPicosecond), "");
  // Levels are narrowed to those that begin inside.
  EXPECT_EQ(arrives(Flip{}, 11 * kMicrosecond, 13 * kMicrosecond), "@10 0110");
  EXPECT_EQ(arrives(Flip{}, 11 * kMicrosecond + kPicosecond, 13 * kMicrosecond + kPicosecond), "@10 0011");
  EXPECT_EQ(arrives(Flip{}, 14 * kMicrosecond, 20 * kMicrosecond), "as sent");
}

TEST(Plan, FramesAreCountedAlsoWhileNoWindowIsOpen) {
  Plan plan;
  Rule rule = rule_of(Drop{});
  rule.when.frame = Numbers::only(3);
  rule.when.from = kStart + 25 * kMicrosecond;
  plan.add(rule);
  Bench bench(plan);
  EXPECT_EQ(bench.pass("0", 0 * kMicrosecond), "as sent");
  EXPECT_EQ(bench.pass("0", 10 * kMicrosecond), "as sent");
  EXPECT_EQ(bench.pass("0", 30 * kMicrosecond), "");
  EXPECT_EQ(bench.pass("0", 40 * kMicrosecond), "as sent");
}

TEST(Plan, WaitsForTheNthObservation) {
  Plan plan;
  Rule rule = rule_of(Drop{});
  rule.when.after = After{"bus *", "master", 2, 10 * kMicrosecond};
  plan.add(rule);
  Bench bench(plan);
  const trace::Channel master = bench.trace.add_channel("master");
  bench.trace.observe(master, kStart, "bus started");
  bench.trace.observe(bench.place, kStart, "bus stopped");
  EXPECT_EQ(bench.pass("0", 1 * kMicrosecond), "as sent");
  bench.trace.observe(master, kStart + 5 * kMicrosecond, "bus stopped");
  EXPECT_EQ(bench.pass("0", 5 * kMicrosecond), "");
  EXPECT_EQ(bench.pass("0", 15 * kMicrosecond - kPicosecond), "");
  EXPECT_EQ(bench.pass("0", 15 * kMicrosecond), "as sent");
}

TEST(Plan, CombinesConditions) {
  Plan plan;
  Rule rule = rule_of(Drop{});
  rule.when.any_of = {{.frame = Numbers::only(2)}, {.frame = {4, 6, 1}}};
  rule.when.none_of = {{.frame = Numbers::only(5)}};
  rule.when.all_of = {{.receiver = "r*"}, {.field = "l*"}};
  plan.add(rule);
  Bench bench(plan);
  std::string lost;
  for (int n = 1; n <= 8; ++n) {
    if (bench.pass("0", n * 10 * kMicrosecond).empty()) lost += std::to_string(n);
  }
  EXPECT_EQ(lost, "246");
}

TEST(Plan, TellsEveryHitToTheTrace) {
  Plan plan;
  Rule rule = rule_of(Flip{}, {1, 2, 1});
  rule.name = "two wrong";
  plan.add(rule);
  Bench bench(plan);
  bench.pass("0101");
  ASSERT_EQ(bench.faults.texts.size(), 1U);
  EXPECT_EQ(bench.faults.texts[0], "flip levels 1..2: levels of transmission 1, unit 0 (rule 0 two wrong)");
}

TEST(Plan, RefusesWhatNoRuleCanMean) {
  trace::Trace trace;
  const auto install = [&](Rule rule) {
    Plan plan;
    plan.add(std::move(rule));
    InstalledPlan installed(plan, trace, kernel::Random(1));
  };
  EXPECT_THROW(install(rule_of(Delay{-kPicosecond})), kernel::BrokenInvariant);
  EXPECT_THROW(install(rule_of(Mute{kLongestDuration + kPicosecond})), kernel::BrokenInvariant);
  EXPECT_NO_THROW(install(rule_of(Mute{kLongestDuration})));
  EXPECT_THROW(install(rule_of(Drop{}, {0, 9, 0})), kernel::BrokenInvariant);
  Rule unsure = rule_of(Drop{});
  unsure.when.chance = 1.5;
  EXPECT_THROW(install(unsure), kernel::BrokenInvariant);
}

// A train of telegrams: the rules speak of its fields.
class Train : public testing::Test {
 protected:
  Train() : code_(layout_) {
    sent_.rate = kRate;
    for (std::uint8_t n = 0; n < 4; ++n) code_.append(sent_.levels, line::kDataTelegram, n);
  }
  std::string octets(Plan plan) {
    trace::Trace trace;
    InstalledPlan installed(std::move(plan), trace, kernel::Random(1));
    Channel* channel =
        installed.channel_for({"rx", trace.add_channel("rx")}, std::make_unique<TelegramFields>(layout_));
    Waveforms arrivals;
    if (!channel->pass(sent_, arrivals)) return "as sent";
    std::string text;
    for (const Waveform& arrival : arrivals) {
      text += "@" + std::to_string((arrival.start - kStart) / kMicrosecond);
      code_.decode(arrival.levels, 0, [&](const line::Telegram& telegram) {
        text += " " + std::to_string(telegram.data) + (telegram.is_stop_missing() ? "!" : "");
      });
      text += ";";
    }
    return text;
  }
  static Rule rule(Effect effect, Scope scope, std::string field, Numbers unit) {
    Rule rule;
    rule.effect = std::move(effect);
    rule.scope = scope;
    rule.when.field = std::move(field);
    rule.when.unit = unit;
    return rule;
  }
  line::TelegramLayout layout_;
  line::TelegramCode code_;
  Waveform sent_;
};

TEST_F(Train, IsTornWhereATelegramIsDropped) {
  EXPECT_EQ(octets(Plan({rule(Drop{}, Scope::unit, "*", Numbers::only(1))})), "@0 0;@26 2 3;");
  EXPECT_EQ(octets(Plan({rule(Drop{}, Scope::unit, "*", Numbers::only(0))})), "@13 1 2 3;");
  EXPECT_EQ(octets(Plan({rule(Drop{}, Scope::unit, "*", Numbers::only(3))})), "@0 0 1 2;");
  EXPECT_EQ(octets(Plan({rule(Drop{}, Scope::frame, "data", Numbers::only(3))})), "");
  EXPECT_EQ(octets(Plan({rule(Drop{}, Scope::unit, "*", Numbers::only(4))})), "as sent");
}

TEST_F(Train, StaysOneTrainWhereATelegramIsRepeatedOrInserted) {
  EXPECT_EQ(octets(Plan({rule(Repeat{}, Scope::unit, "data", Numbers::only(2))})), "@0 0 1 2 2 3;");
  line::Levels telegram;
  code_.append(telegram, line::kDataTelegram, 99);
  EXPECT_EQ(octets(Plan({rule(Insert{telegram, true}, Scope::unit, "*", Numbers::only(3))})),
            "@0 0 1 2 3 99;");
}

TEST_F(Train, FieldsAreHitByName) {
  EXPECT_EQ(octets(Plan({rule(Flip{}, Scope::field, "stop", Numbers::only(3))})), "@0 0 1 2 3!;");
  Rule bit = rule(Flip{}, Scope::field, "data", {1, 3, 2});
  bit.when.bit = Numbers::only(0);
  EXPECT_EQ(octets(Plan({bit})), "@0 0 129 2 131;");
}

TEST_F(Train, AUnitIsAskedOnceHoweverManyOfItsFieldsFit) {
  Rule unsure = rule(Drop{}, Scope::unit, "*", {});
  unsure.when.chance = 0.5;
  trace::Trace trace;
  InstalledPlan installed(Plan({unsure}), trace, kernel::Random(7));
  Channel* channel =
      installed.channel_for({"rx", trace.add_channel("rx")}, std::make_unique<TelegramFields>(layout_));
  Waveforms arrivals;
  for (int n = 0; n < 1000; ++n) channel->pass(sent_, arrivals);
  // 4000 draws of one half: six standard deviations are 190. Draws per field would give 3938.
  EXPECT_NEAR(static_cast<double>(installed.hits(0)), 2000.0, 190.0);
}

TEST_F(Train, EachLevelIsDrawnForItself) {
  Rule noise = rule(Flip{}, Scope::level, "data", {});
  noise.when.chance = 0.25;
  trace::Trace trace;
  InstalledPlan installed(Plan({noise}), trace, kernel::Random(7));
  Channel* channel =
      installed.channel_for({"rx", trace.add_channel("rx")}, std::make_unique<TelegramFields>(layout_));
  Waveforms arrivals;
  std::size_t wrong = 0;
  for (int n = 0; n < 500; ++n) {
    arrivals.clear();
    if (!channel->pass(sent_, arrivals)) continue;
    for (std::size_t k = 0; k < sent_.levels.size(); ++k) wrong += arrivals[0].levels[k] != sent_.levels[k];
  }
  EXPECT_EQ(wrong, installed.hits(0));
  EXPECT_NEAR(static_cast<double>(wrong), 4000.0, 330.0);  // 16000 draws, six standard deviations
}

// Chance at one receiver does not depend on who else is there, nor on what other rules draw.
RC_GTEST_PROP(Plan, DrawsOfAReceiverAndARuleAreTheirOwn, (std::uint64_t seed)) {
  Rule unsure;
  unsure.effect = Drop{};
  unsure.when.chance = 0.5;
  Rule other = unsure;
  other.when.frame = {2, 1000, 3};
  other.effect = Flip{};
  const auto lost = [&](bool with_other) {
    trace::Trace trace;
    const trace::Channel place = trace.add_channel("x");
    Plan plan({unsure});
    if (with_other) plan.add(other);
    InstalledPlan installed(plan, trace, kernel::Random(seed));
    Channel* noise = with_other ? installed.channel_for({"another", place}) : nullptr;
    Channel* rx = installed.channel_for({"rx", place});
    std::string result;
    Waveforms arrivals;
    for (int n = 0; n < 64; ++n) {
      if (noise != nullptr) noise->pass(wave_of("0"), arrivals);
      arrivals.clear();
      result += rx->pass(wave_of("0"), arrivals) && arrivals.empty() ? "x" : ".";
    }
    return result;
  };
  RC_ASSERT(lost(false) == lost(true));
}

// Whatever rules do, arrivals are in order, do not overlap and do not come before they were sent.
RC_GTEST_PROP(Plan, ArrivalsNeverOverlap, (std::uint64_t seed)) {
  kernel::Random random(seed);
  const auto duration = [&] { return Duration{random.between(0, 40'000'000)}; };
  Plan plan;
  for (std::uint64_t n = 1 + random.below(4); n > 0; --n) {
    const std::vector<Effect> effects{
        Flip{},          Force{true},           Delay{duration()},
        Drop{},          Repeat{2, duration()}, Insert{levels_of("0011"), false},
        Mute{duration()}};
    const std::uint64_t first = random.below(20);
    Rule rule = rule_of(effects[random.below(effects.size())], {first, first + random.below(6), 1});
    rule.when.chance = 0.5;
    plan.add(rule);
  }
  Bench bench(plan, seed);
  if (bench.channel == nullptr) return;
  std::vector<std::pair<kernel::Time, kernel::Time>> heard;
  kernel::Time now = kStart;
  for (int n = 0; n < 20; ++n) {
    Waveform sent;
    sent.start = now;
    sent.rate = kRate;
    sent.levels.append(random.next(), 20);
    Waveforms arrivals;
    if (!bench.channel->pass(sent, arrivals)) arrivals.add(sent);
    for (const Waveform& arrival : arrivals) {
      RC_ASSERT(arrival.start >= sent.start);
      for (const auto& [from, to] : heard) RC_ASSERT(arrival.start >= to || arrival.end() <= from);
      heard.emplace_back(arrival.start, arrival.end());
    }
    now = sent.end() + Duration{random.between(0, 10'000'000)};
  }
}

TEST(InstalledPlan, MutesThatMeetAreOneSilence) {
  // Each level silences the line for two levels more: from the first one on until two after the last.
  Rule rule = rule_of(Mute{2 * kMicrosecond});
  rule.scope = Scope::level;
  rule.when.to = kStart + 3 * kMicrosecond;
  Bench bench(Plan({rule}));
  EXPECT_EQ(bench.pass("0101010"), "@4 010");
}

// What each transmission leaves for later ones must not be paid for again by each of them without end.
TEST(InstalledPlan, EndsARunThatItWouldNeverLetEnd) {
  const std::string train(100, '1');
  const auto passes = [&](const Effect& effect) {
    Rule rule = rule_of(effect);
    rule.scope = Scope::level;
    constexpr std::uint64_t kLittleWork = PlanWork::kMostSteps / 100;  // not to wait for it
    Bench bench(Plan({rule}), 1, kLittleWork);
    int count = 0;
    try {
      for (; count < 100'000; ++count) bench.pass(train, count * 200 * kMicrosecond);
    } catch (const PlanTooHeavy&) {
      return count;
    }
    ADD_FAILURE() << word_of(effect) << " was served";
    return count;
  };
  line::Levels many;
  for (int n = 0; n < 50; ++n) many.append(~std::uint64_t{0}, 64);
  EXPECT_GT(passes(Delay{kLongestDuration}), 10);
  EXPECT_GE(passes(Repeat{1000}), 1);
  EXPECT_GE(passes(Insert{many}), 1);
}

TEST(InstalledPlan, ServesAnOrdinaryPlanForLong) {
  Bench bench(Plan({rule_of(Flip{}, Numbers::only(3)), rule_of(Mute{kMicrosecond})}));
  for (int n = 0; n < 20'000; ++n) EXPECT_NO_THROW(bench.pass("01010101010", n * 20 * kMicrosecond));
}

}  // namespace
}  // namespace fieldproof::fault
