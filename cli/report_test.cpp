#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

class ReportVerb : public ProgramFixture {
 protected:
  // A run with failures, stored in `out`.
  Called run(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"run",      "interbus/slave/frame_check/**",
                                          "--volume", "quick",
                                          "--iut",    "slave@1=mutant:latches_in_spite_of_own_error",
                                          "--out",    out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(std::move(arguments));
  }

  Called residual() const {
    return call(
        {"residual", "--fcs", "CRC-8/SMBUS", "--bits", "40", "--samples", "1000", "--json", "residual.json"});
  }

  nlohmann::json data_of(const std::string& page) const {
    const std::string html = read(page);
    const std::string open = R"(<script type="application/json" id="data">)";
    const std::size_t begin = html.find(open) + open.size();
    return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
  }
};

TEST_F(ReportVerb, EveryRunHasThePageThatTheVerbWrites) {
  EXPECT_EQ(run("a", {"--html", "copy.html"}).exit_code, 1);
  const std::string page = read("a/report.html");
  ASSERT_FALSE(page.empty());
  EXPECT_EQ(read("copy.html"), page);
  const Called made = call({"report", "a", "--html", "again.html"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(read("again.html"), page);
  const nlohmann::json data = data_of("copy.html");
  const nlohmann::json& results = data["runs"][0]["results"];
  EXPECT_EQ(results["counts"], nlohmann::json::parse(read("a/results.json"))["counts"]);
  for (const auto& one : results["cases"]) {
    EXPECT_FALSE(data["catalogue"]["stories"][one["id"].get<std::string>()]["stimulus"].empty()) << one["id"];
  }
}

TEST_F(ReportVerb, TakesTheDocumentOfSequencesAgainstMutants) {
  const Called made = call({"matrix", "valve_bus/node", "--sequences", "--seeds", "1", "--commands", "20",
                            "--json", "detection.json"});
  ASSERT_TRUE(fs::exists(folder_ / "detection.json")) << made.err;
  const Called called = call({"report", "detection.json", "--html", "report.html"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.out, "random sequences find a mutant in ");
  const nlohmann::json data = data_of("report.html");
  EXPECT_EQ(data["documents"][0]["content"]["roles"][0]["role"], "valve_bus/node");
}

TEST_F(ReportVerb, JoinsRunsAndDocuments) {
  run("a");
  run("b", {"--seed", "2"});
  EXPECT_EQ(residual().exit_code, 0);
  const Called made = call({"report", "a", "residual.json", "b", "--html", "new/joined.html"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const nlohmann::json data = data_of("new/joined.html");
  ASSERT_EQ(data["runs"].size(), 2U);
  EXPECT_EQ(data["runs"][0]["name"], "a");
  EXPECT_EQ(data["runs"][1]["results"]["run"]["seed"], "2");
  ASSERT_EQ(data["documents"].size(), 1U);
  EXPECT_EQ(data["documents"][0]["content"]["frame_check"], "CRC-8/SMBUS");
}

// The page and the terminal say the same, and the worst of all, whatever is named first.
TEST_F(ReportVerb, SaysTheWorstOfAllThatIsOnThePage) {
  EXPECT_EQ(call({"run", "interbus/slave/frame_check/**", "--volume", "quick", "--out", "good"}).exit_code,
            0);
  run("bad");
  const Called made = call({"report", "good", "bad", "--html", "r.html"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const nlohmann::json joined = data_of("r.html")["joined"];
  EXPECT_EQ(joined["verdict"], "fail");
  EXPECT_EQ(made.out.find("fail: " + joined["sentence"].get<std::string>() + "\n"), 0U) << made.out;
  EXPECT_NE(made.out.find("2 runs: 1 failed ("), std::string::npos) << made.out;
  EXPECT_NE(made.out.find("\n  pass          good: all "), std::string::npos) << made.out;
}

TEST_F(ReportVerb, HasACoverWhenAskedForOne) {
  run("a");
  EXPECT_EQ(call({"report", "a", "--html", "r.html"}).exit_code, 0);
  EXPECT_FALSE(data_of("r.html").contains("cover"));
  EXPECT_EQ(call({"report", "a", "--html", "r.html", "--title", "Type test", "--device", "<b>S-7</b>",
                  "--customer", "a customer", "--note", "</script>"})
                .exit_code,
            0);
  EXPECT_EQ(data_of("r.html")["cover"], (nlohmann::json{{"title", "Type test"},
                                                        {"device", "<b>S-7</b>"},
                                                        {"customer", "a customer"},
                                                        {"note", "</script>"}}));
  EXPECT_EQ(read("r.html").find("<b>S-7"), std::string::npos);
}

// Each document says how it was made, and the command makes it again.
TEST_F(ReportVerb, ADocumentHoldsItsCommand) {
  residual();
  const std::string first = read("residual.json");
  std::istringstream words(nlohmann::json::parse(first).at("command").get<std::string>());
  std::vector<std::string> arguments;
  for (std::string word; words >> word;) arguments.push_back(word);
  ASSERT_EQ(arguments.at(0), "fieldproof");
  arguments.erase(arguments.begin());
  arguments.insert(arguments.end(), {"--json", "again.json"});
  EXPECT_EQ(call(arguments).exit_code, 0);
  EXPECT_EQ(read("again.json"), first);
}

// The date is that of the environment, and one that is none is refused before anything is done.
TEST_F(ReportVerb, ADocumentHoldsItsDate) {
  Call residual = prepared(
      {"residual", "--fcs", "CRC-8/SMBUS", "--bits", "40", "--samples", "1000", "--json", "dated.json"});
  residual.environment["SOURCE_DATE_EPOCH"] = "86400";
  EXPECT_EQ(residual.run().exit_code, 0);
  EXPECT_EQ(json("dated.json").at("made").at("date"), "1970-01-02T00:00:00Z");
  for (const char* wrong : {"yesterday", "-1", "1.5", "99999999999999"}) {
    residual.environment["SOURCE_DATE_EPOCH"] = wrong;
    const Called refused = residual.run();
    EXPECT_EQ(refused.exit_code, 64) << wrong;
    EXPECT_HOLDS(refused.err, "no number of seconds since 1970");
    EXPECT_EQ(refused.out, "");
  }
}

// A campaign by its file or by its folder, beside the fit of a laboratory's counts.
// With what was tested: a later one can be told from it.
TEST_F(ReportVerb, ARunAndADocumentHoldTheHashesOfTheirFiles) {
  const auto inputs_of = [&](const std::string& file) {
    const nlohmann::json json = nlohmann::json::parse(read(file));
    std::map<std::string, std::string> inputs;
    for (const auto& one : json.contains("run") ? json["run"]["inputs"] : json["inputs"])
      inputs[one["path"]] = one["hash"];
    return inputs;
  };
  const std::string none = R"({"rules": []})";
  write("plan.json", none);
  const std::vector<std::string> words = {"run",      "valve_bus/node/read/is_answered",
                                          "--volume", "quick",
                                          "--faults", "plan.json",
                                          "--iut",    "exec:sh ./node.sh"};
  std::map<std::string, std::string> before;
  const std::string node = fmt::format("exec '{}' station valve_bus/node", FIELDPROOF_EXE);
  for (const std::string& script : {node + "\n", node + " ref\n"}) {
    write("node.sh", script);
    std::vector<std::string> arguments = words;
    const std::string out = fmt::format("run{}", before.size());
    arguments.insert(arguments.end(), {"--out", out});
    const Called ran = call(arguments);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    const auto inputs = inputs_of(out + "/results.json");
    ASSERT_EQ(inputs.size(), 2U) << read(out + "/results.json");
    EXPECT_EQ(inputs.at("plan.json").size(), 16U);
    if (before.empty()) {
      before = inputs;
    } else {
      EXPECT_NE(inputs.at("./node.sh"), before.at("./node.sh"));
    }
    EXPECT_EQ(inputs.at("plan.json"), before.at("plan.json"));
  }
  const Called called = call({"emc", "valve_bus", "--duration", "1s", "--test-levels", "1", "--iut",
                              "node@1=exec:sh ./node.sh", "--json", "emc.json"});
  EXPECT_LE(called.exit_code, 1) << called.err;
  write("node.sh", node + " # a third one\n");
  const Called resumed = call({"run", "--resume", "run2"});
  EXPECT_EQ(resumed.exit_code, 64);
  EXPECT_HOLDS(resumed.err, "./node.sh has changed since");
  const std::string counts = (kSourceFolder / "examples/burst_counts.csv").string();
  EXPECT_EQ(call({"emc", "interbus", "--fit", counts, "--bits", "182", "--json", "fit.json"}).exit_code, 0);
  EXPECT_EQ(inputs_of("fit.json").size(), 1U);
  const auto of_document = inputs_of("emc.json");
  ASSERT_EQ(of_document.size(), 1U);
  EXPECT_EQ(of_document.at("./node.sh").size(), 16U);
}

TEST_F(ReportVerb, ShowsCampaignsAndFits) {
  write("plan.json", R"({"title": "two seeds", "jobs": [{"verb": "run", "of": "interbus/slave/frame_check/**",
      "iut": "mutant:latches_in_spite_of_own_error", "volume": "quick", "seed": {"from": 1, "count": 2}}]})");
  EXPECT_EQ(call({"campaign", "plan.json", "--out", "nightly", "--workers", "1", "--quiet"}).exit_code, 1);
  write("counts.csv",
        "level_v,repetition,polarity,time_s,frames,frames_bad,undetected\n1000,5kHz,+,60,70000,400,0\n");
  EXPECT_EQ(call({"emc", "interbus", "--fit", "counts.csv", "--bits", "182", "--json", "fit.json"}).exit_code,
            2);
  EXPECT_NE(json("fit.json")["command"].get<std::string>().find("--fit counts.csv"), std::string::npos);
  for (const char* campaign : {"nightly", "nightly/campaign.json"}) {
    const Called made = call({"report", campaign, "fit.json", "--html", "r.html"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_NE(made.out.find("\n  fail          nightly/campaign.json: 2 of 2 jobs of a campaign failed\n"),
              std::string::npos)
        << made.out;
    EXPECT_NE(made.out.find("\n  inconclusive  fit.json: "), std::string::npos) << made.out;
    const nlohmann::json content = data_of("r.html")["documents"][0]["content"];
    ASSERT_EQ(content["rows"].size(), 1U);
    EXPECT_EQ(content["rows"][0]["jobs"], 2);
    ASSERT_EQ(content["findings"].size(), 2U);
    EXPECT_EQ(content["findings"][1]["command"], json("nightly/campaign.json")["jobs"][1]["command"]);
  }
}

TEST_F(ReportVerb, PutsTwoRunsSideBySide) {
  EXPECT_EQ(
      call({"run", "interbus/slave/frame_check/**", "--volume", "quick", "--record", "all", "--out", "good"})
          .exit_code,
      0);
  run("bad");
  const Called made = call({"report", "good", "bad", "--compare", "--html", "r.html"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.out.find("; since good: "), std::string::npos) << made.out;
  const nlohmann::json data = data_of("r.html");
  const nlohmann::json& failures = data["comparison"]["new_failures"];
  ASSERT_FALSE(failures.empty());
  for (const nlohmann::json& one : failures) {
    const auto id = one["id"].get<std::string>();
    for (const nlohmann::json& side : data["runs"]) EXPECT_TRUE(side["cases"][id].contains("timeline")) << id;
  }
  EXPECT_EQ(call({"report", "bad", "good", "--compare", "--html", "r.html"}).out.find("pass: "), 0U);
  EXPECT_EQ(call({"report", "good", "--compare", "--html", "r.html"}).exit_code, 64);
  EXPECT_EQ(call({"report", "good", "bad", "--compare"}).exit_code, 64);
}

TEST_F(ReportVerb, ShowsHowRunsWentOneAfterAnother) {
  EXPECT_EQ(
      call({"run", "interbus/slave/frame_check/**", "--volume", "quick", "--out", "nightly/1"}).exit_code, 0);
  run("nightly/2");
  fs::create_directories(folder_ / "nightly" / "damaged");
  write("nightly/damaged/results.json", "{");
  const Called told = call({"report", "--history", "nightly"});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_EQ(told.out.find("2 runs below nightly, the oldest first\n"), 0U) << told.out;
  EXPECT_NE(told.out.find("left out (1)\n  damaged: "), std::string::npos) << told.out;
  const Called made = call({"report", "--history", "nightly", "--last", "1", "--html", "r.html"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const nlohmann::json data = data_of("r.html");
  ASSERT_EQ(data["history"]["runs"].size(), 1U);
  EXPECT_EQ(data["history"]["counts"]["older"], 1);
  EXPECT_EQ(data["joined"]["verdict"], "fail");
}

// One table of formats: a stored run says the same as the run itself.
TEST_F(ReportVerb, WritesTheFormatsThatTheRunWrites) {
  std::vector<std::string> formats;
  for (const char* format : {"json", "junit", "sarif", "ctrf"})
    formats.insert(formats.end(), {std::string("--") + format, std::string("of_run.") + format});
  EXPECT_EQ(run("a", formats).exit_code, 1);
  for (std::string& word : formats)
    if (word.starts_with("of_run")) word.replace(0, 6, "new/again");
  formats.insert(formats.begin(), {"report", "a"});
  const Called made = call(formats);
  EXPECT_EQ(made.exit_code, 0) << made.err;
  for (const std::string format : {"json", "junit", "sarif", "ctrf"}) {
    EXPECT_FALSE(read("of_run." + format).empty()) << format;
    EXPECT_EQ(read("of_run." + format), read("new/again." + format)) << format;
  }
  EXPECT_EQ(read("of_run.json"), read("a/results.json"));
  EXPECT_EQ(read("of_run.junit"), read("a/junit.xml"));
  const auto flow =
      json("of_run.sarif")["runs"][0]["results"][0]["codeFlows"][0]["threadFlows"][0]["locations"];
  EXPECT_EQ(flow.back()["properties"]["kind"], "finding");
  EXPECT_EQ(flow.front()["properties"]["kind"], "step");
}

TEST_F(ReportVerb, GitHubGetsAnnotationsAndASummary) {
  run("a");
  write("summary.md", "before\n");
  Call report = prepared({"report", "a", "--github"});
  report.environment["GITHUB_STEP_SUMMARY"] = (folder_ / "summary.md").string();
  const Called made = report.run();
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_TRUE(made.out.starts_with("::error title=interbus/slave/frame_check/")) << made.out;
  EXPECT_TRUE(read("summary.md").starts_with("before\n### fieldproof: fail\n")) << read("summary.md");
  report.environment["GITHUB_STEP_SUMMARY"] = folder_.string();
  EXPECT_EQ(report.run().exit_code, 74);
}

TEST_F(ReportVerb, ARunTellsGitHubTheSame) {
  const Called ran = run("a", {"--github"});
  EXPECT_EQ(ran.exit_code, 1);
  const Called told = call({"report", "a", "--github"});
  EXPECT_TRUE(ran.out.ends_with(told.out)) << ran.out;
  EXPECT_EQ(run("b").out + told.out, ran.out) << "without the option nothing else is printed";
}

TEST_F(ReportVerb, RefusesWhatItCannotShow) {
  const auto expect_refusal = [&](std::vector<std::string> arguments, int code, const std::string& told) {
    const Called called = call(std::move(arguments));
    EXPECT_EQ(called.exit_code, code) << called.err;
    EXPECT_NE(called.err.find(told), std::string::npos) << called.err;
    EXPECT_FALSE(fs::exists(folder_ / "r.html"));
  };
  run("a");
  residual();
  write("wrong.json", R"({"schema": "fieldproof/residual/1"})");
  write("other.json", R"({"schema": "fieldproof/diff/1"})");
  expect_refusal({"report", "a"}, 64, "--html");
  expect_refusal({"report", "--html", "r.html"}, 64, "");
  expect_refusal({"report", "none", "--html", "r.html"}, 65, "none");
  expect_refusal({"report", "--history", "none", "--html", "r.html"}, 65, "none: there is no such folder");
  expect_refusal({"report", "--history", "a/cases", "--html", "r.html"}, 65, "there is no run");
  expect_refusal({"report", "a", "--last", "2", "--html", "r.html"}, 64, "--history");
  expect_refusal({"report", "a/cases", "--html", "r.html"}, 65, "manifest.json");
  expect_refusal({"report", "a", "wrong.json", "--html", "r.html"}, 65, "wrong.json:1");
  expect_refusal({"report", "a", "other.json", "--html", "r.html"}, 65, "fieldproof/emc/1");
  expect_refusal({"report", "a", "--html", "a"}, 74, "folder");
  expect_refusal({"report", "residual.json", "--junit", "r.html"}, 65, "residual.json");
  expect_refusal({"report", "a", "--sarif", "a"}, 74, "folder");
  expect_refusal({"report", "a", "--junit", "a.out", "--sarif", "a.out"}, 64, "--sarif name one file, a.out");
}

}  // namespace
}  // namespace fieldproof::cli
