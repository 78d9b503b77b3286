#include "campaign/distribution.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "harness/kernel/error.hpp"

namespace fieldproof::campaign {
namespace {

constexpr std::chrono::milliseconds kLongestWait{100};
constexpr int kFinding = 1;
constexpr int kBadFile = 65;

std::string loss_line(const JobResult& result) {
  const nlohmann::ordered_json json = {{"id", result.id}, {"loss", result.loss}};
  return json.dump();
}

}  // namespace

Distribution::Distribution(Plan plan, const Folder& folder)
    : plan_(std::move(plan)),
      folder_(folder),
      journal_(folder.journal(), plan_.durability,
               [this](std::string_view text, const std::string& place) { read_line(text, place); }) {
  forget_what_has_no_files();
  go_on_in_order();
}

// The journal keeps them: a job gives the same again, and the outcome that comes then takes the place of
// this.
void Distribution::forget_what_has_no_files() {
  without_files_ = std::erase_if(
      outcomes_, [this](const auto& one) { return !folder_.holds(one.first, one.second.kept); });
}

void Distribution::read_line(std::string_view text, const std::string& place) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_object() && json.contains("loss") && json.contains("id") && json["id"].is_number_unsigned()) {
    ++losses_[json["id"].get<std::uint64_t>()];
    return;
  }
  Outcome outcome = outcome_from_json(text, place);
  if (outcome.id < 1 || outcome.id > plan_.count) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("{}: there is no job {} in this campaign", place, outcome.id));
  }
  outcomes_.insert_or_assign(outcome.id, std::move(outcome));
}

void Distribution::run(Slots& slots, std::stop_token stop) {
  while (!stop.stop_requested() && !is_decided_) {
    while (slots.free() > 0 && give_next(slots)) {
    }
    if (running_.empty()) break;
    for (JobResult& result : slots.wait(kLongestWait)) take(std::move(result));
    if (plan_.on_progress) plan_.on_progress(outcomes_.size());
  }
  slots.abandon();
  running_.clear();
}

bool Distribution::give_next(Slots& slots) {
  std::uint64_t id = 0;
  if (!lost_.empty()) {
    id = lost_.extract(lost_.begin()).value();
  } else {
    while (next_ <= plan_.count && outcomes_.contains(next_)) ++next_;
    if (next_ > plan_.count) return false;
    id = next_++;
  }
  slots.give(plan_.job(id));
  running_.insert(id);
  return true;
}

void Distribution::take(JobResult&& result) {
  running_.erase(result.id);
  if (!result.obstacle.empty()) {
    const auto kind =
        result.obstacle_code == kBadFile ? kernel::ErrorKind::configuration : kernel::ErrorKind::output;
    throw kernel::Error(kind, fmt::format("job {} cannot be done: {}", result.id, result.obstacle));
  }
  if (!result.loss.empty()) {
    lose(result);
    return;
  }
  folder_.write_job(result);
  keep(outcome_of(result));
}

void Distribution::lose(const JobResult& result) {
  journal_.append(loss_line(result));
  if (++losses_[result.id] < kMostLosses) {
    lost_.insert(result.id);
    return;
  }
  Outcome outcome;
  outcome.id = result.id;
  outcome.exit_code = kFinding;
  outcome.killed = result.loss;
  outcome.wall_time_ms = result.wall_time_ms;
  keep(std::move(outcome));
}

void Distribution::keep(Outcome&& outcome) {
  journal_.append(to_json(outcome));
  if (plan_.on_outcome) plan_.on_outcome(outcome);
  outcomes_.insert_or_assign(outcome.id, std::move(outcome));
  go_on_in_order();
}

void Distribution::go_on_in_order() {
  for (auto at = outcomes_.find(in_order_); !is_decided_ && at != outcomes_.end() && at->first == in_order_;
       ++at) {
    ++in_order_;
    is_decided_ = plan_.in_order && plan_.in_order(at->second) && in_order_ <= plan_.count;
  }
  if (is_decided_) outcomes_.erase(outcomes_.lower_bound(in_order_), outcomes_.end());
}

}  // namespace fieldproof::campaign
