#include "reports/junit_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "harness/judge/arbitrary_result.hpp"
#include "harness/kernel/arbitrary_text.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/approved_text.hpp"
#include "reports/sample_run.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::reports {
namespace {

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<Element> children;

  std::vector<Element> all(const std::string& wanted) const {
    std::vector<Element> found;
    for (const Element& child : children) {
      if (child.name == wanted) found.push_back(child);
    }
    return found;
  }
  std::size_t number(const std::string& attribute) const { return std::stoul(attributes.at(attribute)); }
};

// A strict reader of the XML that needs no name space, comment or document type: anything else, any character
// that XML 1.0 forbids, and any tag that does not close gives nothing.
class StrictReader {
 public:
  explicit StrictReader(std::string_view text) : rest_(text) {}

  std::optional<Element> document() {
    if (!has_only_xml_chars(rest_) || !take("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"))
      return std::nullopt;
    auto root = element();
    skip_space();
    return rest_.empty() ? root : std::nullopt;
  }

 private:
  static bool has_only_xml_chars(std::string_view text) {
    while (!text.empty()) {
      const auto point = kernel::take_code_point(text);
      if (!point || *point == 0xFFFE || *point == 0xFFFF) return false;
      if (*point < 0x20 && *point != 9 && *point != 10 && *point != 13) return false;
    }
    return true;
  }

  bool take(std::string_view word) {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }

  void skip_space() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \n"), rest_.size())); }

