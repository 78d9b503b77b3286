#include "house/source_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace fieldproof::house {
namespace {

TEST(CodeOf, BlanksCommentsAndLiteralsButKeepsColumns) {
  EXPECT_EQ(code_of("int a; // b\nint c;"), "int a;     \nint c;");
  EXPECT_EQ(code_of("a /* b\nc */ d"), "a     \n     d");
  EXPECT_EQ(code_of("f(\"x\\\"y\", 'z');"), "f(      ,    );");
  EXPECT_EQ(code_of("f(R\"x(a\"b)x\", 1);"), "f(R         , 1);");
}

TEST(CodeOf, DigitSeparatorsAreNoLiterals) {
  EXPECT_EQ(code_of("int a = 1'000'000; b"), "int a = 1'000'000; b");
}

TEST(IncludesOf, TellsQuotesBracketsAndLines) {
  const std::vector<Include> includes =
      includes_of({"x.cpp", "#include <a>\n\n#  include \"b/c.hpp\"  // why\n"});
  ASSERT_EQ(includes.size(), 2U);
  EXPECT_EQ(includes[0].target, "a");
  EXPECT_FALSE(includes[0].is_quoted);
  EXPECT_EQ(includes[1].target, "b/c.hpp");
  EXPECT_EQ(includes[1].line, 3);
  EXPECT_TRUE(includes[1].is_quoted);
}

TEST(Paths, AreTakenApart) {
  EXPECT_EQ(folder_of("harness/line/crc.hpp"), "harness/line");
  EXPECT_EQ(folder_of("README.md"), "");
  EXPECT_EQ(stem_of("harness/line/crc_test.cpp"), "crc_test");
  EXPECT_EQ(stem_of("a/.clang-format"), ".clang-format");
}

TEST(ReadTree, FindsThisFileAndIsSorted) {
  const std::vector<File> files = read_tree(FIELDPROOF_SOURCE_DIR);
  const auto has = [&](const char* path) {
    return std::any_of(files.begin(), files.end(), [&](const File& file) { return file.path == path; });
  };
  EXPECT_TRUE(has("house/source_tree_test.cpp"));
  EXPECT_TRUE(has("CMakeLists.txt"));
  EXPECT_TRUE(std::is_sorted(files.begin(), files.end(),
                             [](const File& a, const File& b) { return a.path < b.path; }));
}

}  // namespace
}  // namespace fieldproof::house
