#include "harness/kernel/untrusted_text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "harness/kernel/arbitrary_text.hpp"

namespace fieldproof::kernel {
namespace {

TEST(UntrustedText, KeepsEveryLengthOfWellFormedSequence) {
  const std::string text =
      "a\x7f \xc2\x80 \xdf\xbf \xe0\xa0\x80 \xef\xbf\xbf \xf0\x90\x80\x80 \xf4\x8f\xbf\xbf";
  EXPECT_EQ(as_utf8(text), text);
}

TEST(UntrustedText, WritesOctetsOutsideWellFormedSequences) {
  EXPECT_EQ(as_utf8("a\x80z"), "a\\x80z");
  EXPECT_EQ(as_utf8("\xc1\xbf"), "\\xC1\\xBF");                    // not the shortest form
  EXPECT_EQ(as_utf8("\xe0\x9f\xbf"), "\\xE0\\x9F\\xBF");           // not the shortest form
  EXPECT_EQ(as_utf8("\xed\xa0\x80"), "\\xED\\xA0\\x80");           // a surrogate
  EXPECT_EQ(as_utf8("\xf4\x90\x80\x80"), "\\xF4\\x90\\x80\\x80");  // past U+10FFFF
  EXPECT_EQ(as_utf8("\xff"), "\\xFF");
  EXPECT_EQ(as_utf8("\xe2\x82"), "\\xE2\\x82");  // cut off
  EXPECT_EQ(as_utf8("\xe2\x82x"), "\\xE2\\x82x");
}

TEST(UntrustedText, TellsCodePoints) {
  std::string_view rest = "\xe2\x82\xac\xf0\x9f\x9a\x8c";
  EXPECT_EQ(take_code_point(rest), U'\u20AC');
  EXPECT_EQ(take_code_point(rest), U'\U0001F68C');
  EXPECT_TRUE(rest.empty());
}

RC_GTEST_PROP(UntrustedText, BecomesWhatAStrictReaderTakes, ()) {
  const std::string valid = as_utf8(*arbitrary_text());
  RC_ASSERT(as_utf8(valid) == valid);
  // nlohmann checks UTF-8 by its own automaton and throws for what is not valid.
  RC_ASSERT(nlohmann::json::parse(nlohmann::json(valid).dump()).get<std::string>() == valid);
}

}  // namespace
}  // namespace fieldproof::kernel
