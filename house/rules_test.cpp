#include "house/rules.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

// A canary per rule: a small tree that breaks it must be complained about, and its mended sister must not.

namespace fieldproof::house {
namespace {

std::vector<File> one(std::string path, std::string text) {
  return {{std::move(path), std::move(text)}};
}

TEST(IncludeDirections, LowerFoldersDoNotKnowHigherOnes) {
  EXPECT_EQ(
      check_include_directions(one("harness/line/x.cpp", "#include \"harness/segment/y.hpp\"\n")).size(), 1U);
  EXPECT_EQ(
      check_include_directions(one("harness/kernel/x.hpp", "\n#include \"harness/line/y.hpp\"\n")).at(0).line,
      2);
  EXPECT_EQ(check_include_directions(one("reports/x.cpp", "#include \"protocols/interbus/y.hpp\"\n")).size(),
            1U);
  EXPECT_EQ(check_include_directions(one("conformance/x.cpp", "#include \"emc/y.hpp\"\n")).size(), 1U);
  EXPECT_EQ(check_include_directions(one("fuzz/x_fuzz.cpp", "#include \"conformance/y.hpp\"\n")).size(), 1U);
  EXPECT_TRUE(
      check_include_directions(one("harness/segment/x.cpp", "#include \"harness/line/y.hpp\"\n")).empty());
  EXPECT_TRUE(
      check_include_directions(one("cli/x.cpp", "#include \"conformance/interbus/y.hpp\"\n")).empty());
}

TEST(IncludeDirections, ProtocolsDoNotKnowEachOther) {
  EXPECT_EQ(check_include_directions(one("protocols/a/x.cpp", "#include \"protocols/b/y.hpp\"\n")).size(),
            1U);
  EXPECT_TRUE(check_include_directions(one("protocols/a/x.cpp", "#include \"protocols/a/y.hpp\"\n")).empty());
}

TEST(IncludeDirections, AFolderWithoutARowIsComplainedAbout) {
  EXPECT_EQ(
      check_include_directions(one("harness/cellar/x.cpp", "#include \"harness/kernel/y.hpp\"\n")).size(),
      1U);
}

TEST(IncludePaths, StartAtTheRoot) {
  const File header{"harness/line/y.hpp", ""};
  EXPECT_EQ(check_include_paths({header, {"harness/line/x.cpp", "#include \"y.hpp\"\n"}}).size(), 1U);
  EXPECT_EQ(check_include_paths({header, {"harness/line/x.cpp", "#include \"../line/y.hpp\"\n"}}).size(), 1U);
  EXPECT_EQ(check_include_paths({header, {"harness/line/x.cpp", "#include <harness/line/y.hpp>\n"}}).size(),
            1U);
  EXPECT_TRUE(
      check_include_paths({header, {"harness/line/x.cpp", "#include \"harness/line/y.hpp\"\n"}}).empty());
}

TEST(IncludePaths, TheGeneratedHeaderNeedsASchema) {
  const File user{"reports/x.cpp", "#include \"reports/embedded_schemas.hpp\"\n"};
  EXPECT_EQ(check_include_paths({user}).size(), 1U);
  EXPECT_TRUE(check_include_paths({user, {"reports/schema/results.schema.json", "{}"}}).empty());
}

TEST(HeadersOpenOnce, ThePragmaComesBeforeAllCode) {
  EXPECT_EQ(check_headers_open_once(one("cli/x.hpp", "// it\nint x;\n")).size(), 1U);
  EXPECT_EQ(check_headers_open_once(one("cli/x.hpp", "#include <a>\n#pragma once\n")).size(), 1U);
  EXPECT_TRUE(check_headers_open_once(one("cli/x.hpp", "// it\n/* is */\n#pragma once\n")).empty());
}

TEST(Names, AreNouns) {
  EXPECT_EQ(check_names(one("harness/common/x.hpp", "")).size(), 1U);
  EXPECT_EQ(check_names(one("cli/run_manager.cpp", "")).size(), 1U);
  EXPECT_EQ(check_names(one("cli/string_utils_test.cpp", "")).size(), 1U);
  EXPECT_EQ(check_names(one("cli/RunVerb.cpp", "")).size(), 1U);
  EXPECT_TRUE(check_names(one("cli/baseline.cpp", "")).empty());
}

TEST(UmbrellaHeaders, OnlyIncludingIsNotEnough) {
  EXPECT_EQ(check_umbrella_headers(one("cli/x.hpp", "// all\n#pragma once\n#include \"cli/y.hpp\"\n")).size(),
            1U);
  EXPECT_TRUE(check_umbrella_headers(one("cli/x.hpp", "#pragma once\nnamespace a { struct X; }\n")).empty());
}

TEST(Namespaces, FollowTheFolder) {
  EXPECT_EQ(check_namespaces(one("harness/line/x.cpp", "namespace fieldproof::kernel {\n}\n")).size(), 1U);
  EXPECT_EQ(check_namespaces(one("harness/line/x.cpp", "namespace fieldproof::line::detail {\n}\n")).size(),
            1U);
  EXPECT_EQ(check_namespaces(one("harness/line/x.hpp", "#pragma once\nint x;\n")).size(), 1U);
  EXPECT_TRUE(check_namespaces(one("harness/line/x.hpp", "namespace fieldproof::line {\n}\n")).empty());
  EXPECT_TRUE(check_namespaces(one("conformance/interbus/x.cpp",
                                   "namespace fieldproof::conformance::seeded_faults {\n}\n"))
                  .empty());
  EXPECT_TRUE(
      check_namespaces(one("conformance/interbus/x.cpp", "namespace fieldproof::interbus {\n}\n")).empty());
  EXPECT_EQ(check_namespaces(one("conformance/interbus/x.cpp", "namespace fieldproof::kernel {\n}\n")).size(),
            1U);
  EXPECT_TRUE(check_namespaces(one("conformance/interbus/x.cpp", "namespace fieldproof::conformance {\n}\n"))
                  .empty());
  EXPECT_TRUE(
      check_namespaces(one("protocols/interbus/x.cpp", "namespace fieldproof::interbus {\n}\n")).empty());
}

TEST(Determinism, NoChanceAndNoClockOfTheMachine) {
  for (const char* code : {"std::uniform_int_distribution<int> d;", "std::unordered_map<int, int> m;",
                           "std::chrono::system_clock::now();", "std::chrono::steady_clock::now();",
                           "std::random_device r;", "std::shuffle(a, b, g);", "std::hash<int> h;"}) {
    EXPECT_EQ(check_determinism(one("harness/segment/x.cpp", code)).size(), 1U) << code;
    EXPECT_TRUE(check_determinism(one("cli/progress.cpp", code)).empty()) << code;
  }
}

TEST(Determinism, CommentsAndTextsMayNameThem) {
  EXPECT_TRUE(
      check_determinism(one("harness/line/x.cpp", "// no system_clock\nauto x = \"unordered_map\";\n"))
          .empty());
}

TEST(Determinism, AnExceptionThatNothingNeedsIsComplainedAbout) {
  EXPECT_FALSE(check_determinism_exceptions(one("harness/line/x.cpp", "int x;\n")).empty());
}

TEST(LineLengths, EndAtColumn110) {
  EXPECT_TRUE(check_line_lengths(one("cli/x.cpp", std::string(110, 'x') + "\n")).empty());
  EXPECT_EQ(check_line_lengths(one("cli/x.cpp", std::string(111, 'x') + "\n")).size(), 1U);
  EXPECT_TRUE(check_line_lengths(one("cli/x.cpp", std::string(109, 'x') + "\xC2\xB5\n")).empty());
}

TEST(LineLengths, TablesMayBeWider) {
  const std::string wide = std::string(111, 'x') + "\n";
  EXPECT_TRUE(check_line_lengths(one("cli/x.cpp", "// clang-format off\n" + wide)).empty());
  EXPECT_EQ(check_line_lengths(one("cli/x.cpp", "// clang-format off\n// clang-format on\n" + wide)).size(),
            1U);
}

TEST(TestSubjects, StandBesideOrAreTold) {
  EXPECT_EQ(check_test_subjects(one("cli/x_test.cpp", "#include <a>\n")).size(), 1U);
  EXPECT_TRUE(check_test_subjects(one("cli/x_test.cpp", "// Subject: the program as a whole.\n")).empty());
  EXPECT_TRUE(check_test_subjects({{"cli/x_test.cpp", ""}, {"cli/x.hpp", ""}}).empty());
}

TEST(ReadmeHeadings, AreCompleteAndInOrder) {
  const std::string good =
      "# Line\n\n## What it is\n\n## What it is not\n\n## How it works\n\n## Rules and sources\n\n"
      "## How it is checked\n\n## Known limits\n";
  EXPECT_TRUE(check_readme_headings(one("harness/README.md", good)).empty());
  EXPECT_TRUE(check_readme_headings(one("README.md", "# fieldproof\n")).empty());
  EXPECT_EQ(check_readme_headings(one("harness/README.md", "# Line\n\n## What it is\n")).size(), 5U);
}

TEST(ForbiddenWords, AreFoundInEveryFile) {
  // Put together here, so that this file may be searched for the words too.
  const std::vector<std::string> texts{
      std::string("// TO") + "DO later", std::string("a place") + "holder",
      std::string("good for ") + "now.", std::string("cd /") + "work/x",
      std::string("# /") + "tmp/x",      std::string("registry.npm") + "js.org",
      std::string("see issue") + " 12",  std::string("\"reso") + "lved\": \"x\""};
  for (const std::string& text : texts) {
    EXPECT_EQ(check_forbidden_words(one("cli/x.md", text)).size(), 1U) << text;
  }
  EXPECT_TRUE(check_forbidden_words(one("cli/x.md", "the network works; homework/x; a method")).empty());
}

TEST(ToText, NamesFileAndLine) {
  EXPECT_EQ(to_text({{"a/b.cpp", 3, "no."}}), "a/b.cpp:3: no.\n");
}

TEST(HiddenNames, AnUnnamedNamespaceRepeatsNoNameOfAHeader) {
  const auto complaints_of = [](const std::string& declaration, std::string_view name_space = "emc") {
    const File header{"emc/y.hpp",
                      "namespace fieldproof::emc {\ninline constexpr int kMost = 4;\n"
                      "NetworkDescription network_of(int n);\nstruct Row {\n  int member;\n};\n"
                      "template <class T>\nclass List {};\nusing Json = nlohmann::json;\n"
                      "std::span<const Row> table();\n}  // namespace fieldproof::emc\n"};
    const File source{"emc/x.cpp", "namespace fieldproof::" + std::string(name_space) +
                                       " {\nnamespace {\n\n" + declaration +
                                       "\n}  // namespace\n\nint kMost_outside = 0;\n}\n"};
    return check_hidden_names({header, source});
  };
  for (const char* declaration :
       {"constexpr int kMost = 5;", "NetworkDescription network_of(const std::string& name) {\n}",
        "struct Row {\n};", "class List final : public Base {\n};", "using Json = nlohmann::ordered_json;",
        "const std::vector<std::pair<int, Row>>& table() {\n}",
        "template <class Row>\nRow network_of(Row r) {\n}", "enum class Row : std::uint8_t { a };"}) {
    const Complaints complaints = complaints_of(declaration);
    ASSERT_EQ(complaints.size(), 1U) << declaration;
    EXPECT_GE(complaints.front().line, 4) << declaration;
    EXPECT_NE(complaints.front().sentence.find("emc/y.hpp"), std::string::npos);
    EXPECT_TRUE(complaints_of(declaration, "cli").empty()) << declaration;
  }
  for (const char* other : {"constexpr int kMore = 5;", "using enum Row;", "int member = 0;", "  Row row;",
                            "// struct Row {", "void f() {\n  const int kMost = 3;\n}"}) {
    EXPECT_TRUE(complaints_of(other).empty()) << other;
  }
}

TEST(HiddenNames, ANamespaceEndsWithItsBraceWhateverStandsBehindIt) {
  const File header{
      "emc/y.hpp",
      "namespace fieldproof::emc {\nnamespace inner {\nint size();\n}\n[[noreturn]] int count();\n}\n"};
  const auto complaints_of = [&](const std::string& text) {
    return check_hidden_names({header, {"emc/y.cpp", "namespace fieldproof::emc {\n" + text + "}\n"}}).size();
  };
  EXPECT_EQ(complaints_of("namespace {\nint f() {\n}\n}  // namespace\nint count() {\n}\n"), 0U);
  EXPECT_EQ(complaints_of("namespace {\nconstexpr int kOne = 1;\n}\n\nint count() {\n}\n"), 0U);
  EXPECT_EQ(complaints_of("namespace {\nint f() {\n}\nint count() {\n}\n}\n"), 1U);
  EXPECT_EQ(complaints_of("namespace {\nint size() {\n}\n}\n"), 0U) << "the header's is an inner one";
  EXPECT_EQ(complaints_of("namespace {\nnamespace inner {\nint size() {\n}\n}\n}\n"), 1U);
  EXPECT_EQ(complaints_of("namespace {\n[[nodiscard]] int count() {\n}\n}\n"), 1U);
  EXPECT_EQ(complaints_of("namespace {\nconst std::vector<int> count =\n    table();\n}\n"), 1U);
  EXPECT_EQ(complaints_of("namespace {\nenum struct count { a };\n}\n"), 1U);
}

}  // namespace
}  // namespace fieldproof::house
