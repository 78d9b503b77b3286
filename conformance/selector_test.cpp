#include "conformance/selector.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

class SelectorFiles : public testing::Test {
 protected:
  SelectorFiles() : folder_(std::filesystem::path(testing::TempDir()) / "selectors") {
    std::filesystem::create_directories(folder_);
  }
  std::string write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = folder_ / name;
    std::ofstream(path) << text;
    return path.string();
  }
  std::filesystem::path folder_;
};

TEST(MatchesPath, StarStaysInsideOnePart) {
  EXPECT_TRUE(matches_path("interbus/*/data_cycle/x", "interbus/slave/data_cycle/x"));
  EXPECT_FALSE(matches_path("interbus/*/x", "interbus/slave/data_cycle/x"));
  EXPECT_TRUE(matches_path("interbus/slave/weight_*_is_*", "interbus/slave/weight_four_is_accepted"));
  EXPECT_FALSE(matches_path("interbus/slave/weight_*_is", "interbus/slave/weight_four_is_accepted"));
  EXPECT_TRUE(matches_path("a/?b", "a/xb"));
  EXPECT_FALSE(matches_path("a/?b", "a/b"));
}

TEST(MatchesPath, TwoStarsCrossPartsAndMayBeNone) {
  EXPECT_TRUE(matches_path("**", "interbus/slave/x"));
  EXPECT_TRUE(matches_path("interbus/**", "interbus/slave/data_cycle/x"));
  EXPECT_TRUE(matches_path("interbus/**/x", "interbus/x"));
  EXPECT_TRUE(matches_path("**/x/**/y", "a/x/b/c/y"));
  EXPECT_FALSE(matches_path("**/x/**/y", "a/b/c/y"));
  EXPECT_FALSE(matches_path("token_bus/**", "interbus/slave/x"));
}

TEST(MatchesPath, HostileGlobEndsSoon) {
  std::string glob;
  for (int i = 0; i < 200; ++i) glob += "*a";
  EXPECT_FALSE(matches_path(glob + "b", std::string(5000, 'a')));
}

TEST(ParseSelectors, KnowsTheFourForms) {
  const std::vector<std::string> texts = {"a/b", "a/**", "+must", "!+long"};
  const std::vector<Selector> selectors = parse_selectors(texts);
  ASSERT_EQ(selectors.size(), 4U);
  EXPECT_EQ(selectors[0].kind, Selector::Kind::exact);
  EXPECT_EQ(selectors[1].kind, Selector::Kind::glob);
  EXPECT_EQ(selectors[2].kind, Selector::Kind::tag);
  EXPECT_EQ(selectors[3].kind, Selector::Kind::tag);
  EXPECT_TRUE(selectors[3].is_exclusion);
  EXPECT_EQ(selectors[3].written(), "!+long");
}

TEST(ParseSelectors, RefusesAnEmptyOne) {
  const std::vector<std::string> texts = {"!"};
  EXPECT_THROW(parse_selectors(texts), kernel::Error);
}

TEST_F(SelectorFiles, HoldOneSelectorPerLineWithComments) {
  const std::string inner = write("inner.txt", "+must   # a tag\r\n");
  const std::string outer = write("outer.txt", "# all of it\n\n  a/**\n@" + inner + "\n");
  const std::vector<std::string> texts = {"@" + outer};
  const std::vector<Selector> selectors = parse_selectors(texts);
  ASSERT_EQ(selectors.size(), 2U);
  EXPECT_EQ(selectors[0].text, "a/**");
  EXPECT_EQ(selectors[0].place, outer + ":3");
  EXPECT_EQ(selectors[1].text, "must");
  EXPECT_EQ(selectors[1].place, inner + ":1");
}

TEST_F(SelectorFiles, ThatIncludeThemselvesAreRefusedWithTheirLine) {
  const std::string loop = write("loop.txt", "a\n@" + (folder_ / "loop.txt").string() + "\n");
  const std::vector<std::string> texts = {"@" + loop};
  try {
    parse_selectors(texts);
    FAIL() << "a selector file that includes itself was accepted";
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    EXPECT_NE(std::string(error.what()).find("loop.txt:2: "), std::string::npos) << error.what();
  }
}

TEST_F(SelectorFiles, WithoutASelectorAreRefused) {
  const std::string holds_empty = "@" + write("empty.txt", "");
  for (const std::string& text : {holds_empty, "@" + write("comments.txt", "# interbus/**\n\n  \n"),
                                  "@" + folder_.string(), "@" + write("outer.txt", holds_empty),
                                  std::string("@/dev/zero"), "@" + write("long.txt", std::string(4097, 'a')),
                                  "@" + write("large.txt", std::string((1 << 20) + 1, '\n'))}) {
    const std::vector<std::string> texts = {text};
    try {
      parse_selectors(texts);
      ADD_FAILURE() << text << " was accepted";
    } catch (const kernel::Error& error) {
      EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration) << text;
    }
  }
}

TEST_F(SelectorFiles, ThatDoNotExistAreNamed) {
  const std::vector<std::string> texts = {"@/nowhere/x.txt"};
  EXPECT_THROW(parse_selectors(texts), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::conformance
