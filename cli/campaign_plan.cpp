#include "cli/campaign_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/command_line.hpp"
#include "cli/input_files.hpp"
#include "cli/networks.hpp"
#include "cli/sequence_corpus.hpp"
#include "cli/sequence_file.hpp"
#include "cli/settings.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

using config::Value;

constexpr std::size_t kMostRows = 1000;
constexpr std::size_t kMostChoices = 1000;
constexpr std::size_t kMostChecked = 10'000;   // values in a file, each of which is tried
constexpr std::size_t kLimitOfPlan = 1 << 20;  // octets
constexpr std::uint64_t kMostJobs = 1'000'000;
constexpr std::chrono::hours kUsualLimit{1};

constexpr std::array<std::string_view, 8> kCampaignVerbs = {"run",     "matrix", "check",  "emc",
                                                            "measure", "fuzz",   "verify", "residual"};

std::string scalar_of(const Value& value) {
  switch (value.kind()) {
    case config::ValueKind::integer:
      return std::to_string(value.as_integer<std::uint64_t>());
    case config::ValueKind::number:
      return fmt::format("{}", value.as_number());
    default:
      return std::string(value.as_string());
  }
}

std::chrono::milliseconds time_of(const Value& value) {
  const auto time = duration_of(value.as_string());
  if (!time)
    config::fail(value,
                 fmt::format("'{}' is no time; write for example \"90s\" or \"1.5 h\"", value.as_string()));
  return *time;
}

// Values are read as what the table calls them.
void check_values(const Settings& settings, const Option& option) {
  if (!settings.is_set(option.name) || option.kind != OptionKind::value) return;
  const bool is_choice = option.value_name.find('|') != std::string_view::npos &&
                         option.value_name.find("FILE") == std::string_view::npos;
  if (is_choice) settings.choice(option.name);
  if (option.value_name == "N") settings.number(option.name, 0, std::numeric_limits<std::uint64_t>::max());
  if (option.value_name == "T") settings.duration(option.name);
  if (option.name == "corpus") corpus_files(settings.text(option.name));
}

void check_operands(const std::string& verb, const std::vector<std::string>& words,
                    const conformance::Catalogue& catalogue) {
  if (verb == "run") catalogue.select(words);
  if (verb == "verify" && !(words.size() == 1 && !input_files_of(words.front(), nullptr).empty()))
    catalogue.select(words);
  // A matrix is one of a protocol; of sequences also one of a role.
  const bool is_of_protocol = verb == "matrix" && words.front().find('/') == std::string::npos;
  if (is_of_protocol) catalogue.suite(words.front());
  if ((verb == "matrix" && !is_of_protocol) || verb == "check" || verb == "fuzz")
    sequence_role_at(words.front(), catalogue);
  if (verb == "emc" || verb == "measure") network_entry_named(words.front(), verb);
}

}  // namespace

std::span<const std::string_view> campaign_verbs() {
  return kCampaignVerbs;
}

bool is_of_a_row(const Option& option, std::string_view verb) {
  const bool decides = option.decides_outcome && !option.is_of_the_moment;
  return is_known_to(option, verb) && (decides || option.decides_exit_code || option.name == "cases" ||
                                       option.name == "corpus" || option.name == "runs");
}

CampaignPlan::Words CampaignPlan::Axis::at(std::uint64_t n) const {
  if (range == 0) return choices.at(n);
  return {fmt::format("--{}={}", option->name, from + n)};
}

CampaignPlan::CampaignPlan(const std::filesystem::path& file, const conformance::Catalogue& catalogue)
    : document_(config::Document::load(file, {.size = kLimitOfPlan})), limit_(kUsualLimit) {
  read(catalogue);
}

void CampaignPlan::read(const conformance::Catalogue& catalogue) {
  config::read_object(document_.root(), [&](config::ObjectReader& object) {
    if (const auto title = object.optional("title")) title_ = title->as_string();
    if (const auto limit = object.optional("job_limit")) limit_ = time_of(*limit);
    if (const auto budget = object.optional("budget")) read_budget(*budget);
    for (const Value& value : object.required("jobs").as_array(1, kMostRows))
      add_rows(read_row(value), catalogue);
  });
}