  std::string word() {
    const std::size_t end = std::min(rest_.find_first_not_of("abcdefghijklmnopqrstuvwxyz-_"), rest_.size());
    const std::string taken(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return taken;
  }

  std::optional<std::string> attribute_value() {
    if (!take("=\"")) return std::nullopt;
    std::string value;
    while (!take("\"")) {
      if (rest_.empty() || rest_.front() == '<' || rest_.front() == '\n') return std::nullopt;
      if (take("&amp;")) {
        value += '&';
      } else if (take("&lt;")) {
        value += '<';
      } else if (take("&gt;")) {
        value += '>';
      } else if (take("&quot;")) {
        value += '"';
      } else if (take("&#10;")) {
        value += '\n';
      } else if (take("&#13;")) {
        value += '\r';
      } else if (take("&#9;")) {
        value += '\t';
      } else if (rest_.front() == '&') {
        return std::nullopt;
      } else {
        value += rest_.front();
        rest_.remove_prefix(1);
      }
    }
    return value;
  }

  std::optional<Element> element() {
    Element read;
    if (!take("<")) return std::nullopt;
    read.name = word();
    while (take(" ")) {
      const std::string name = word();
      const auto value = attribute_value();
      if (name.empty() || !value || !read.attributes.emplace(name, *value).second) return std::nullopt;
    }
    if (take("/>")) return read;
    if (read.name.empty() || !take(">") || !content(read)) return std::nullopt;
    return read;
  }

  bool content(Element& read) {
    for (;;) {
      skip_space();
      if (take("</" + read.name + ">")) return true;
      if (take("<![CDATA[")) {
        const std::size_t end = rest_.find("]]>");
        if (end == std::string_view::npos) return false;
        rest_.remove_prefix(end + 3);
        continue;
      }
      auto child = element();
      if (!child) return false;
      read.children.push_back(std::move(*child));
    }
  }

  std::string_view rest_;
};

std::string standing_of(const Element& test_case) {
  for (const char* outcome : {"failure", "error", "skipped"}) {
    if (!test_case.all(outcome).empty()) return outcome;
  }
  return "passed";
}

// What a CI server makes of the file: verdicts by unique name. Nothing when it would count wrongly.
std::optional<std::map<std::string, std::string>> consumed(const std::string& xml) {
  const auto root = StrictReader(xml).document();
  if (!root || root->name != "testsuites") return std::nullopt;
  std::map<std::string, std::string> verdicts;
  std::map<std::string, std::size_t> whole;
  for (const Element& suite : root->all("testsuite")) {
    std::map<std::string, std::size_t> counted;
    for (const Element& one : suite.all("testcase")) {
      const std::string standing = standing_of(one);
      ++counted[standing];
      ++whole[standing];
      const std::string name = one.attributes.at("classname") + "#" + one.attributes.at("name");
      if (!verdicts.emplace(name, standing).second) return std::nullopt;
    }
    if (suite.number("tests") != suite.all("testcase").size()) return std::nullopt;
    if (suite.number("failures") != counted["failure"] || suite.number("errors") != counted["error"] ||
        suite.number("skipped") != counted["skipped"]) {
      return std::nullopt;
    }
  }
  if (root->number("tests") != verdicts.size() || root->number("failures") != whole["failure"] ||
      root->number("errors") != whole["error"] || root->number("skipped") != whole["skipped"]) {
    return std::nullopt;
  }
  return verdicts;
}

AjvJudgement xmllint(const std::string& options, const std::string& xml) {
  const TemporaryFolder folder;
  write_text_file(folder.path() / "junit.xml", xml);
  AjvJudgement missing;
  missing.output = "XML is judged by xmllint, which is not installed; run script/setup";
  if (run_for_judgement("xmllint --version >/dev/null 2>&1").exit_code != 0) return missing;
  return run_for_judgement("xmllint --noout " + options + " " +
                           shell_word((folder.path() / "junit.xml").string()) + " 2>&1");
}

TEST(JunitWriter, WritesTheApprovedDocument) {
  expect_approved("junit.xml", junit_xml(sample_run(), sample_manifest()));
}

TEST(JunitWriter, IsValidAgainstTheSchema) {
  const auto schema = std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "reports" / "schema" / "junit.xsd";
  for (const reports::Run& run : {sample_run(), reports::Run{}}) {
    const AjvJudgement judgement =
        xmllint("--schema " + shell_word(schema.string()), junit_xml(run, sample_manifest()));
    if (!judgement.is_available) GTEST_SKIP() << judgement.output;
    EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
  }
}

TEST(JunitWriter, GivesAConsumerTheRightVerdicts) {
  const auto verdicts = consumed(junit_xml(sample_run(), sample_manifest()));
  ASSERT_TRUE(verdicts);
  EXPECT_EQ(*verdicts,
            (std::map<std::string, std::string>{{"interbus.slave.data_cycle#loopback_returns", "passed"},
                                                {"interbus.slave.data_cycle#outputs_are_kept", "failure"},
                                                {"interbus.slave.id_cycle#code_is_told", "passed"},
                                                {"interbus.slave.id_cycle#length_is_told", "error"},
                                                {"interbus.master.stop#bus_is_left", "error"},
                                                {"interbus.master.stop#branch_is_left", "skipped"},
                                                {"interbus.master.stop#none", "error"},
                                                {"fieldproof.run#is_complete", "error"}}));
}

TEST(JunitWriter, HasNoCaseMoreForACompleteRun) {
  reports::Run run = sample_run();
  run.identity.incomplete_because.clear();
  const auto verdicts = consumed(junit_xml(run, sample_manifest()));
  ASSERT_TRUE(verdicts);
  EXPECT_EQ(verdicts->size(), run.cases.size());
  EXPECT_FALSE(verdicts->contains("fieldproof.run#is_complete"));
}

TEST(JunitWriter, FailsAWarnWhenItIsStrict) {
  const auto verdicts = consumed(junit_xml(sample_run(), sample_manifest(), {InconclusiveAs::failure, true}));
  ASSERT_TRUE(verdicts);
  EXPECT_EQ(verdicts->at("interbus.slave.id_cycle#code_is_told"), "failure");
  EXPECT_EQ(verdicts->at("fieldproof.run#is_complete"), "failure");
}

TEST(JunitWriter, InconclusiveIsWhatTheOptionSaysAndNeverAPass) {
  const std::map<InconclusiveAs, std::string> meanings = {{InconclusiveAs::error, "error"},
                                                          {InconclusiveAs::failure, "failure"},
                                                          {InconclusiveAs::skipped, "skipped"}};
  for (const auto& [option, meaning] : meanings) {
    const auto verdicts = consumed(junit_xml(sample_run(), sample_manifest(), {option}));
    ASSERT_TRUE(verdicts);
    EXPECT_EQ(verdicts->at("interbus.slave.id_cycle#length_is_told"), meaning);
    EXPECT_EQ(verdicts->at("fieldproof.run#is_complete"), meaning);
  }
}

TEST(JunitWriter, TellsTheProperties) {
  const auto root = StrictReader(junit_xml(sample_run(), sample_manifest())).document();
  ASSERT_TRUE(root);
  std::map<std::string, std::string> properties;
  const Element failure = root->all("testsuite").at(0).all("testcase").at(1);
  const Element listed = failure.all("properties").at(0);
  for (const Element& one : listed.children) {
    properties[one.attributes.at("name")] = one.attributes.at("value");
  }
  EXPECT_EQ(properties.at("purpose"), "IS-14");
  EXPECT_EQ(properties.at("standing"), "own, unverified");
  EXPECT_EQ(properties.at("seed"), "11");
  EXPECT_EQ(properties.at("repro"),
            "fieldproof run interbus/slave/data_cycle/outputs_are_kept --seed 7 --iut "
            "slave@3=mutant:accepts_bad_check");
  EXPECT_EQ(properties.at("virtual_time"), "814.800 us");
  EXPECT_EQ(properties.at("wall_time"), "1250 us");
  EXPECT_EQ(properties.at("fingerprint"), "0123456789abcdef");
  EXPECT_FALSE(properties.at("requirement").empty());
}

TEST(JunitFiles, AreOneWhereOneIsEnough) {
  const auto files = junit_files(sample_run(), sample_manifest());
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files.front(), junit_xml(sample_run(), sample_manifest()));
  EXPECT_EQ(junit_files(reports::Run{}, sample_manifest()).size(), 1U);
}

