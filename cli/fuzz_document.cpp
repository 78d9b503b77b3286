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

// Of one that does not do the same again, what was seen: as the case file has it.
ordered_json found_json(const conformance::SequenceFound& found, const SequenceFile& target,
                        const FuzzEnd& end) {
  const conformance::Sequence& sequence = found.is_confirmed ? found.smallest : found.drawn;
  ordered_json json = {{"found_in", end.found_in},
                       {"commands", sequence.commands.size()},
                       {"faults", conformance::faults_in(sequence)},
                       {"is_confirmed", found.is_confirmed},
                       {"drawn_commands", found.drawn.commands.size()},
                       {"shrinking_runs", found.shrinking_runs},
                       {"input", conformance::sequence_lines(sequence, target.role->vocabulary)},
                       {"reproduce", end.reproduce}};
  const judge::CaseResult& result = found.is_confirmed ? found.outcome.result : found.first;
  if (!result.findings.empty()) {
    const judge::Finding& finding = result.findings.front();
    json["reason"] = finding.reason;
    json["requirement"] = finding.requirement;
    json["expected"] = finding.expected;
    json["actual"] = finding.actual;
  }
  return json;
}

}  // namespace

std::string fuzz_json(const fuzz::SequenceFuzzResult& result, const SequenceFile& target,
                      const std::string& implementations, const SequenceCorpus& corpus, const FuzzEnd& end) {
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
  if (end.is_interrupted) json["is_interrupted"] = true;
  if (!end.because.empty()) json["ended_because"] = end.because;
  if (result.found) json["found"] = found_json(*result.found, target, end);
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fieldproof::cli
