#include "harness/fault/plan_file.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>
#include <string>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::fault {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kStart;

Plan plan_of(const std::string& text, const PlanReading& reading = {}) {
  const config::Document document = config::Document::parse(text, "plan.json");
  return read_plan(document.root(), reading);
}

std::string error_of(const std::string& text) {
  try {
    plan_of(text);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    return error.what();
  }
  return "no error";
}

TEST(PlanFile, ReadsEveryMember) {
  const Plan plan = plan_of(R"({
    // comments are allowed
    "rules": [
      { "name": "all", "scope": "unit", "times": 3,
        "when": { "receiver": "slave ?", "frame": "data_cycle", "frame_number": {"from": 3, "to": 9,
                  "every": 2},
                  "unit": 4, "field": "data", "bit": {"from": 1},
                  "from": "1 ms", "to": "2 ms", "chance": 0.25,
                  "after": {"observation": "bus stop", "channel": "master", "nth": 2, "for": "5 us"},
                  "all_of": [{"field": "a"}], "any_of": [{"field": "b"}, {"field": "c"}],
                  "none_of": [{"unit": 0}] },
        "effect": {"force": {"level": 1, "count": 3}} },
      { "effect": {"flip": {"levels": [0, 7]}} },
      { "effect": {"repeat": {"count": 2, "gap": "3 us"}} },
      { "effect": {"insert": {"levels": "0110", "behind": true}} }
    ] })");
  Rule rule;
  rule.name = "all";
  rule.scope = Scope::unit;
  rule.times = 3;
  rule.when.receiver = "slave ?";
  rule.when.frame_kind = "data_cycle";
  rule.when.frame = {3, 9, 2};
  rule.when.unit = Numbers::only(4);
  rule.when.field = "data";
  rule.when.bit.first = 1;
  rule.when.from = kStart + 1 * kMillisecond;
  rule.when.to = kStart + 2 * kMillisecond;
  rule.when.chance = 0.25;
  rule.when.after = After{"bus stop", "master", 2, 5 * kMicrosecond};
  rule.when.all_of = {{.field = "a"}};
  rule.when.any_of = {{.field = "b"}, {.field = "c"}};
  rule.when.none_of = {{.unit = Numbers::only(0)}};
  rule.effect = Force{true, 3};
  ASSERT_EQ(plan.rules().size(), 4U);
  EXPECT_EQ(plan.rules()[0], rule);
  EXPECT_EQ(plan.rules()[1].effect, Effect(Flip{{0, 7}}));
  EXPECT_EQ(plan.rules()[2].effect, Effect(Repeat{2, 3 * kMicrosecond}));
  const Insert& insert = std::get<Insert>(plan.rules()[3].effect);
  EXPECT_EQ(insert.levels.text(), "0110");
  EXPECT_TRUE(insert.is_behind);
}

TEST(PlanFile, WritesATelegramAsTheLineDoes) {
  const line::TelegramCode code{line::TelegramLayout{}};
  const Plan plan = plan_of(
      R"({"rules": [ {"effect": {"insert": {"telegram": {"control": true, "data": "0x5A"}}}},
                     {"effect": {"insert": {"telegram": {"select": true}}}} ]})",
      {&code});
  line::Levels data;
  code.append(data, line::kControl | line::kDataTelegram, 0x5A);
  line::Levels status;
  code.append(status, line::kSelect, 0);
  EXPECT_EQ(std::get<Insert>(plan.rules()[0].effect).levels, data);
  EXPECT_EQ(std::get<Insert>(plan.rules()[1].effect).levels, status);
}

struct BadPlan {
  const char* name;
  std::string text;
  const char* place;     // line and pointer
  const char* contains;  // what is wrong or what would be right
};

void PrintTo(const BadPlan& bad, std::ostream* out) {
  *out << bad.name;
}

class BadPlans : public testing::TestWithParam<BadPlan> {};

TEST_P(BadPlans, AreRefusedWithTheirPlace) {
  const std::string error = error_of(GetParam().text);
  EXPECT_TRUE(error.starts_with("plan.json:" + std::string(GetParam().place))) << error;
  EXPECT_NE(error.find(GetParam().contains), std::string::npos) << error;
}

std::string with_when(const std::string& when) {
  return "{\"rules\": [\n{\"effect\": {\"drop\": {}},\n\"when\": {" + when + "}}]}";
}

std::string with_effect(const std::string& effect) {
  return "{\"rules\": [\n{\"effect\": {" + effect + "}}]}";
}

