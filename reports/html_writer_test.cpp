#include "reports/html_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/kernel/arbitrary_text.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/json_writer.hpp"
#include "reports/sample_page.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kOpen = R"(<script type="application/json" id="data">)";
constexpr std::string_view kClose = "</script>";

// What a browser takes for the text of the element with the data.
std::string data_of(const std::string& page) {
  const std::size_t begin = page.find(kOpen) + kOpen.size();
  return page.substr(begin, page.find(kClose, begin) - begin);
}

// What the page's script does first: what results share stands in each of them again.
Json unpacked(Json results) {
  const auto share = [&results](Json& part) {
    for (const char* key : {"purpose", "requirement", "reference"}) {
      if (part.contains(key)) part[key] = results.at("shared").at(part[key].get<std::size_t>());
    }
  };
  for (Json& result : results["cases"]) {
    share(result);
    for (const auto& [key, nothing] :
         {std::pair("reason", Json("")), std::pair("log", Json("")), std::pair("findings", Json::array()),
          std::pair("measurements", Json::array())}) {
      if (!result.contains(key)) result[key] = nothing;
    }
    for (Json& finding : result["findings"]) share(finding);
  }
  results.erase("shared");
  return results;
}

std::size_t occurrences(const std::string& text, std::string_view part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

PageContent page_with(const std::string& text) {
  PageContent content;
  content.runs.push_back({});
  PageRun& run = content.runs.back();
  run.name = text;
  run.stored.manifest = sample_manifest();
  run.stored.run = sample_run();
  run.stored.run.identity.implementations[0].uri = text;
  run.stored.run.identity.caveats = {text};
  run.stored.run.cases = {sample_failure()};
  run.stored.run.cases[0].log = text;
  run.stored.run.cases[0].findings[0].actual = text;
  return content;
}

TEST(HtmlWriter, HoldsEveryResultAsData) {
  const Json data = Json::parse(data_of(html_page(sample_page())));
  ASSERT_EQ(data.at("runs").size(), 1U);
  const Json& run = data["runs"][0];
  EXPECT_EQ(run["results"]["cases"].size(), 100U);
  EXPECT_EQ(run["results"]["counts"]["not_run"], 2);
  EXPECT_EQ(run["command"], "fieldproof run 'interbus/**' --seed 7 --iut slave@3=mutant:accepts_bad_check");
  const Json& failed = run["cases"]["interbus/slave/sample/case_3"];
  EXPECT_EQ(failed["timeline"]["transmissions"].size(), 40U);
  EXPECT_EQ(failed["folder"], "cases/interbus+slave+sample+case_3");
  EXPECT_EQ(run["wall_times_us"][0], 1250);
  EXPECT_EQ(data["documents"].size(), 9U);
  EXPECT_EQ(data["catalogue"]["stories"]["interbus/slave/sample/case_3"]["expected"], "outputs stay");
}

// A result is what results.json says; what many share is written once.
TEST(HtmlWriter, PacksResultsWithoutLoss) {
  const PageContent content = sample_page();
  const Json results = Json::parse(page_data(content))["runs"][0]["results"];
  EXPECT_EQ(unpacked(results), Json::parse(results_json(content.runs[0].stored.run)));
  EXPECT_LT(results["shared"].size(), 10U);
}

TEST(HtmlWriter, CommandsOfCasesAreForAShell) {
  const Json run = Json::parse(page_data(sample_page()))["runs"][0];
  EXPECT_EQ(run["case_command"], "fieldproof run @CASE@ --seed 7 --iut slave@3=mutant:accepts_bad_check");
  EXPECT_FALSE(run["cases"]["interbus/slave/sample/case_3"].contains("quoted"));
  EXPECT_EQ(run["cases"][kHostileName]["quoted"], shell_quoted(kHostileName));
}

TEST(HtmlWriter, HasStoriesOfItsCasesAndCountsOfTheRest) {
  PageContent content = sample_page();
  content.catalogue.stories["interbus/slave/not/here"] = {};
  const Json catalogue = Json::parse(page_data(content))["catalogue"];
  EXPECT_FALSE(catalogue["stories"].contains("interbus/slave/not/here"));
  EXPECT_EQ(
      catalogue["roles"]["interbus/slave"].get<std::size_t>(),
      Json::parse(page_data(sample_page()))["catalogue"]["roles"]["interbus/slave"].get<std::size_t>() + 1);
}

TEST(HtmlWriter, EqualContentsAreEqualBytes) {
  EXPECT_EQ(html_page(sample_page()), html_page(sample_page()));
}

TEST(HtmlWriter, NothingIsAskedForFromAnywhere) {
  const std::string page = html_page({});
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(occurrences(page, " src="), 0U);
  EXPECT_EQ(occurrences(page, "@import"), 0U);
  EXPECT_NE(page.find("Permission is hereby granted"), std::string::npos) << "the licence of uPlot";
}

TEST(HtmlWriter, TextNeverEndsItsElement) {
  const std::size_t scripts = occurrences(html_page({}), kClose);
  for (const std::string text : {"</script>", "</SCRIPT >", "<!--", "<!--<script>", "]]>", "\x01\x1b[31m\x7f",
                                 "\xff\xfe", "\xed\xa0\x80", "\xe2\x80\xa8", "\"\\", "-->"}) {
    const std::string page = html_page(page_with(text));
    EXPECT_EQ(occurrences(page, kClose), scripts) << text;
    const std::string data = data_of(page);
    EXPECT_EQ(data.find('<'), std::string::npos) << text;
    const Json run = Json::parse(data)["runs"][0];
    const std::string expected = kernel::as_utf8(text);
    EXPECT_EQ(run["name"], expected);
    EXPECT_EQ(run["results"]["cases"][0]["log"], expected);
    EXPECT_EQ(run["results"]["cases"][0]["findings"][0]["actual"], expected);
  }
}

RC_GTEST_PROP(HtmlWriter, AnyTextComesBackAsItWasMade, ()) {
  const std::string text = *kernel::arbitrary_text();
  const std::string data = page_data(page_with(text));
  RC_ASSERT(data.find('<') == std::string::npos);
  const Json run = Json::parse(data)["runs"][0];
  RC_ASSERT(unpacked(run["results"])["cases"][0]["log"] == kernel::as_utf8(text));
  RC_ASSERT(run["results"]["run"]["implementations"][0]["uri"] == kernel::as_utf8(text));
}

// As many time lines as fit are in the page, the first ones first; of the rest it says that they are left
// out.
TEST(HtmlWriter, BoundsItsTimeLines) {
  PageContent content = sample_page();
  PageRun& run = content.runs[0];
  const std::string id = run.stored.run.cases[10].id;
  Json longest = Json::parse(sample_timeline(id));
  const std::size_t rest = kMostTimelineOctets / 2;
  longest["faults"][0]["text"] = std::string(rest, 'x');
  run.timelines.clear();
  for (std::size_t n = 10; n < 13; ++n) run.timelines[run.stored.run.cases[n].id] = longest.dump();
  const Json cases = Json::parse(page_data(content))["runs"][0]["cases"];
  EXPECT_TRUE(cases[id].contains("timeline"));
  for (std::size_t n = 11; n < 13; ++n) {
    const Json& one = cases[run.stored.run.cases[n].id];
    EXPECT_FALSE(one.contains("timeline"));
    EXPECT_EQ(one.value("timeline_left_out", false), true);
  }
  run.timelines.erase(run.stored.run.cases[11].id);
  EXPECT_LT(html_page(content).size(), 5'000'000U);
}

}  // namespace
}  // namespace fieldproof::reports
