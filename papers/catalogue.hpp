// Which papers are reproduced, and what of each.
#pragma once

#include <span>
#include <string_view>

#include "harness/kernel/time.hpp"
#include "papers/sections.hpp"

namespace fieldproof::papers {

using Reproduce = reports::PublishedSection (*)(const Settings&);

struct Paper {
  std::string_view name;
  std::string_view title;
  std::string_view network;             // that its sections simulate
  kernel::Duration shortest{};          // virtual time of a signal
  std::span<const Reproduce> sections;  // in the order in which they are printed
};

std::span<const Paper> catalogue();

// Throws kernel::Error(usage) that names the papers that there are.
const Paper& paper_named(std::string_view name);

}  // namespace fieldproof::papers