// Each is whole, none is larger than it may be, and together they are the run.
TEST(JunitFiles, StayWithinTheirLimits) {
  reports::Run run = sample_run();
  run.cases.clear();
  for (int n = 0; n < 300; ++n) {
    run.cases.push_back(sample_failure());
    run.cases.back().id += "_" + std::to_string(n);
  }
  for (const JunitLimits limits : {JunitLimits{50'000, 2'000, 1'000}, JunitLimits{10'000'000, 7, 1'000}}) {
    const auto files = junit_files(run, sample_manifest(), {}, limits);
    EXPECT_GT(files.size(), 5U);
    std::map<std::string, std::string> all;
    for (const std::string& file : files) {
      EXPECT_LE(file.size(), limits.octets + 1'000);
      auto verdicts = consumed(file);
      ASSERT_TRUE(verdicts);
      EXPECT_LE(verdicts->size(), limits.cases);
      all.merge(*verdicts);
      EXPECT_TRUE(verdicts->empty());  // none is in two files
    }
    EXPECT_EQ(all.size(), 301U);
  }
}

TEST(JunitFiles, KeepBothEndsOfALongText) {
  reports::Run run = sample_run();
  run.cases = {sample_failure()};
  run.cases[0].log = "first" + std::string(1'000'000, 'x') + "last";
  run.cases[0].findings[0].actual = std::string(1'000'000, 'y');
  const auto files = junit_files(run, sample_manifest());
  ASSERT_EQ(files.size(), 1U);
  EXPECT_TRUE(consumed(files[0]));
  EXPECT_LT(files[0].size(), 250'000U);
  EXPECT_NE(files[0].find("CDATA[first"), std::string::npos);
  EXPECT_NE(files[0].find("last]]>"), std::string::npos);
  EXPECT_NE(files[0].find("octets are left out"), std::string::npos);
}

// A server keeps the first of two tests of one name.
TEST(JunitWriter, NamesAreUniqueWhateverTheIdsAre) {
  reports::Run run = sample_run();
  run.cases.clear();
  for (const char* id : {"a/b/c", "a.b/c", "a/b.c", "a/b/c (2)", "c", "fieldproof/run/is_complete"}) {
    run.cases.push_back(sample_case(id, judge::Verdict::pass));
  }
  const auto verdicts = consumed(junit_xml(run, sample_manifest()));
  ASSERT_TRUE(verdicts);
  EXPECT_EQ(verdicts->size(), run.cases.size() + 1);
}

std::vector<judge::CaseResult> distinct(std::vector<judge::CaseResult> cases) {
  for (std::size_t i = 0; i < cases.size(); ++i) cases.at(i).id += "/case_" + std::to_string(i);
  return cases;
}

RC_GTEST_PROP(JunitWriter, IsWellFormedForAnyText, ()) {
  reports::Run run = sample_run();
  run.identity.reproduce_options = *kernel::arbitrary_text();
  run.cases = distinct(
      *rc::gen::scale(0.3, rc::gen::container<std::vector<judge::CaseResult>>(judge::arbitrary_result())));
  const auto verdicts = consumed(junit_xml(run, sample_manifest()));
  RC_ASSERT(verdicts.has_value());
  RC_ASSERT(verdicts->size() == run.cases.size() + 1);  // and that it is incomplete
}

TEST(JunitWriter, IsWellFormedForXmllintWithArbitraryText) {
  reports::Run run = sample_run();
  const auto cases = rc::gen::container<std::vector<judge::CaseResult>>(200, judge::arbitrary_result());
  run.cases = distinct(cases(rc::Random(20240611), 30).value());
  const AjvJudgement judgement = xmllint("--huge", junit_xml(run, sample_manifest()));
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
}

}  // namespace
}  // namespace fieldproof::reports
