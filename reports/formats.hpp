// The formats that a run is written in besides the page, one row each: whoever writes reports walks this
// table.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reports/outcome.hpp"
#include "reports/page_content.hpp"

namespace fieldproof::reports {

struct Format {
  std::string_view name;  // the option that asks for it, "junit"
  // One text, or several where one would be more than its readers take.
  std::vector<std::string> (*write)(const PageRun&, const OutcomeRules&) = nullptr;
};

std::span<const Format> formats();

}  // namespace fieldproof::reports
