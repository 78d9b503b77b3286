#include "cli/same_run.hpp"

#include <fmt/format.h>

namespace fieldproof::cli {

std::string difference(const reports::RunIdentity& stored, const reports::RunIdentity& now) {
  if (stored.suite_version != now.suite_version)
    return fmt::format("the suite was {} and is {}", stored.suite_version, now.suite_version);
  if (stored.seed != now.seed) return fmt::format("the seed was {}, not {}", stored.seed, now.seed);
  if (stored.volume != now.volume) return fmt::format("the volume was {}, not {}", stored.volume, now.volume);
  // Where no case is selected it is open which role an implementation plays.
  const bool is_empty = stored.selected == 0 || now.selected == 0;
  const bool is_other = is_empty ? stored.reproduce_options != now.reproduce_options
                                 : stored.implementations != now.implementations;
  if (is_other) {
    return fmt::format("its options were '{}', not '{}': the implementations differ",
                       stored.reproduce_options, now.reproduce_options);
  }
  if (stored.plan_hash != now.plan_hash) return "the plan of faults has changed since";
  if (stored.network_hash != now.network_hash) return "the network has changed since";
  if (stored.pics_hash != now.pics_hash) return "the PICS has changed since";
  return {};
}

}  // namespace fieldproof::cli
