#include "protocols/fieldbus_dll/ff_dlpdu.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <span>
#include <utility>
#include <vector>

#include "protocols/fieldbus_dll/test_link.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

TEST(FfDlpduSamples, AreWrittenAndReadAsComputedElsewhere) {
  const FfRules rules;
  const std::vector<std::pair<FfDlpdu, Octets>> samples{
      {{.type = FfType::rt}, {0x34, 0xAF, 0x21}},
      {{.type = FfType::idle}, {0x10, 0x47, 0xAC}},
      {{.type = FfType::pn, .node = 0x20}, {0x26, 0x20, 0x10, 0x43}},
      {pt(0x20, Priority::urgent, 0x0118), {0x33, 0x20, 0x01, 0x18, 0xC1, 0x09}},
      {{.type = FfType::cl, .node = 0x10}, {0x01, 0x10, 0x57, 0xE0}},
  };
  for (const auto& [dlpdu, on_line] : samples) {
    EXPECT_EQ(with_check(octets_of(dlpdu, rules)), on_line) << describe(dlpdu);
    const auto read = ff_dlpdu_of(std::span(on_line).first(on_line.size() - kCheckOctets), rules);
    ASSERT_TRUE(read.has_value()) << describe(dlpdu);
    EXPECT_EQ(*read, dlpdu) << describe(dlpdu);
  }
}

RC_GTEST_PROP(FfDlpduProperty, WhateverIsReadIsWrittenTheSame, (const Octets& octets)) {
  const FfRules rules;
  const auto dlpdu = ff_dlpdu_of(octets, rules);
  if (dlpdu) RC_ASSERT(octets_of(*dlpdu, rules) == octets);
}

TEST(FfDlpdu, EachFirstOctetWithItsRightRestIsReadAndWrittenTheSame) {
  const FfRules rules;
  std::size_t known = 0;
  for (unsigned control = 0; control < 256; ++control) {
    for (std::size_t size = 1; size <= 12; ++size) {
      Octets octets(size, 0x21);
      octets[0] = static_cast<std::uint8_t>(control);
      if (size == 2 && (control & 0xFBU) == 0x13) octets[1] = 1;  // a status that exists
      const auto dlpdu = ff_dlpdu_of(octets, rules);
      if (!dlpdu) continue;
      ++known;
      EXPECT_EQ(octets_of(*dlpdu, rules), octets);
    }
  }
  EXPECT_GT(known, 100U);
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
