// One run of a stored test of `emc`.
#pragma once

#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "cli/emc_case.hpp"
#include "emc/coupling.hpp"
#include "harness/trace/dissector.hpp"

namespace fieldproof::cli {

struct EmcRun {
  emc::ImmunityResult result;
  FlippedBits struck;
  std::vector<kernel::Time> changed;   // the starts of transmissions that arrived otherwise, in no order
  std::vector<trace::Change> changes;  // the first of them
  std::vector<std::string> channels;   // names by number
  std::shared_ptr<const trace::Dissector> dissector;
  trace::Recording recording;  // where it is recorded; of a long run the last part
};

EmcRun run_emc_case(const EmcCase& test, const emc::LineResponse& response, bool is_recorded = false,
                    std::stop_token stop = {});

}  // namespace fieldproof::cli