INSTANTIATE_TEST_SUITE_P(
    Places, BadPlans,
    testing::Values(
        BadPlan{"no_rules", "{}", "1: ", "rules"},
        BadPlan{"unknown_key", "{\"rules\": [],\n\"rulez\": []}", "2: /rulez: ", "rules"},
        BadPlan{"no_effect", "{\"rules\": [\n\n{\"name\": \"x\"}]}", "3: /rules/0: ", "effect"},
        BadPlan{"empty_effect", with_effect(""), "2: /rules/0/effect: ", "one effect"},
        BadPlan{"two_effects", with_effect("\"drop\": {}, \"flip\": {}"),
                "2: /rules/0/effect: ", "one effect"},
        BadPlan{"misspelled_effect", with_effect("\"filp\": {}"), "2: /rules/0/effect/filp: ", "\"flip\""},
        BadPlan{"level_of_two", with_effect("\"force\": {\"level\": 2}"),
                "2: /rules/0/effect/force/level: ", "from 0 to 1"},
        BadPlan{"force_twice_limited",
                with_effect("\"force\": {\"level\": 0, \"count\": 1,\n\"duration\": \"1 us\"}"),
                "3: /rules/0/effect/force/duration: ", "leave one"},
        BadPlan{"delay_without_unit", with_effect("\"delay\": {\"duration\": 5}"),
                "2: /rules/0/effect/delay/duration: ", "needs its unit"},
        BadPlan{"delay_of_nothing", with_effect("\"delay\": {\"duration\": \"0 s\"}"),
                "2: /rules/0/effect/delay/duration: ", "too small"},
        BadPlan{"mute_for_too_long", with_effect("\"mute\": {\"duration\": \"1000001 s\"}"),
                "2: /rules/0/effect/mute/duration: ", "too large"},
        BadPlan{"no_level", with_effect("\"insert\": {\"levels\": \"\"}"),
                "2: /rules/0/effect/insert/levels: ", "\"0101\""},
        BadPlan{"wrong_level", with_effect("\"insert\": {\"levels\": \"0121\"}"),
                "2: /rules/0/effect/insert/levels: ", "\"0101\""},
        BadPlan{"insert_of_nothing", with_effect("\"insert\": {}"), "2: /rules/0/effect/insert: ", "either"},
        BadPlan{"telegram_where_none_are", with_effect("\"insert\": {\"telegram\": {}}"),
                "2: /rules/0/effect/insert/telegram: ", "\"levels\""},
        BadPlan{"window_backwards", with_when("\"from\": \"2 ms\",\n\"to\": \"2 ms\""),
                "4: /rules/0/when/to: ", "after"},
        BadPlan{"frame_zero", with_when("\"frame_number\": 0"), "3: /rules/0/when/frame_number: ", "from 1"},
        BadPlan{"range_backwards", with_when("\"unit\": {\"from\": 5,\n\"to\": 4}"),
                "4: /rules/0/when/unit/to: ", "from 5"},
        BadPlan{"every_zeroth", with_when("\"bit\": {\"every\": 0}"),
                "3: /rules/0/when/bit/every: ", "from 1"},
        BadPlan{"chance_above_one", with_when("\"chance\": 1.01"),
                "3: /rules/0/when/chance: ", "from 0 to 1"},
        BadPlan{"empty_name", with_when("\"field\": \"\""), "3: /rules/0/when/field: ", "\"*\""},
        BadPlan{"after_nothing", with_when("\"after\": {\"nth\": 1}"),
                "3: /rules/0/when/after: ", "observation"},
        BadPlan{"any_of_none", with_when("\"any_of\": []"), "3: /rules/0/when/any_of: ", "at least 1"},
        BadPlan{"deep_inside", with_when("\"any_of\": [{}, {\"none_of\": [{\n\"feild\": \"x\"}]}]"),
                "4: /rules/0/when/any_of/1/none_of/0/feild: ", "\"field\""},
        BadPlan{"unknown_scope", "{\"rules\": [{\"effect\": {\"drop\": {}},\n\"scope\": \"feld\"}]}",
                "2: /rules/0/scope: ", "\"field\""}),
    [](const testing::TestParamInfo<BadPlan>& instance) { return std::string(instance.param.name); });

// A window that 64 bit do not hold would be another one than was written.
INSTANTIATE_TEST_SUITE_P(
    Meanings, BadPlans,
    testing::Values(BadPlan{"from_beyond_time", with_when("\"from\": \"99999999999 s\""),
                            "3: /rules/0/when/from: ", "too large"},
                    BadPlan{"to_beyond_time", with_when("\"to\": \"1000001 s\""),
                            "3: /rules/0/when/to: ", "too large"},
                    BadPlan{"frames_up_to_none", with_when("\"frame_number\": {\"to\": 0}"),
                            "3: /rules/0/when/frame_number/to: ", "from 1"},
                    BadPlan{"negative_gap", with_effect("\"repeat\": {\"gap\": \"-0 us\"}"),
                            "2: /rules/0/effect/repeat/gap: ", "too small"}),
    [](const testing::TestParamInfo<BadPlan>& instance) { return std::string(instance.param.name); });

