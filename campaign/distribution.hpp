// Gives the jobs of a campaign to slots and keeps what comes back.
//
// Contract: an outcome is in the journal before anybody is told of it; whatever ends this program, nothing
// judged is lost, and another distribution over the same folder goes on. A job whose process was killed, or
// did not end within its limit, three times, is a finding; counted over all distributions of the folder.
// `in_order` is told the outcomes in the order of their ids, without a gap, and ends the campaign there by
// answering true: what is known of later jobs is not part of it, whatever was faster.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <stop_token>

#include "campaign/folder.hpp"
#include "campaign/outcome.hpp"
#include "campaign/slots.hpp"
#include "harness/judge/checked_lines.hpp"

namespace fieldproof::campaign {

inline constexpr unsigned kMostLosses = 3;

class Distribution {
 public:
  struct Plan {
    std::uint64_t count = 0;
    std::function<Job(std::uint64_t id)> job;             // 1 ... count
    std::function<bool(const Outcome&)> in_order;         // may be empty
    std::function<void(const Outcome&)> on_outcome;       // as they come; may be empty
    std::function<void(std::uint64_t done)> on_progress;  // a few times a second; may be empty
    judge::Durability durability = judge::Durability::synced;
  };

  // Reads what the journal of the folder has. Throws as CheckedLines does.
  Distribution(Plan plan, const Folder& folder);

  // Until all is done, decided, or stopped. Throws kernel::Error where a place cannot do its job or the
  // folder takes no result.
  void run(Slots& slots, std::stop_token stop);

  // All jobs of the campaign have an outcome, or the rest is not part of it.
  bool is_complete() const { return is_decided_ || outcomes_.size() == plan_.count; }
  // The campaign ended before its last job, by what `in_order` answered.
  bool is_decided() const { return is_decided_; }
  // Of the jobs that are part of it.
  const std::map<std::uint64_t, Outcome>& outcomes() const { return outcomes_; }
  // Jobs that the journal has an outcome of, but whose files are gone from the folder: they are done again.
  std::uint64_t without_files() const { return without_files_; }

 private:
  void forget_what_has_no_files();
  void read_line(std::string_view text, const std::string& place);
  bool give_next(Slots& slots);
  void take(JobResult&& result);
  void lose(const JobResult& result);
  void keep(Outcome&& outcome);
  void go_on_in_order();

  Plan plan_;
  const Folder& folder_;
  std::map<std::uint64_t, Outcome> outcomes_;
  std::map<std::uint64_t, unsigned> losses_;
  std::set<std::uint64_t> lost_;  // to be given again
  std::set<std::uint64_t> running_;
  std::uint64_t next_ = 1;      // to be given
  std::uint64_t in_order_ = 1;  // to be told
  bool is_decided_ = false;
  std::uint64_t without_files_ = 0;
  judge::CheckedLines journal_;
};

}  // namespace fieldproof::campaign
