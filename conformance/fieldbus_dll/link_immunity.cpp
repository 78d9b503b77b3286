#include "conformance/fieldbus_dll/link_immunity.hpp"

namespace fieldproof::conformance {

std::vector<DrivenDlpdu> listen_under_stress(LinkBench& bench, CaseJudge& judge, bool is_asked,
                                             LinkBurstLedger& ledger) {
  ++ledger.sent;
  if (is_asked) ++ledger.asked;
  std::vector<DrivenDlpdu> said = bench.listen();
  if (is_asked && said.empty()) ++ledger.unanswered;
  if (is_asked || said.empty() || !bench.arrived_unsent().empty()) return said;
  judge.fail("speaks_unasked",
             {{"silence: nothing that was sent asks for it"}, said.front().text(), said.front().begin});
  return said;
}

void measure_stress(const LinkBench& bench, CaseJudge& judge, const LinkBurstLedger& ledger) {
  const auto measure = [&](std::string_view name, std::uint64_t count) {
    judge.measure(std::string(name), "", static_cast<double>(count));
  };
  measure("transmissions that arrived otherwise", bench.stressed_transmissions());
  measure("wrong ones whose check fits", bench.arrived_unsent().size());
  if (ledger.sent > 0) {
    measure("DLPDUs under bursts", ledger.sent);
    measure("of these, that ask for an answer", ledger.asked);
    measure("and got none", ledger.unanswered);
  }
  if (bench.stressed_transmissions() == 0)
    judge.inconclusive("nothing_was_hit", {{"bursts change DLPDUs"}, "none arrived otherwise"});
}

}  // namespace fieldproof::conformance
