#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace fieldproof::conformance {

// The commands of a sequence in one line, for a finding: what comes several times in a row is said once, and
// of many commands the last, which are what failed.
class CommandsText {
 public:
  void add(std::string command);
  // "2 others / 256 times id / data word0 1 / supply off".
  std::string text() const;

 private:
  std::vector<std::pair<std::string, std::size_t>> said_;  // and how often
};

}  // namespace fieldproof::conformance