// One row for each thing that the verb is about: they have little else in common, so their time is estimated
// apart.
void CampaignPlan::add_rows(const Row& whole, const conformance::Catalogue& catalogue) {
  const auto about = std::ranges::find(whole.axes, nullptr, &Axis::option);
  const std::size_t parts = about == whole.axes.end() ? 1 : about->choices.size();
  for (std::size_t part = 0; part < parts; ++part) {
    Row row = whole;
    if (about != whole.axes.end()) {
      Axis& axis = row.axes.at(static_cast<std::size_t>(about - whole.axes.begin()));
      axis.choices = {about->choices[part]};
      axis.places = {about->places[part]};
    }
    row.count = whole.count / parts;
    row.first = rows_.empty() ? 1 : rows_.back().first + rows_.back().count;
    if (row.first + row.count > kMostJobs + 1)
      config::fail(row.value, fmt::format("with this row there are more than {} jobs", kMostJobs));
    // The options are the same in all parts.
    check(row, catalogue, part == 0);
    note_inputs(row);
    rows_.push_back(std::move(row));
  }
}

void CampaignPlan::read_budget(const Value& value) {
  config::read_object(value, [&](config::ObjectReader& object) {
    if (const auto time = object.optional("time")) time_ = time_of(*time);
    if (const auto jobs = object.optional("jobs")) most_jobs_ = jobs->as_integer<std::uint64_t>(1, kMostJobs);
    const auto goal = object.optional("confidence");
    if (!goal) return;
    constexpr double kLeastRate = 1e-15;
    confidence_.emplace();
    config::read_object(*goal, [&](config::ObjectReader& read) {
      confidence_->rate = read.required("rate").as_number(kLeastRate, 0.5);
      if (const auto level = read.optional("level"))
        confidence_->confidence = level->as_number(0.5, 0.999999);
      if (const auto of = read.optional("of"))
        confidence_->is_of_differed = of->as_choice<bool>({{"sent", false}, {"data_differed", true}});
    });
  });
}

CampaignPlan::Row CampaignPlan::read_row(const Value& value) {
  return config::read_object(value, [&](config::ObjectReader& object) {
    Row row{value, {}, {}};
    row.verb = kCampaignVerbs.at(object.required("verb").as_choice(kCampaignVerbs));
    if (const auto of = object.optional("of")) row.axes.push_back(read_axis(*of, nullptr));
    for (const Option& option : options()) {
      if (!is_of_a_row(option, row.verb)) continue;
      if (const auto given = object.optional(file_key(option)))
        row.axes.push_back(read_axis(*given, &option));
    }
    const auto place = [](const Axis& axis) { return std::pair(axis.value.line(), axis.value.column()); };
    std::ranges::sort(row.axes, {}, place);
    for (const Axis& axis : row.axes) {
      if (axis.size() > kMostJobs || row.count * axis.size() > kMostJobs)
        config::fail(axis.value, fmt::format("with these values the row has more than {} jobs", kMostJobs));
      row.count *= axis.size();
    }
    return row;
  });
}

CampaignPlan::Axis CampaignPlan::read_axis(const Value& value, const Option* option) {
  Axis axis{value, option, {}, {}};
  if (value.is_object()) {
    if (option == nullptr || option->value_name != "N")
      config::fail(value,
                   "\"from\" and \"count\" are of numbers alone; write a value, or an array of values");
    config::read_object(value, [&](config::ObjectReader& object) {
      axis.from = object.required("from").as_integer<std::uint64_t>();
      axis.range = object.required("count").as_integer<std::uint64_t>(1, kMostJobs);
      if (axis.from > std::numeric_limits<std::uint64_t>::max() - (axis.range - 1))
        config::fail(value, "the last of these numbers is greater than 2^64 - 1");
    });
  } else if (value.is_array()) {
    axis.places = value.as_array(1, kMostChoices);
  } else {
    axis.places = {value};
  }
  for (const Value& one : axis.places) axis.choices.push_back(words_of(one, option));
  return axis;
}

// What one choice is on the command line.
CampaignPlan::Words CampaignPlan::words_of(const Value& value, const Option* option) {
  if (option != nullptr && option->kind == OptionKind::flag) {
    return value.as_bool() ? Words{fmt::format("--{}", option->name)} : Words{};
  }
  const bool may_be_several = option == nullptr || option->kind == OptionKind::list;
  if (value.is_array() && !may_be_several)
    config::fail(value, "a job has one of these; write it without the inner array");
  Words words;
  for (const Value& one : value.is_array() ? value.as_array(1, kMostChoices) : std::vector<Value>{value}) {
    const std::string word = option == nullptr ? std::string(one.as_string()) : scalar_of(one);
    if (option == nullptr && (word.empty() || word.starts_with('-')))
      config::fail(one, "what a verb is about is a selector, a protocol or a role, not an option");
    words.push_back(option == nullptr ? word : fmt::format("--{}={}", option->name, word));
  }
  return words;
}

