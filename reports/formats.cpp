#include "reports/formats.hpp"

#include <array>

#include "reports/ctrf_writer.hpp"
#include "reports/json_writer.hpp"
#include "reports/junit_writer.hpp"
#include "reports/sarif_writer.hpp"

namespace fieldproof::reports {
namespace {

using Texts = std::vector<std::string>;

constexpr std::array kFormats = {
    Format{"json",
           [](const PageRun& run, const OutcomeRules&) -> Texts { return {results_json(run.stored.run)}; }},
    Format{"junit",
           [](const PageRun& run, const OutcomeRules& rules) {
             return junit_files(run.stored.run, run.stored.manifest, rules);
           }},
    Format{"sarif", [](const PageRun& run, const OutcomeRules&) -> Texts { return {sarif_json(run)}; }},
    Format{"ctrf",
           [](const PageRun& run, const OutcomeRules& rules) -> Texts { return {ctrf_json(run, rules)}; }},
};

}  // namespace

std::span<const Format> formats() {
  return kFormats;
}

}  // namespace fieldproof::reports
