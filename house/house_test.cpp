// Subject: the whole tree. Every rule of the house is asked about the project as it lies on the disk.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "house/rules.hpp"
#include "house/source_tree.hpp"

namespace fieldproof::house {
namespace {

struct Rule {
  const char* name;
  Complaints (*check)(const std::vector<File>&);
};

void PrintTo(const Rule& rule, std::ostream* out) {
  *out << rule.name;
}

class House : public testing::TestWithParam<Rule> {
 protected:
  static const std::vector<File>& tree() {
    static const std::vector<File> files = read_tree(FIELDPROOF_SOURCE_DIR);
    return files;
  }
};

TEST_P(House, Keeps) {
  ASSERT_GT(tree().size(), 20U) << "the tree was not found at " << FIELDPROOF_SOURCE_DIR;
  const Complaints complaints = GetParam().check(tree());
  EXPECT_TRUE(complaints.empty()) << to_text(complaints);
}

INSTANTIATE_TEST_SUITE_P(
    Rules, House,
    testing::Values(Rule{"IncludeDirections", check_include_directions},
                    Rule{"IncludePaths", check_include_paths},
                    Rule{"HeadersOpenOnce", check_headers_open_once}, Rule{"Names", check_names},
                    Rule{"NoUmbrellaHeaders", check_umbrella_headers}, Rule{"Namespaces", check_namespaces},
                    Rule{"HiddenNames", check_hidden_names}, Rule{"Determinism", check_determinism},
                    Rule{"DeterminismExceptions", check_determinism_exceptions},
                    Rule{"LineLengths", check_line_lengths}, Rule{"TestSubjects", check_test_subjects},
                    Rule{"ReadmeHeadings", check_readme_headings},
                    Rule{"ForbiddenWords", check_forbidden_words}),
    [](const auto& rule) { return std::string(rule.param.name); });

// It has a root and a namespace of its own, and does not say where this tree lies.
TEST(OwnProject, KeepsWhatIsNoMatterOfPlaces) {
  const std::vector<File> files = read_tree(FIELDPROOF_SOURCE_DIR "/examples/own_project");
  ASSERT_GT(files.size(), 5U);
  for (const auto check : {check_headers_open_once, check_names, check_umbrella_headers, check_line_lengths,
                           check_forbidden_words}) {
    const Complaints complaints = check(files);
    EXPECT_TRUE(complaints.empty()) << to_text(complaints);
  }
}

}  // namespace
}  // namespace fieldproof::house
