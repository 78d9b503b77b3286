#include "protocols/fieldbus_dll/isa_dlpdu.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "harness/field/facts.hpp"
#include "protocols/fieldbus_dll/rule_tables.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

struct Sample {
  IsaDlpdu dlpdu;
  Octets on_line;  // with the check
  std::string text;
};

// Octets and checks computed by another program.
std::vector<Sample> samples() {
  using enum IsaType;
  using enum Priority;
  return {
      {{.type = et, .priority = normal, .destination = 0x21, .source = 0x10},
       {0x42, 0x21, 0x10, 0xE1, 0xDC},
       "ET normal 10 -> 21"},
      {{.type = es, .priority = urgent, .destination = 0x21, .source = 0x10, .duration = 1000},
       {0x53, 0x21, 0x10, 0x03, 0xE8, 0x32, 0xFE},
       "ES urgent 10 -> 21 for 1000 octets"},
      {{.type = ee, .destination = 0x10, .source = 0x21},
       {0x64, 0x10, 0x21, 0x00, 0xEC, 0x1F},
       "EE 21 -> 10, nothing to send"},
      {{.type = cd, .priority = time_available, .destination = 0x22, .source = 0x21},
       {0x11, 0x22, 0x21, 0xE1, 0xA3},
       "CD time-available 21 -> 22"},
      {{.type = dt,
        .priority = normal,
        .is_final = true,
        .destination = 0x21,
        .source = 0x22,
        .data = {0x41, 0x42}},
       {0x26, 0x21, 0x22, 0x41, 0x42, 0x29, 0x6B},
       "DT normal 22 -> 21 final: 41 42"},
      {{.type = du, .priority = urgent, .destination = 0xFF, .source = 0x21, .data = {0x00}},
       {0x33, 0xFF, 0x21, 0x00, 0xAB, 0x6D},
       "DU urgent 21 -> FF: 00"},
      {{.type = tl, .destination = 0x11, .source = 0x10, .schedule_version = 1},
       {0x70, 0x11, 0x10, 0x00, 0x01, 0xE4, 0x1A},
       "TL 10 -> 11, schedule 1"},
  };
}

TEST(IsaDlpdu, IsWrittenAndReadAsTheSamplesAre) {
  const IsaRules rules;
  for (const Sample& sample : samples()) {
    EXPECT_EQ(with_check(octets_of(sample.dlpdu, rules)), sample.on_line) << sample.text;
    const std::span on_line(sample.on_line);
    const auto read = isa_dlpdu_of(on_line.first(on_line.size() - kCheckOctets), rules);
    ASSERT_TRUE(read.has_value()) << sample.text;
    EXPECT_EQ(*read, sample.dlpdu) << sample.text;
    EXPECT_EQ(describe(*read), sample.text);
    EXPECT_EQ(octets_on_line(sample.dlpdu.type, sample.dlpdu.data.size()), sample.on_line.size());
  }
}

TEST(IsaDlpdu, IsNoneWhenAFieldDoesNotExist) {
  const IsaRules rules;
  const std::vector<Octets> wrong{
      {},
      {0x42},
      {0x42, 0x21},
      {0x40, 0x21, 0x10},  // no priority
      {0x4A, 0x21, 0x10},  // a reserved bit
      {0x46, 0x21, 0x10},  // an ET is never final
      {0x42, 0x00, 0x10},  // addresses
      {0x42, 0xF8, 0x10},
      {0x42, 0xFF, 0x10},  // everybody gets DU only
      {0x42, 0x21, 0xFF},
      {0x42, 0x21, 0x10, 0x00},  // a length
      {0x53, 0x21, 0x10, 0x03},
      {0x53, 0x21, 0x10, 0x00, 0x00},  // no duration
      {0x60, 0x10, 0x21, 0x00},        // an EE is always final
      {0x65, 0x10, 0x21, 0x00},        // and has no priority
      {0x64, 0x10, 0x21, 0x03},        // no such reason
      {0x26, 0xFF, 0x22, 0x41},        // a DT to everybody
      {0x80, 0x10},                    // types
      {0x93, 0x21, 0x10},
  };
  for (const Octets& octets : wrong) EXPECT_FALSE(isa_dlpdu_of(octets, rules)) << octets.size();
}

TEST(IsaDlpdu, DataIsAsLongAsItsPriorityAllows) {
  const IsaRules rules;
  for (const Priority priority : {Priority::urgent, Priority::normal, Priority::time_available}) {
    IsaDlpdu dlpdu{.type = IsaType::du, .priority = priority, .destination = 0x22, .source = 0x21};
    dlpdu.data.assign(most_data(rules.link, priority), 0x55);
    EXPECT_TRUE(isa_dlpdu_of(octets_of(dlpdu, rules), rules));
    dlpdu.data.push_back(0x55);
    EXPECT_FALSE(isa_dlpdu_of(octets_of(dlpdu, rules), rules));
  }
}

RC_GTEST_PROP(IsaDlpduProperty, WhateverIsReadIsWrittenTheSame, (const Octets& tail)) {
  const IsaRules rules;
  Octets octets{*rc::gen::arbitrary<std::uint8_t>(),
                *rc::gen::elementOf(Octets{0x00, 0x10, 0x21, 0xF7, 0xF8, 0xFF}),
                *rc::gen::elementOf(Octets{0x00, 0x10, 0x21, 0xF7, 0xF8, 0xFF})};
  octets.insert(octets.end(), tail.begin(), tail.end());
  const auto dlpdu = isa_dlpdu_of(octets, rules);
  if (dlpdu) RC_ASSERT(octets_of(*dlpdu, rules) == octets);
}

TEST(IsaRules, EachNumberHasASource) {
  IsaRules rules;
  for (const field::Fact& fact : field::facts_of(kIsaRulesTable, rules))
    EXPECT_FALSE(fact.source.empty()) << fact.name;
  rules.reply_wait_octets = 35;
  std::size_t changed = 0;
  for (const field::Fact& fact : field::facts_of(kIsaRulesTable, rules)) {
    if (fact.source != "set for this run; not from a source") continue;
    ++changed;
    EXPECT_EQ(fact.name, "reply_wait_octets");
    EXPECT_EQ(fact.standing, judge::Standing::own);
  }
  EXPECT_EQ(changed, 1U);
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
