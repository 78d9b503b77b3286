#include "campaign/distribution.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <memory>
#include <stop_token>
#include <utility>

#include "campaign/document.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "reports/approved_text.hpp"

namespace fieldproof::campaign {
namespace {

constexpr std::uint64_t kJobs = 16;
constexpr std::uint64_t kCrashes = 7;  // a job that always kills its process

Job job_of(std::uint64_t id) {
  Job job;
  job.id = id;
  job.verb = "emc";
  return job;
}

Manifest all_jobs() {
  Manifest manifest;
  manifest.jobs = kJobs;
  return manifest;
}

// What a job gives is a function of its id alone.
JobResult result_of(const Job& job) {
  JobResult result;
  result.id = job.id;
  if (job.id == kCrashes) {
    result.loss = "was ended by signal 6 (Aborted)";
    return result;
  }
  result.exit_code = job.id % 11 == 0 ? 1 : 0;
  if (job.id % 2 == 1) return result;
  result.files.push_back(
      {kDocument, R"({"schema": "fieldproof/emc/1", "unverified": ["a caveat"], "channels": [],
    "tests": [{"criterion": "B", "ledger": {"sent": 1000, "balance": {"data_differed": 10}, "wrong_cycles": )" +
                      std::to_string(job.id % 10 == 0 ? 1 : 0) + "}}]}"});
  return result;
}

// Gives results back in an order of chance, loses some, and is gone after so many looks.
class SlotsOfChance : public Slots {
 public:
  SlotsOfChance(std::uint64_t seed, std::size_t count, std::size_t looks)
      : random_(seed), count_(count), looks_(looks) {}

  std::size_t free() const override { return count_ - running_.size(); }
  void give(const Job& job) override {
    EXPECT_FALSE(std::ranges::count(running_, job.id, &Job::id)) << "given twice at once";
    running_.push_back(job);
  }
  std::vector<JobResult> wait(std::chrono::milliseconds) override {
    if (looks_-- == 0) {
      stop_.request_stop();
      return {};
    }
    std::vector<JobResult> ended;
    std::erase_if(running_, [&](const Job& job) {
      if (random_.between(0, 2) != 0) return false;
      ended.push_back(result_of(job));
      return true;
    });
    return ended;
  }
  void abandon() override { running_.clear(); }
  std::stop_token token() const { return stop_.get_token(); }

 private:
  kernel::Random random_;
  std::size_t count_;
  std::size_t looks_;
  std::vector<Job> running_;
  std::stop_source stop_;
};

// Each campaign has a folder of its own.
class Campaigned {
 public:
  explicit Campaigned(bool has_goal = false) : has_goal_(has_goal) {}

  // Whether it has come to its end.
  bool go_on(Slots& slots, std::stop_token stop) {
    confidence_ = Confidence({.rate = 0.0012, .confidence = 0.95, .is_of_differed = false}, kBound);
    Distribution::Plan plan;
    plan.count = kJobs;
    plan.job = [](std::uint64_t id) { return job_of(id); };
    if (has_goal_) plan.in_order = [this](const Outcome& outcome) { return confidence_.add(outcome); };
    plan.durability = judge::Durability::written;
    Distribution distribution(plan, folder_);
    distribution.run(slots, stop);
    Report report;
    report.planned = kJobs;
    report.outcomes = &distribution.outcomes();
    report.command = [](std::uint64_t id) { return "job " + std::to_string(id); };
    report.exit_code = worst_exit_code(distribution.outcomes());
    report.confidence = has_goal_ ? &confidence_ : nullptr;
    text_ = document_text(report);
    return distribution.is_complete();
  }
  bool go_on(SlotsOfChance&& slots) { return go_on(slots, slots.token()); }

  const std::string& text() const { return text_; }
  const Folder& folder() const { return folder_; }

 private:
  // The real one is exact; here any that falls with the total will do.
  inline static const UpperBound kBound = [](std::uint64_t wrong, std::uint64_t total, double) {
    return wrong == total ? 1.0 : static_cast<double>(wrong + 3) / static_cast<double>(total + 3);
  };

  bool has_goal_;
  reports::TemporaryFolder temporary_;
  Folder folder_ = Folder::create_at(temporary_.path() / "campaign", all_jobs(), "{}");
  Confidence confidence_{{}, kBound};
  std::string text_;
};

const std::string& undisturbed(bool has_goal) {
  static const auto made = [](bool with_goal) {
    Campaigned campaign(with_goal);
    EXPECT_TRUE(campaign.go_on(SlotsOfChance(1, 1, 10'000)));
    return campaign.text();
  };
  static const std::string without = made(false);
  static const std::string with = made(true);
  return has_goal ? with : without;
}

TEST(Distribution, MakesAJobThatKillsItsProcessThreeTimesAFindingAndGoesOn) {
  const std::string text = undisturbed(false);
  EXPECT_NE(text.find("\"killed\": \"was ended by signal 6 (Aborted)\""), std::string::npos);
  EXPECT_NE(text.find("\"jobs\": 16,"), std::string::npos);
  EXPECT_NE(text.find("\"killed\": 1,"), std::string::npos);
}

TEST(WorstExitCode, AJobThatJudgedNothingIsNotHiddenByOthersThatPass) {
  const auto worst_of = [](const std::vector<int>& codes) {
    std::map<std::uint64_t, Outcome> outcomes;
    for (const int code : codes) outcomes[outcomes.size()].exit_code = code;
    return worst_exit_code(outcomes);
  };
  EXPECT_EQ(worst_of({0, 4, 0}), 4);
  EXPECT_EQ(worst_of({4, 2, 0}), 2);
  EXPECT_EQ(worst_of({0, 0}), 0);
  EXPECT_EQ(worst_of({0, 5, 1}), 5);
  EXPECT_EQ(worst_of({0, 99}), 70) << "a code that no verb has";
}

TEST(Distribution, EndsWhereItIsDecided) {
  const std::string text = undisturbed(true);
  EXPECT_NE(text.find("\"decision\": \"below\""), std::string::npos) << text;
  EXPECT_EQ(text.find("\"id\": 9,"), std::string::npos);
}

// The bytes are those of an undisturbed campaign, whoever was faster, however often it was stopped.
RC_GTEST_PROP(DistributionProperty, BytesDoNotDependOnOrderSlotsOrStops, (bool has_goal)) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const auto slots = *rc::gen::inRange<std::size_t>(1, 9);
  const auto looks = *rc::gen::inRange<std::size_t>(1, 40);
  Campaigned campaign(has_goal);
  for (std::uint64_t call = 0; !campaign.go_on(SlotsOfChance(seed + call, slots, looks)); ++call)
    RC_ASSERT(call < 10'000U);
  RC_ASSERT(campaign.text() == undisturbed(has_goal));
}

// A journal that was cut off at any octet is gone on with to the same end.
RC_GTEST_PROP(DistributionProperty, TornJournalsAreGoneOnWith, ()) {
  Campaigned campaign;
  campaign.go_on(SlotsOfChance(*rc::gen::arbitrary<std::uint64_t>(), 3, 10'000));
  const auto size = std::filesystem::file_size(campaign.folder().journal());
  std::filesystem::resize_file(campaign.folder().journal(), *rc::gen::inRange<std::uintmax_t>(0, size));
  std::filesystem::remove_all(campaign.folder().path() /
                              "jobs");  // to write over them takes most of the time
  RC_ASSERT(campaign.go_on(SlotsOfChance(1, 3, 10'000)));
  RC_ASSERT(campaign.text() == undisturbed(false));
}

class SlotsThatCannot : public SlotsOfChance {
 public:
  using SlotsOfChance::SlotsOfChance;
  std::vector<JobResult> wait(std::chrono::milliseconds longest) override {
    auto ended = SlotsOfChance::wait(longest);
    for (JobResult& result : ended) {
      if (result.id != 5) continue;
      result.obstacle = "network.json: cannot be read";
      result.obstacle_code = 65;
    }
    return ended;
  }
};

TEST(Distribution, StopsWhereAPlaceCannotDoItsJobAndKeepsTheRest) {
  Campaigned campaign;
  SlotsThatCannot slots(3, 2, 10'000);
  try {
    campaign.go_on(slots, slots.token());
    FAIL() << "the obstacle was not told";
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    EXPECT_STREQ(error.what(), "job 5 cannot be done: network.json: cannot be read");
  }
  EXPECT_TRUE(campaign.go_on(SlotsOfChance(1, 2, 10'000)));
  EXPECT_EQ(campaign.text(), undisturbed(false));
}

TEST(Distribution, HasOneWriter) {
  Campaigned campaign;
  Distribution::Plan plan;
  plan.count = 1;
  const Distribution first(plan, campaign.folder());
  EXPECT_THROW(Distribution(plan, campaign.folder()), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::campaign
