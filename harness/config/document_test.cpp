#include "harness/config/document.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>

#include "harness/kernel/error.hpp"

namespace fieldproof::config {
namespace {

std::string parse_error(std::string text, const Limits& limits = {}) {
  try {
    const Document document = Document::parse(std::move(text), "x.json", limits);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    return error.what();
  }
  return "no error";
}

struct BadText {
  const char* name;
  std::string text;
  const char* begins;    // file, line, column and pointer
  const char* contains;  // what is wrong or what would be right
};

void PrintTo(const BadText& bad, std::ostream* out) {
  *out << bad.name;
}

class BadTexts : public testing::TestWithParam<BadText> {};

TEST_P(BadTexts, AreRefusedWithTheirPlace) {
  const std::string error = parse_error(GetParam().text);
  EXPECT_TRUE(error.starts_with(GetParam().begins)) << error;
  EXPECT_NE(error.find(GetParam().contains), std::string::npos) << error;
}

INSTANTIATE_TEST_SUITE_P(
    Syntax, BadTexts,
    testing::Values(
        BadText{"empty", "", "x.json:1:1: the top level: ", "unexpected end of input"},
        BadText{"only_space", " \n \n", "x.json:2:2: the top level: ", "unexpected end of input"},
        BadText{"only_comment", "// nothing\n", "x.json:1:11: the top level: ", "unexpected end of input"},
        BadText{"open_object", "{\n", "x.json:1:2: the top level: ", "expected string literal"},
        BadText{"open_array", "{\"a\":\n[1,\n", "x.json:2:4: /a/1: ", "unexpected end of input"},
        BadText{"missing_comma", "{\"a\": 1\n \"b\": 2}", "x.json:2:2: the top level: ", "expected '}'"},
        BadText{"missing_colon", "{\"a\" 1}", "x.json:1:6: /a: ", "expected ':'"},
        BadText{"missing_value", "{\n \"a\":\n}", "x.json:3:1: /a: ", "unexpected '}'"},
        BadText{"comma_too_many", "[1,\n,2]", "x.json:2:1: /1: ", "unexpected ','"},
        BadText{"comma_at_end", "[1,\n2,\n]", "x.json:3:1: /2: ", "unexpected ']'"},
        BadText{"wrong_bracket", "{\"a\": [1}\n}", "x.json:1:9: /a/1: ", "expected ']'"},
        BadText{"bad_literal", "{\"a\":\n  ture}", "x.json:2:3: /a: ", "invalid literal"},
        BadText{"not_a_number", "[\n\n NaN]", "x.json:3:2: /0: ", "invalid literal"},
        BadText{"leading_zero", "{\"a\": 01}", "x.json:1:8: the top level: ", "unexpected number"},
        BadText{"bare_fraction", "[.5]", "x.json:1:2: /0: ", "invalid literal"},
        BadText{"hexadecimal", "[0x1F]", "x.json:1:3: /1: ", "invalid literal"},
        BadText{"too_large_number", "[1,\n1e999]", "x.json:2:1: /1: ", "number overflow"},
        BadText{"single_quotes", "{'a': 1}", "x.json:1:2: the top level: ", "invalid literal"},
        BadText{"open_string", "{\"a\": \"bc\n}", "x.json:1:7: /a: ", "control character U+000A"},
        BadText{"bad_escape", "[\"\\q\"]", "x.json:1:2: /0: ", "forbidden character after backslash"},
        BadText{"half_surrogate", "[\"\\ud800\"]", "x.json:1:2: /0: ", "surrogate"},
        BadText{"open_comment", "{\"a\": 1, /* forever\n\n",
                "x.json:1:10: the top level: ", "missing closing '*/'"},
        BadText{"bad_comment", "[1, / 2]", "x.json:1:5: /1: ", "invalid comment"},
        BadText{"text_behind", "{}\n{}", "x.json:2:1: the top level: ", "expected end of input"},
        BadText{"bracket_behind", "[1] ]", "x.json:1:5: the top level: ", "expected end of input"}),
    [](const auto& row) { return std::string(row.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Strictness, BadTexts,
    testing::Values(BadText{"duplicate_key", "{\"s\": [{\n\"id\": 1,\n\"x\": 2,\n\"id\": 3}]}",
                            "x.json:4:1: /s/0: ", "key \"id\" is already on line 2"},
                    BadText{"duplicate_by_escape", "{\"a\": 1, \"\\u0061\": 2}",
                            "x.json:1:10: the top level: ", "key \"a\" is already on line 1"},
                    BadText{"nul_octet", std::string("{}\0[", 4), "x.json:1:3: ", "NUL"},
                    BadText{"bad_utf8", "{\n\"a\": \"\xFF\"}", "x.json:2:7: ", "0xFF is not valid UTF-8"},
                    BadText{"bad_utf8_in_comment", "// \xC3\n{}", "x.json:1:4: ", "0xC3 is not valid UTF-8"},
                    BadText{"overlong_utf8", "[\"\xC0\xAF\"]", "x.json:1:3: ", "not valid UTF-8"},
                    BadText{"overlong_three_octets", "[\"\xE0\x9F\xBF\"]", "x.json:1:3: ", "not valid UTF-8"},
                    BadText{"surrogate_utf8", "[\"\xED\xA0\x80\"]", "x.json:1:3: ", "not valid UTF-8"},
                    BadText{"above_unicode", "[\"\xF4\x90\x80\x80\"]", "x.json:1:3: ", "not valid UTF-8"},
                    BadText{"cut_character", "\"\xE2\x82", "x.json:1:2: ", "not valid UTF-8"},
                    BadText{"half_byte_order_mark", "\xEF\xBB{}", "x.json:1:1: ", "not valid UTF-8"}),
    [](const auto& row) { return std::string(row.param.name); });

TEST(Document, AcceptsCommentsAndAByteOrderMark) {
  const Document document =
      Document::parse("\xEF\xBB\xBF// first\n/* second /* \n **/ {\"a\": /**/ 7} // last", "x.json");
  read_object(document.root(), [](ObjectReader& o) {
    const Value a = o.required("a");
    EXPECT_EQ(a.as_integer(), 7);
    EXPECT_EQ(a.line(), 3U);
    EXPECT_EQ(a.column(), 17U);
  });
}

TEST(Document, AcceptsTheLimitAndRefusesOneMore) {
  const Limits small{.size = 10, .depth = 3};
  EXPECT_EQ(parse_error("[[[ 2 ]]]", small), "no error");
  EXPECT_EQ(parse_error("[[[  2 ]]]", small), "no error");
  EXPECT_NE(parse_error("[[[   2 ]]]", small).find("has 11 octets; at most 10"), std::string::npos);
  EXPECT_TRUE(parse_error("[{\"a\":[]}]", small).starts_with("no error"));
  const std::string deeper = parse_error("[\n[[\n[]]]]", small);
  EXPECT_TRUE(deeper.starts_with("x.json:3:1: /0/0/0: more than 3 objects and arrays")) << deeper;
}

TEST(Document, RefusesAMillionBracketsWithoutRecursion) {
  const std::string error = parse_error(std::string(1'000'000, '['));
  EXPECT_NE(error.find("more than 64 objects and arrays inside each other"), std::string::npos) << error;
}

TEST(Document, DeepDocumentsAreReadWithoutRecursionWhenAsked) {
  const std::size_t depth = 200'000;
  const Document document =
      Document::parse(std::string(depth, '[') + std::string(depth, ']'), "x.json", {.depth = depth});
  EXPECT_EQ(document.root().as_array(1, 1).size(), 1U);
}

TEST(Document, KeepsHostileNamesPrintable) {
  const std::string error = parse_error("{\"a\\u001b\": [" + std::string(5000, 'x') + "]}");
  EXPECT_EQ(parse_error("{\"\\u009b\\u202e\": 1, \"\\u009b\\u202e\": 2}").find_first_of("\xC2\xE2"),
            std::string::npos);
  EXPECT_NE(error.find("/a\\x1B/0"), std::string::npos) << error;
  EXPECT_LT(error.size(), 600U);
}

class Files : public testing::Test {
 protected:
  Files()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("fieldproof_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
                 std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Files() override { std::filesystem::remove_all(folder_); }

  std::string error_of_load(const std::filesystem::path& path, const Limits& limits = {}) {
    try {
      (void)Document::load(path, limits);
    } catch (const kernel::Error& error) {
      EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

TEST_F(Files, AreLoadedWithTheirPathAsName) {
  const auto path = folder_ / "good.json";
  std::ofstream(path) << "{\n\"a\": \"b\"}";
  const Document document = Document::load(path);
  EXPECT_EQ(document.name(), path.string());
  EXPECT_EQ(document.text(), "{\n\"a\": \"b\"}");
  EXPECT_EQ(document.root().as_members().at(0).value.as_string(), "b");
}

TEST_F(Files, ThatCannotBeReadSayWhy) {
  EXPECT_EQ(error_of_load(folder_ / "absent.json"),
            (folder_ / "absent.json").string() + ": the file cannot be read: No such file or directory");
  EXPECT_EQ(error_of_load(folder_),
            folder_.string() + ": the file cannot be read: it is a folder; name a file in it");
}

TEST_F(Files, ThatNeverEndOrNeverBeginAreRefused) {
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::filesystem::path& path : {std::filesystem::path("/dev/zero"), pipe}) {
    EXPECT_NE(error_of_load(path).find("no regular file"), std::string::npos) << path;
  }
}

TEST_F(Files, AreReadUpToTheirLimit) {
  const auto path = folder_ / "long.json";
  std::ofstream(path) << std::string(10, ' ');
  EXPECT_EQ(read_text(path, 10), std::string(10, ' '));
  EXPECT_NE(error_of_load(path, {.size = 9}).find("more than 9 octets"), std::string::npos);
}

}  // namespace
}  // namespace fieldproof::config
