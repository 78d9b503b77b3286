// How far a campaign is that runs elsewhere, from its folder alone.
//
// Contract: nothing is written, and a look reads no more than kMostRead octets, so that it can be repeated
// each second beside a campaign of any size.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "campaign/folder.hpp"
#include "campaign/outcome.hpp"

namespace fieldproof::campaign {

class Watch {
 public:
  static constexpr std::size_t kMostRead = std::size_t{4} << 20;

  explicit Watch(const Folder& folder) : folder_(folder) {}

  // Reads what has come since the last look; the outcomes among it that are no success. False when there is
  // more to be read at once.
  bool look();
  // Of the last look.
  const std::vector<Outcome>& bad() const { return bad_; }

  std::uint64_t done() const { return done_; }
  std::uint64_t failed() const { return failed_; }
  std::uint64_t losses() const { return losses_; }
  // Somebody holds its journal.
  bool is_running() const;
  // What campaign.json says of its end, once it is there: its exit code, and why it is not complete.
  struct End {
    int exit_code = 0;
    std::string incomplete_because;
  };
  std::optional<End> end() const;

 private:
  void take_line(std::string_view line);

  const Folder& folder_;
  std::uintmax_t read_ = 0;  // octets of the journal
  std::uint64_t done_ = 0;
  std::uint64_t failed_ = 0;
  std::uint64_t losses_ = 0;
  std::vector<Outcome> bad_;
};

}  // namespace fieldproof::campaign
