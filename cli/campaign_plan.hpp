// The file of a campaign: rows of jobs, and when it is enough. `fieldproof schema campaign` has its shape.
//
// Contract: a row is a verb, what it is about ("of"), and options of the verb under the names that they have
// in a configuration file. Each of them is one value, an array of values that are taken one after the other,
// or, of a number, {"from": 1, "count": 100}; where an option may be given several times, or a verb has
// several selectors, an array inside the array is all of them for one job. A row is the product of its
// values: what it is about changes the slowest, of the options the last one the fastest. Jobs are numbered
// from 1 in the order of the rows and are made when they are asked for, so a row may have millions.
//
// Every value is held against the tables of the program before anything runs: what is refused is a
// kernel::Error(configuration) with file, line and pointer.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/confidence.hpp"
#include "campaign/job.hpp"
#include "cli/options.hpp"
#include "conformance/catalogue.hpp"
#include "harness/config/document.hpp"

namespace fieldproof::cli {

class CampaignPlan {
 public:
  CampaignPlan(const std::filesystem::path& file, const conformance::Catalogue& catalogue);

  const std::string& title() const { return title_; }
  const std::string& text() const { return document_.text(); }
  // Of what the plan says, however it is written.
  std::string hash() const;

  std::uint64_t count() const;  // jobs, after `budget.jobs`
  campaign::Job job(std::uint64_t id) const;
  // All files that its jobs read.
  std::vector<judge::InputFile> inputs() const;

  std::optional<std::chrono::milliseconds> time() const { return time_; }
  const std::optional<campaign::ConfidenceGoal>& confidence() const { return confidence_; }

  // Rows, one for each thing that the verb is about, and which jobs they are.
  std::size_t rows() const { return rows_.size(); }
  std::uint64_t first_of(std::size_t row) const { return rows_.at(row).first; }
  std::uint64_t count_of(std::size_t row) const { return rows_.at(row).count; }

 private:
  using Words = std::vector<std::string>;
  // One thing that a row varies.
  struct Axis {
    config::Value value;
    const Option* option = nullptr;  // null: what the verb is about
    std::vector<Words> choices;      // words of the command line
    std::vector<config::Value> places;
    std::uint64_t from = 0;  // with `range` other than 0 there are no choices but these numbers
    std::uint64_t range = 0;

    std::uint64_t size() const { return range > 0 ? range : choices.size(); }
    Words at(std::uint64_t n) const;
  };
  struct Row {
    config::Value value;
    std::string verb;
    std::vector<Axis> axes;
    std::uint64_t first = 1;
    std::uint64_t count = 1;
  };

  void read(const conformance::Catalogue& catalogue);
  static Row read_row(const config::Value& value);
  static Axis read_axis(const config::Value& value, const Option* option);
  static Words words_of(const config::Value& value, const Option* option);
  void read_budget(const config::Value& value);
  void add_rows(const Row& whole, const conformance::Catalogue& catalogue);
  void check(const Row& row, const conformance::Catalogue& catalogue, bool has_new_options);
  static Words words_at(const Row& row, std::uint64_t n);
  void note_inputs(const Row& row);

  config::Document document_;
  std::string title_;
  std::vector<Row> rows_;
  std::map<std::string, std::string> hashes_;  // of the files that jobs read, by path
  std::optional<std::chrono::milliseconds> time_;
  std::optional<std::uint64_t> most_jobs_;
  std::optional<campaign::ConfidenceGoal> confidence_;
  std::chrono::milliseconds limit_;  // of each job
  std::size_t checked_ = 0;
};

// The verbs that a campaign may have.
std::span<const std::string_view> campaign_verbs();
// An option that a row may give: what decides an outcome, and not where it goes or how it is shown.
bool is_of_a_row(const Option& option, std::string_view verb);

}  // namespace fieldproof::cli