CampaignPlan::Words CampaignPlan::words_at(const Row& row, std::uint64_t n) {
  std::vector<std::uint64_t> places(row.axes.size());
  for (std::size_t i = row.axes.size(); i-- > 0;) {
    places[i] = n % row.axes[i].size();
    n /= row.axes[i].size();
  }
  Words words;
  // What the verb is about comes first, wherever it stands in the row.
  for (const bool is_operand : {true, false}) {
    for (std::size_t i = 0; i < row.axes.size(); ++i) {
      if ((row.axes[i].option == nullptr) != is_operand) continue;
      std::ranges::move(row.axes[i].at(places[i]), std::back_inserter(words));
    }
  }
  return words;
}

// Each value with the first ones of all others.
void CampaignPlan::check(const Row& row, const conformance::Catalogue& catalogue, bool has_new_options) {
  const auto none = [](const std::string&) -> std::optional<std::string> { return std::nullopt; };
  const auto check_one = [&](std::uint64_t n, const Value& place) {
    if (++checked_ > kMostChecked)
      config::fail(place, fmt::format("with this there are more than {} values", kMostChecked));
    try {
      Words words = {"fieldproof", row.verb};
      std::ranges::move(words_at(row, n), std::back_inserter(words));
      const Parsed parsed = parse_command_line(words);
      if (!parsed.command) config::fail(place, "this asks for help");
      const Settings settings(*parsed.command, none);
      for (const Option& option : options()) {
        if (is_known_to(option, row.verb)) check_values(settings, option);
      }
      check_operands(row.verb, parsed.command->operands, catalogue);
    } catch (const kernel::Error& refused) {
      config::fail(place, fmt::format("fieldproof {} refuses it: {}", row.verb, refused.what()));
    }
  };
  if (row.axes.empty()) check_one(0, row.value);
  std::uint64_t stride = row.count;
  for (const Axis& axis : row.axes) {
    stride /= axis.size();
    if (axis.option != nullptr && !has_new_options) continue;
    if (axis.range > 0) check_one(stride * (axis.range - 1), axis.value);
    for (std::size_t i = 0; i < axis.choices.size(); ++i) check_one(stride * i, axis.places[i]);
  }
}

void CampaignPlan::note_inputs(const Row& row) {
  for (const Axis& axis : row.axes) {
    for (const Words& words : axis.choices) {
      for (const std::string& word : words) {
        for (const std::string& file : input_files_of(word, axis.option)) {
          if (!hashes_.contains(file)) hashes_[file] = judge::hash_of_file(file);
        }
      }
    }
  }
}

std::string CampaignPlan::hash() const {
  return judge::hash_of(nlohmann::ordered_json::parse(text(), nullptr, true, true).dump());
}

std::uint64_t CampaignPlan::count() const {
  const std::uint64_t all = rows_.back().first + rows_.back().count - 1;
  return most_jobs_ ? std::min(all, *most_jobs_) : all;
}

std::vector<judge::InputFile> CampaignPlan::inputs() const {
  std::vector<judge::InputFile> files;
  for (const auto& [path, hash] : hashes_) files.push_back({path, hash});
  return files;
}

campaign::Job CampaignPlan::job(std::uint64_t id) const {
  const auto after = std::ranges::upper_bound(rows_, id, {}, &Row::first);
  const Row& row = *std::prev(after);
  campaign::Job job;
  job.id = id;
  job.verb = row.verb;
  job.arguments = words_at(row, id - row.first);
  job.limit = limit_;
  for (const auto& [option, file] : {std::pair{"json", campaign::kDocument},
                                     {"out", "out"},
                                     {"case", "found.case.json"},
                                     {"corpus-out", campaign::kCorpus}}) {
    if (find_option(option, row.verb) != nullptr) job.outputs.push_back({fmt::format("--{}", option), file});
  }
  if (find_option("quiet", row.verb) != nullptr) job.manner.emplace_back("--quiet");
  // Jobs are many already.
  if (find_option("jobs", row.verb) != nullptr) job.manner.emplace_back("--jobs=1");
  for (const std::string& word : job.arguments) {
    const std::string_view name = std::string_view(word).substr(0, word.find('='));
    const Option* option = word.starts_with("--") ? find_option(name.substr(2), row.verb) : nullptr;
    for (const std::string& file : input_files_of(word, option)) {
      if (const auto known = hashes_.find(file); known != hashes_.end())
        job.inputs.push_back({known->first, known->second});
    }
  }
  return job;
}

}  // namespace fieldproof::cli
