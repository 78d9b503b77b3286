#include "reports/campaign_content.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "reports/sample_campaign.hpp"

namespace fieldproof::reports {
namespace {

using judge::Verdict;
using OrderedJson = nlohmann::ordered_json;

Said said_of(const OrderedJson& campaign) {
  return said_by_campaign(nlohmann::json::parse(campaign.dump()));
}

// All of whose jobs ended with 0 and criterion A.
OrderedJson good_campaign() {
  OrderedJson campaign = sample_campaign("title");
  campaign["counts"]["by_exit_code"] = {{"0", 26}};
  campaign["counts"]["by_headline"] = {{"A", 26}};
  return campaign;
}

TEST(CampaignContent, JobsThatDifferInTheSeedAreOneRow) {
  const OrderedJson content = campaign_content(sample_campaign("title"));
  EXPECT_FALSE(content.contains("jobs"));
  ASSERT_EQ(content["rows"].size(), 10U);
  const OrderedJson& row = content["rows"][1];
  EXPECT_EQ(row["command"],
            "fieldproof emc interbus --test-levels=3 --repetition=5kHz --polarity=- --duration=1s");
  EXPECT_EQ(row["jobs"], 3);
  EXPECT_EQ(row["ledger"]["sent"], 3000);
  EXPECT_EQ(row["ledger"]["detected"], 3 + 4 + 5);
  EXPECT_EQ(row["by_headline"]["A"], 3);
  EXPECT_EQ(content["rows"][8]["command"], "fieldproof run 'xtitle'");
}

TEST(CampaignContent, AFindingKeepsItsCommand) {
  const OrderedJson content = campaign_content(sample_campaign("title"));
  ASSERT_EQ(content["findings"].size(), 2U);
  EXPECT_EQ(content["findings"][0]["command"], "fieldproof run 'xtitle' --seed=1");
  EXPECT_EQ(content["findings"][0]["failed"][0], "title");
  EXPECT_EQ(content["findings"][1]["killed"], "got signal 9");
}

TEST(CampaignContent, IsBoundedAndCountsWhatItLeavesOut) {
  OrderedJson campaign = sample_campaign("title");
  OrderedJson job = {{"id", 1}, {"exit_code", 1}, {"failed", OrderedJson::array()}};
  for (int n = 0; n < 50; ++n) job["failed"].push_back(std::to_string(n));
  campaign["jobs"] = OrderedJson::array();
  for (int n = 0; n < 700; ++n) {
    job["command"] = fmt::format("fieldproof run case{} --seed=1", n);
    campaign["jobs"].push_back(job);
  }
  const OrderedJson content = campaign_content(campaign);
  EXPECT_EQ(content["rows"].size(), kMostCampaignRows);
  EXPECT_EQ(content["rows_left_out"], 700 - kMostCampaignRows);
  EXPECT_EQ(content["findings"].size(), kMostCampaignFindings);
  EXPECT_EQ(content["findings_left_out"], 700 - kMostCampaignFindings);
  EXPECT_EQ(content["findings"][0]["failed"].size(), 20U);
  EXPECT_EQ(content["findings"][0]["failed_left_out"], 30);
}

TEST(CampaignContent, TheWorstJobIsTheVerdict) {
  EXPECT_EQ(said_of(good_campaign()).verdict, Verdict::pass);
  EXPECT_EQ(said_of(good_campaign()).sentence, "all 26 jobs of a campaign ended well");
  OrderedJson campaign = good_campaign();
  for (const auto& [code, verdict] :
       {std::pair("4", Verdict::pass), std::pair("3", Verdict::warn), std::pair("2", Verdict::inconclusive),
        std::pair("1", Verdict::fail), std::pair("65", Verdict::error), std::pair("99", Verdict::error)}) {
    campaign["counts"]["by_exit_code"][code] = 2;
    EXPECT_EQ(said_of(campaign).verdict, verdict) << code;
  }
  EXPECT_EQ(said_of(campaign).sentence,
            "4 of 26 jobs of a campaign ended in an error, 2 failed, 2 could not be told, 2 ended otherwise "
            "than what is stored");
  campaign = good_campaign();
  campaign["counts"]["by_exit_code"] = {{"4", 26}};
  campaign["counts"]["by_headline"] = OrderedJson::object();
  EXPECT_EQ(said_of(campaign).verdict, Verdict::inconclusive) << "nothing was judged";
}

TEST(CampaignContent, CriteriaAndTheDecisionCountAsWell) {
  OrderedJson campaign = good_campaign();
  campaign["counts"]["by_headline"]["B"] = 1;
  EXPECT_EQ(said_of(campaign).verdict, Verdict::warn);
  EXPECT_EQ(said_of(campaign).sentence, "criterion B in 1 job of a campaign");
  campaign["counts"]["by_headline"]["C"] = 2;
  EXPECT_EQ(said_of(campaign).verdict, Verdict::fail);
  EXPECT_EQ(said_of(campaign).sentence, "criterion C in 2 jobs of a campaign");
  campaign = good_campaign();
  campaign["confidence"]["decision"] = "open";
  EXPECT_EQ(said_of(campaign).verdict, Verdict::inconclusive);
  campaign["confidence"]["decision"] = "above";
  EXPECT_EQ(said_of(campaign).verdict, Verdict::fail);
  EXPECT_EQ(said_of(campaign).sentence, "wrong words are accepted in more than 0.001 of the exchanges sent");
}

TEST(CampaignContent, WhatIsIncompleteIsNoPass) {
  OrderedJson campaign = good_campaign();
  campaign["is_complete"] = false;
  EXPECT_EQ(said_of(campaign).verdict, Verdict::inconclusive);
  EXPECT_EQ(said_of(campaign).sentence, "the campaign is incomplete: 26 of 30 jobs ended");
}

}  // namespace
}  // namespace fieldproof::reports
