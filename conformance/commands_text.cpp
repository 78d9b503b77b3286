#include "conformance/commands_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::conformance {

void CommandsText::add(std::string command) {
  if (!said_.empty() && said_.back().first == command) {
    ++said_.back().second;
  } else {
    said_.emplace_back(std::move(command), 1);
  }
}

std::string CommandsText::text() const {
  constexpr std::size_t kMostSaid = 10;
  const std::size_t left_out = said_.size() - std::min(said_.size(), kMostSaid);
  std::string all = left_out == 0 ? "" : fmt::format("{} others", left_out);
  for (std::size_t n = left_out; n < said_.size(); ++n) {
    const auto& [command, times] = said_[n];
    all += (all.empty() ? "" : " / ") + (times == 1 ? command : fmt::format("{} times {}", times, command));
  }
  return all;
}

}  // namespace fieldproof::conformance
