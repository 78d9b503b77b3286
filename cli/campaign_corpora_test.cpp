// Subject: what the searches of a campaign leave for the next one, and how coverage grew in all of them.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSearches = R"({
  "title": "searches",
  "jobs": [
    { "verb": "fuzz", "of": "valve_bus/node", "iut": "plugin:NODE?in-process", "cases": 40, "seed": [1, 2, 3] },
    { "verb": "fuzz", "of": "valve_bus/node", "iut": "ref", "cases": 20 }
  ]
})";

std::string with_node(std::string text, const std::string& name = "NODE") {
  const std::size_t at = text.find(name);
  return text.replace(at, name.size(), COUNTING_NODE);
}

class CampaignOfSearches : public ProgramFixture {
 protected:
  Called campaign(std::vector<std::string> words) const {
    words.insert(words.begin(), "campaign");
    return call(std::move(words));
  }
};

TEST_F(CampaignOfSearches, LeavesOneCorpusWhateverTheNumberOfWorkers) {
  write("plan.json", with_node(kSearches));
  const Called one = campaign({"plan.json", "--workers", "1", "--out", "one"});
  EXPECT_EQ(one.exit_code, 0) << one.out << one.err;
  EXPECT_EQ(campaign({"plan.json", "--workers", "3", "--out", "three"}).exit_code, 0);
  EXPECT_EQ(read("one/campaign.json"), read("three/campaign.json"));
  const auto merged = read_all("one/corpus/valve_bus-node");
  EXPECT_EQ(merged, read_all("three/corpus/valve_bus-node"));
  const auto document = json("one/campaign.json");
  const auto& search = document["search"];
  EXPECT_EQ(search["counts"], (nlohmann::json{{"jobs", 4}, {"run", 140}, {"found", 0}}));
  ASSERT_EQ(search["corpora"].size(), 1U) << "the reference reports no coverage";
  const auto& all = search["corpora"][0];
  EXPECT_EQ(all["jobs"], (nlohmann::json{1, 2, 3}));
  EXPECT_EQ(all["sequences"], merged.size());
  EXPECT_EQ(all["growth"].back()["all"], 120);
  EXPECT_EQ(all["growth"].back()["run"], 40);
  // Together they pass what each has passed, and fewer sequences do.
  std::size_t of_jobs = 0;
  for (const std::string job : {"1", "2", "3"}) {
    EXPECT_GE(all["edges"], json("one/jobs/" + job + "/document.json")["edges"]);
    of_jobs += read_all("one/jobs/" + job + "/corpus").size();
  }
  EXPECT_GE(all["edges"], all["growth"].back()["edges"]);
  EXPECT_LT(merged.size(), of_jobs);
  EXPECT_HOLDS(one.out, "searches: 4, 140 sequences, 0 findings");
  EXPECT_HOLDS(one.out, " after 40 in each of 3 jobs; ");
  EXPECT_FALSE(fs::exists(folder_ / "one/merging"));
  expect_valid({"one/campaign.json"}, "../../campaign/campaign_result");
}

TEST_F(CampaignOfSearches, GoesOnFromTheCorpusOfAnother) {
  write("plan.json", with_node(kSearches));
  EXPECT_EQ(campaign({"plan.json", "--out", "first"}).exit_code, 0);
  const auto before = read_all("first/corpus/valve_bus-node");
  write("next.json",
        with_node(R"({"jobs": [{"verb": "fuzz", "of": "valve_bus/node", "iut": "plugin:NODE?in-process",
    "cases": 10, "seed": [4, 5], "corpus": "first/corpus/valve_bus-node"}]})"));
  const Called called = campaign({"next.json", "--out", "next"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  const auto document = json("next/campaign.json");
  EXPECT_EQ(document["jobs"][0]["search"]["stored"], before.size());
  EXPECT_GE(document["search"]["corpora"][0]["edges"],
            json("first/campaign.json")["search"]["corpora"][0]["edges"]);
  EXPECT_EQ(read_all("first/corpus/valve_bus-node"), before) << "it is read alone";
  // What a campaign began with must be there, and the same, when it goes on.
  write("first/corpus/valve_bus-node/" + before.begin()->first, "{}");
  EXPECT_HOLDS(campaign({"--resume", "next"}).err, "has changed since");
  write("no.json", R"({"jobs": [{"verb": "fuzz", "of": "valve_bus/node", "corpus": "nowhere"}]})");
  EXPECT_HOLDS(campaign({"no.json", "--dry-run"}).err, "nowhere: the folder of a corpus cannot be read");
}

// A journal that is gone on with has its corpora merged again, of what is still there.
TEST_F(CampaignOfSearches, LeavesOutWhatWasDamagedMeanwhile) {
  write("plan.json", with_node(kSearches));
  EXPECT_EQ(campaign({"plan.json", "--out", "whole"}).exit_code, 0);
  for (const auto& entry : fs::directory_iterator(folder_ / "whole/jobs/1/corpus"))
    std::ofstream(entry.path()) << "damaged";
  EXPECT_EQ(campaign({"--resume", "whole"}).exit_code, 0);
  EXPECT_GT(json("whole/campaign.json")["search"]["corpora"][0]["sequences"], 0);
}

TEST_F(CampaignOfSearches, OfTheExampleIsOneThatRuns) {
  std::ifstream file(kSourceFolder / "examples/campaigns/fuzz_1e9.json");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  ASSERT_NE(text.find("\"cases\": 100000,"), std::string::npos)
      << "10,000 jobs of 100,000 sequences are 10^9";
  text.replace(text.find(" 100000,"), 8, " 20,");
  write("fuzz_1e9.json", with_node(text, "./libnode.so"));
  const Called called = campaign({"fuzz_1e9.json", "--dry-run"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  EXPECT_HOLDS(called.out, "10000 jobs, about ");
}

}  // namespace
}  // namespace fieldproof::cli