TEST(PlanFile, EveryNthFrameBeginsWithTheFirst) {
  const Plan plan = plan_of(with_when("\"frame_number\": {\"every\": 2}, \"unit\": {\"every\": 2}"));
  EXPECT_EQ(plan.rules().front().when.frame, (Numbers{1, Numbers{}.last, 2}));
  EXPECT_EQ(plan.rules().front().when.unit, (Numbers{0, Numbers{}.last, 2}));
  EXPECT_EQ(canonical_text(plan),
            canonical_text(plan_of(with_when("\"frame_number\": {\"from\": 1, \"every\": 2}, \"unit\": "
                                             "{\"every\": 2}"))));
}

TEST(PlanFile, TheLimitsThemselvesAreRead) {
  EXPECT_EQ(error_of(with_when("\"chance\": 1.0")), "no error");
  EXPECT_EQ(error_of(with_when("\"from\": \"2 ms\", \"to\": \"2000000001 ps\"")), "no error");
  EXPECT_EQ(error_of(with_effect("\"mute\": {\"duration\": \"1000000 s\"}")), "no error");
  EXPECT_EQ(error_of(with_effect("\"delay\": {\"duration\": \"1 ps\"}")), "no error");
}

// ---- disturbances ----

// A model of a test: it forgets everything but a number.
DisturbanceModel read_noise(const config::Value& value) {
  const auto volts = config::read_object(
      value, [](config::ObjectReader& object) { return object.required("volts").as_integer<int>(0, 9); });
  return {"noise", "{\"volts\":" + std::to_string(volts) + "}", nullptr};
}

const std::array<DisturbanceKind, 2> kNoises{{{"noise", read_noise}, {"hum", read_noise}}};

TEST(PlanFile, ReadsDisturbancesOfTheKindsThatItIsGiven) {
  const Plan plan = plan_of(R"({"disturbances": [
      {"name": "a lamp", "receiver": "slave *", "from": "1 ms", "to": "2 ms", "noise": {"volts": 3}},
      {"noise": {"volts": 0}}]})",
                            {.disturbances = kNoises});
  const Disturbance lamp{.name = "a lamp",
                         .receiver = "slave *",
                         .from = kStart + 1 * kMillisecond,
                         .to = kStart + 2 * kMillisecond,
                         .model = {"noise", "{\"volts\":3}", nullptr}};
  ASSERT_EQ(plan.disturbances().size(), 2U);
  EXPECT_EQ(plan.disturbances()[0], lamp);
  EXPECT_EQ(plan.disturbances()[1], (Disturbance{.model = {"noise", "{\"volts\":0}", nullptr}}));
  EXPECT_FALSE(plan.empty());
}

TEST(PlanFile, TheTextOfADisturbanceIsReadAgain) {
  const PlanReading reading{.disturbances = kNoises};
  const Plan plan = plan_of(R"({"rules": [{"effect": {"drop": {}}}],
      "disturbances": [{"noise": {"volts": 3}, "to": "2000 us", "from": "0 s", "receiver": "*"}]})",
                            reading);
  const std::string text = canonical_text(plan);
  EXPECT_EQ(plan_of(text, reading), plan);
  EXPECT_NE(text.find("\"to\": \"2.000 ms\""), std::string::npos) << text;
  EXPECT_EQ(text.find("receiver"), std::string::npos) << text;
}

TEST(PlanFile, RefusesADisturbanceThatIsNoneOfThem) {
  const auto refusal = [](const std::string& disturbance, const PlanReading& reading) -> std::string {
    try {
      plan_of("{\"disturbances\": [{" + disturbance + "}]}", reading);
    } catch (const kernel::Error& error) {
      return error.what();
    }
    return "no error";
  };
  const PlanReading reading{.disturbances = kNoises};
  const std::string place = "plan.json:1: /disturbances/0";
  EXPECT_EQ(refusal("", reading), place + ": it is not said what disturbs; write one of noise, hum");
  EXPECT_EQ(refusal(R"("noise": {"volts": 1}, "hum": {"volts": 1})", reading),
            place + ": a disturbance is one thing; write one for each");
  EXPECT_TRUE(refusal(R"("noise": {"volts": 10})", reading).starts_with(place + "/noise/volts: "));
  EXPECT_TRUE(
      refusal(R"("noise": {"volts": 1}, "reciever": "*")", reading).ends_with("did you mean \"receiver\"?"));
  EXPECT_TRUE(refusal(R"("noise": {"volts": 1}, "from": "2 ms", "to": "1 ms")", reading)
                  .starts_with(place + "/to: "));
  EXPECT_EQ(refusal(R"("receiver": "*")", {}), place + ": this program has no disturbances; leave it out");
}

