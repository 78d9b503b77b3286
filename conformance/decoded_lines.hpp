#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/kernel/time.hpp"

// What happened on a bench, for a finding: what was driven, and what else was done, in the order of its
// instants.
namespace fieldproof::conformance {

// "the supply went", "the supply returned".
std::string_view supply_text(bool is_on);

class DecodedLines {
 public:
  void add(kernel::Time when, std::string text) { all_.emplace_back(when, std::move(text)); }
  // Nothing of a supply that is there from the begin.
  void add_supply(kernel::Time when, bool is_on);
  void add(const DecodedLines& others) { all_.insert(all_.end(), others.all_.begin(), others.all_.end()); }
  // Those that are shown of what is found at `time`: what came before it, and what came next. Where there are
  // none, a line that says so.
  std::vector<std::string> around(kernel::Time time) const;
  // The same at the end.
  std::vector<std::string> last() const { return around(kernel::kNever); }

 private:
  std::vector<std::pair<kernel::Time, std::string>> all_;
};

}  // namespace fieldproof::conformance
