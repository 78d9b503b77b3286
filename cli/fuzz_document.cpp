#include "cli/fuzz_document.hpp"

#include <nlohmann/json.hpp>
#include <span>

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

ordered_json growth_json(std::span<const fuzz::GrowthPoint> growth) {
  ordered_json points = ordered_json::array();
  for (const fuzz::GrowthPoint& one : growth)
    points.push_back({{"run", one.run}, {"edges", one.edges}, {"kept", one.kept}});
  return points;
}

ordered_json found_json(const conformance::SequenceFound& found) {
  ordered_json json = {{"commands", found.smallest.commands.size()},
                       {"faults", conformance::faults_in(found.smallest)},
                       {"is_confirmed", found.is_confirmed}};
  const judge::CaseResult& result = found.is_confirmed ? found.outcome.result : found.first;
  if (!result.findings.empty()) json["reason"] = result.findings.front().reason;
  return json;
}

}  // namespace

std::string fuzz_json(const fuzz::SequenceFuzzResult& result, const SequenceFile& target,
                      const std::string& implementations, const SequenceCorpus& corpus) {
  ordered_json left_out = ordered_json::array();
  for (const LeftOutFile& one : corpus.left_out)
    left_out.push_back({{"file", one.file.filename().string()}, {"because", one.because}});
  ordered_json json = {
      {"schema", "fieldproof/fuzz/1"},
      {"role", role_path(*target.role)},
      {"seed", std::to_string(target.setup.seed)},
      {"implementations", ordered_json::parse(implementations)},
      {"run", result.run},
      {"stored", {{"read", corpus.read.size()}, {"run", result.seeds_run}, {"left_out", left_out}}},
      {"passed", result.passed},
      {"silent", result.silent},
      {"inconclusive", result.inconclusive},
      {"has_coverage", result.has_coverage},
      {"edges", result.edges},
      {"kept", result.kept},
      {"corpus", result.corpus.size()},
      {"growth", growth_json(result.growth)}};
  if (result.found) json["found"] = found_json(*result.found);
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fieldproof::cli