TEST(PlanFile, TheSameRulesHaveTheSameTextAndHash) {
  const Plan a =
      plan_of(R"({"rules": [{"when": {"field": "x", "from": "1000 us"}, "effect": {"drop": {}}}]})");
  const Plan b = plan_of(R"({"rules": [ // other order, other unit, defaults written out
      {"effect": {"drop": {}}, "scope": "field", 
       "when": {"from": "1 ms", "chance": 1, "field": "x", "receiver": "*"}}]})");
  EXPECT_EQ(canonical_text(a), canonical_text(b));
  EXPECT_EQ(hash_of(a), hash_of(b));
  EXPECT_EQ(canonical_text(Plan{}), "{\n  \"rules\": []\n}\n");
  const Plan c =
      plan_of(R"({"rules": [{"when": {"field": "x", "from": "1001 us"}, "effect": {"drop": {}}}]})");
  EXPECT_NE(hash_of(a), hash_of(c));
}

TEST(PlanFile, IsLoadedByItsName) {
  const auto path = std::filesystem::path(testing::TempDir()) / "fieldproof_plan_file_test.json";
  std::ofstream(path) << with_effect("\"drop\": {}");
  EXPECT_EQ(load_plan(path).rules().size(), 1U);
  std::filesystem::remove(path);
  EXPECT_THROW(load_plan(path), kernel::Error);
}

TEST(PlanFile, TheExampleOfTheReadmeIsAPlan) {
  std::ifstream file(std::string(FIELDPROOF_SOURCE_DIR) + "/harness/fault/README.md");
  std::stringstream readme;
  readme << file.rdbuf();
  const std::string text = readme.str();
  const std::size_t begin = text.find("```json");
  const std::size_t end = text.find("```", begin + 7);
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(plan_of(text.substr(begin + 7, end - begin - 7)).rules().size(), 3U);
}

// Any plan at all, within what a file can say.
class AnyPlan {
 public:
  explicit AnyPlan(std::uint64_t seed) : random_(seed) {}

  Plan plan() {
    Plan result;
    for (std::uint64_t n = random_.below(4); n > 0; --n) result.add(rule());
    return result;
  }

 private:
  bool coin() { return random_.chance(0.5); }
  std::string name() { return std::string(random_.below(2), '*') + "n" + std::to_string(random_.below(9)); }
  Duration duration() { return Duration{random_.between(1, kLongestDuration.count())}; }

  Numbers numbers() {
    if (coin()) return {};
    const std::uint64_t first = 1 + random_.below(9);
    if (coin()) return Numbers::only(first);
    return {first, coin() ? first + random_.below(9) : Numbers{}.last, 1 + random_.below(3)};
  }

  When when(int depth) {
    When result;
    if (coin()) result.receiver = name();
    if (coin()) result.frame_kind = name();
    if (coin()) result.field = name();
    result.frame = numbers();
    result.unit = numbers();
    result.bit = numbers();
    if (coin()) result.from = kStart + Duration{random_.between(0, 1'000'000'000'000)};
    if (coin()) result.to = kStart + Duration{random_.between(1'000'000'000'001, 1'000'000'000'000'000)};
    if (coin()) result.chance = random_.uniform();
    if (coin()) {
      result.after = After{name(), name(), 1 + random_.below(3), coin() ? duration() : Duration::max()};
    }
    if (depth == 0) return result;
    for (auto* inner : {&result.all_of, &result.any_of, &result.none_of}) {
      for (std::uint64_t n = random_.below(3); n > 0; --n) inner->push_back(when(depth - 1));
    }
    return result;
  }

  Effect effect() {
    line::Levels levels;
    levels.append(random_.next(), static_cast<unsigned>(1 + random_.below(64)));
    switch (random_.below(8)) {
      case 0:
        return coin() ? Flip{} : Flip{{0, 5}};
      case 1:
        return Force{coin(), static_cast<std::uint32_t>(random_.below(3))};
      case 2:
        return Force{coin(), 0, duration()};
      case 3:
        return Delay{duration()};
      case 4:
        return Drop{};
      case 5:
        return Repeat{static_cast<std::uint32_t>(1 + random_.below(3)), coin() ? duration() : Duration{}};
      case 6:
        return Insert{levels, coin()};
      default:
        return Mute{duration()};
    }
  }

  Rule rule() {
    Rule result;
    if (coin()) result.name = "a \"name\"";
    if (coin()) result.when = when(2);
    result.scope = static_cast<Scope>(random_.below(5));
    result.effect = effect();
    if (coin()) result.times = 1 + random_.below(5);
    return result;
  }

  kernel::Random random_;
};

RC_GTEST_PROP(PlanFile, ReadingTheCanonicalTextGivesThePlan, (std::uint64_t seed)) {
  const Plan plan = AnyPlan(seed).plan();
  RC_ASSERT(plan_of(canonical_text(plan)) == plan);
}

}  // namespace
}  // namespace fieldproof::fault
