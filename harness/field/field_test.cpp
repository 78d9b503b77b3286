// Subject: rows and what is made of them, over a configuration with a member of each kind.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "harness/field/boundaries.hpp"
#include "harness/field/differences.hpp"
#include "harness/field/facts.hpp"
#include "harness/field/pics.hpp"
#include "harness/field/sample_table.hpp"
#include "harness/field/settings.hpp"
#include "harness/field/written_table.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::field {
namespace {

using judge::Standing;
using kernel::kMillisecond;
using kernel::kPicosecond;

static_assert(kMembers<Sample> == 9);
static_assert(kMembers<SampleInside> == 2);
static_assert(name_of<&Sample::bit_rate>() == "bit_rate");

Sample arbitrary_sample() {
  const auto within = [](std::int64_t least, std::int64_t most) {
    return *rc::gen::oneOf(rc::gen::inRange<std::int64_t>(least, most + 1), rc::gen::element(least, most));
  };
  Sample sample;
  sample.inside.code = static_cast<std::uint8_t>(within(0, 0xF0));
  sample.inside.half_bits = static_cast<unsigned>(within(1, 9));
  sample.bit_rate = within(1'200, 10'000'000);
  sample.limit = kernel::Duration{within(0, 1'000'000'000'000)};
  sample.is_loud = within(0, 1) != 0;
  sample.colour = static_cast<SampleColour>(within(0, 1));
  sample.pair = {static_cast<std::uint16_t>(within(0, 100)), static_cast<std::uint16_t>(within(0, 100))};
  for (auto n = within(0, 4); n > 0; --n)
    sample.live.push_back(static_cast<std::uint8_t>(within(0x10, 0xF7)));
  for (auto n = within(0, 3); n > 0; --n) {
    sample.items.push_back(
        {static_cast<unsigned>(within(0, 99)), kernel::Duration{within(0, 5'000'000'000)}});
  }
  return sample;
}

RC_GTEST_PROP(Field, SettingsComeBack, ()) {
  const Sample sample = arbitrary_sample();
  const Settings settings = settings_of(kSampleTable, sample);
  const Sample back = taken_from(kSampleTable, settings);
  RC_ASSERT(settings_of(kSampleTable, back) == settings);
  RC_ASSERT(back.items == sample.items);
  RC_ASSERT(back.live == sample.live);
  RC_ASSERT(back.limit == sample.limit);
  RC_ASSERT(back.inside.code == sample.inside.code);
}

std::string refusal_of(const Settings& settings) {
  try {
    taken_from(kSampleTable, settings);
  } catch (const kernel::Error& refused) {
    EXPECT_EQ(refused.kind(), kernel::ErrorKind::configuration);
    return refused.what();
  }
  return "";
}

RC_GTEST_PROP(Field, WhateverIsGivenIsInItsRangeOrRefused, ()) {
  Settings settings = settings_of(kSampleTable, arbitrary_sample());
  auto& [name, number] = settings[*rc::gen::inRange<std::size_t>(0, settings.size())];
  number = *rc::gen::arbitrary<std::int64_t>();
  const std::string refusal = refusal_of(settings);
  if (refusal.empty()) {
    const Settings taken = settings_of(kSampleTable, taken_from(kSampleTable, settings));
    // Of a list that was made shorter the rest of its elements is left out.
    const bool is_as_given = std::ranges::all_of(
        taken, [&](const auto& one) { return std::ranges::count(settings, one) == 1 || one.second == 0x10; });
    RC_ASSERT(is_as_given || name == "items" || name == "live");
  } else {
    RC_ASSERT(refusal.find("'" + name + "' is " + std::to_string(number)) != std::string::npos);
  }
}

TEST(Field, ASettingOutsideOfItsRangeIsRefusedByName) {
  EXPECT_EQ(refusal_of({{"bit_rate", 1'200}}), "");
  EXPECT_EQ(refusal_of({{"bit_rate", 1'199}}), "the setting 'bit_rate' is 1199; it is from 1200 to 10000000");
  EXPECT_EQ(refusal_of({{"bit_rate", 10'000'001}}),
            "the setting 'bit_rate' is 10000001; it is from 1200 to 10000000");
  EXPECT_EQ(refusal_of({{"live", 5}}), "the setting 'live' is 5; it is from 0 to 4");
  EXPECT_EQ(refusal_of({{"live", 1}, {"live_0", 0xF8}}), "the setting 'live_0' is 248; it is from 16 to 247");
}

TEST(Field, SettingsAreNamedAfterMembers) {
  Sample sample;
  sample.live = {0x20};
  sample.items = {{5, 2 * kPicosecond}};
  const Settings expected{
      {"inside_code", 0xA0}, {"inside_half_bits", 3}, {"bit_rate", 500'000}, {"limit", 25'000'000'000},
      {"is_loud", 0},        {"colour", 0},           {"pair_1", 1},         {"pair_2", 2},
      {"live", 1},           {"live_0", 0x20},        {"items", 1},          {"items_0_at", 5},
      {"items_0_lasts", 2}};
  EXPECT_EQ(settings_of(kSampleTable, sample), expected);
}

TEST(Field, WhatIsNotGivenStays) {
  Sample sample;
  sample.bit_rate = 9600;
  sample.live = {0x11, 0x12};
  take_settings(kSampleTable, {{"live_1", 0x30}, {"of_nobody", 1}}, sample);
  EXPECT_EQ(sample.bit_rate, 9600);
  EXPECT_EQ(sample.live, (std::vector<std::uint8_t>{0x11, 0x30}));
}

const Fact& fact(const std::vector<Fact>& facts, std::string_view name) {
  return *std::ranges::find(facts, name, &Fact::name);
}

TEST(Field, FactsNameTheirSource) {
  Sample sample;
  const auto as_made = facts_of(kSampleTable, sample);
  ASSERT_EQ(as_made.size(), 9U);
  EXPECT_EQ(fact(as_made, "inside_code").value, "A0h");
  EXPECT_EQ(fact(as_made, "inside_half_bits").value, "1.5 bit");
  EXPECT_EQ(fact(as_made, "bit_rate").value, "500 kbit/s");
  EXPECT_EQ(fact(as_made, "bit_rate").standing, Standing::seed);
  EXPECT_EQ(fact(as_made, "colour").value, "red");
  EXPECT_EQ(fact(as_made, "live").value, "none");
  EXPECT_EQ(fact(as_made, "pair").value, "1, 2");
}

// By value, not by text: 9600 bit/s has no other text than 9600 bit/s, a limit a picosecond off may have.
TEST(Field, WhatDiffersIsOwnUnlessASourceNamesIt) {
  Sample sample;
  sample.limit += kPicosecond;
  sample.bit_rate = 2'000'000;
  sample.live = {0x10};
  const auto facts = facts_of(kSampleTable, sample);
  EXPECT_EQ(fact(facts, "limit").standing, Standing::own);
  EXPECT_EQ(fact(facts, "bit_rate").standing, Standing::searched);
  EXPECT_EQ(fact(facts, "bit_rate").source, "another paper");
  EXPECT_EQ(fact(facts, "live").standing, Standing::own);
  EXPECT_EQ(fact(facts, "colour").source, "own");
}

RC_GTEST_PROP(Field, PicsComesBack, ()) {
  const Sample sample = arbitrary_sample();
  const judge::Pics pics = declared_by(kSampleTable, sample);
  const Sample back = declared_in(kSampleTable, pics);
  RC_ASSERT(back.bit_rate == sample.bit_rate);
  RC_ASSERT(back.colour == sample.colour);
  RC_ASSERT(back.is_loud == sample.is_loud);
  RC_ASSERT(back.limit == sample.limit);
  RC_ASSERT(declared_by(kSampleTable, back).items() == pics.items());
}

TEST(Field, PicsItemsAreTheRows) {
  const auto items = pics_items_of(kSampleTable);
  ASSERT_EQ(items.size(), 6U);
  EXPECT_EQ(items[3].name, "limit");
  EXPECT_EQ(items[3].kind, judge::PicsKind::duration);
  EXPECT_EQ(items[3].most, 1'000'000'000'000);
  EXPECT_EQ(items[5].words, (std::vector<std::string>{"red", "green"}));
  EXPECT_TRUE(declared_by(kSampleTable, Sample{}).supports("limit"));
}

TEST(Field, BoundariesAreBothEndsAndTheirNeighbours) {
  const Sample sample;
  const Boundaries rate = boundaries_of(kSampleRows[1], &sample);
  EXPECT_EQ(rate.inside, (std::vector<std::int64_t>{1'200, 1'201, 500'000, 9'999'999, 10'000'000}));
  EXPECT_EQ(rate.outside, (std::vector<std::int64_t>{1'199, 10'000'001}));
  const Boundaries loud = boundaries_of(kSampleRows[3], &sample);
  EXPECT_EQ(loud.inside, (std::vector<std::int64_t>{0, 1}));
  EXPECT_TRUE(loud.outside.empty());
}

TEST(Field, DifferencesAreOneLineForEachRow) {
  EXPECT_TRUE(differences_of_any(kSampleTable, kSampleTable.reference()).empty());
  Sample sample;
  sample.inside.half_bits = 5;
  sample.bit_rate = 2'000'000;
  sample.is_loud = true;
  sample.live = {0x10, 0x11};
  sample.note = "is no setting";
  EXPECT_EQ(differences_of_any(kSampleTable, &sample),
            (std::vector<std::string>{"inside_half_bits 2.5 bit in place of 1.5 bit",
                                      "bit_rate 2 Mbit/s in place of 500 kbit/s",
                                      "is_loud yes in place of no", "live 10h, 11h in place of none"}));
}

TEST(Field, DifferenceOfALongListIsItsBeginAndItsLength) {
  Sample sample;
  sample.live.assign(200, 0x10);
  const std::vector<std::string> lines = differences_of_any(kSampleTable, &sample);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines.front().starts_with("live 10h, 10h, 10h, ")) << lines.front();
  EXPECT_TRUE(lines.front().ends_with(", 10h, ... (200 in all) in place of none")) << lines.front();
  EXPECT_LT(lines.front().size(), 500U);
  sample.live.back() = 0x11;
  EXPECT_NE(differences_of_any(kSampleTable, &sample), std::vector<std::string>{});
}

TEST(Field, MarkdownHasALineForEachSetting) {
  const std::string text = markdown_of(kSampleTable);
  EXPECT_NE(text.find("| `limit` | ps | 0 s to 1.000 s | 25.000 ms | of silence | searched |\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("| `live_N` |  | 10h to F7h |  | a node | own |\n"), std::string::npos) << text;
  EXPECT_NE(text.find("| `colour` |  | 0: red, 1: green | 0 | of the case | own |\n"), std::string::npos);
  EXPECT_EQ(explained(kSampleTable, "of_nobody"), std::nullopt);
  EXPECT_NE(explained(kSampleTable, "inside_half_bits")->find("1/2 bit"), std::string::npos);
}

}  // namespace
}  // namespace fieldproof::field
