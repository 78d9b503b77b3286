#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/fieldbus_dll/link_bench.hpp"
#include "conformance/judging.hpp"

// What cases of every profile of the data link require again and again, each with its reason codes.
namespace fieldproof::conformance {

// The IUT is silent: `reason`.
void expect_silence(LinkBench& bench, CaseJudge& judge, std::string_view reason, std::string_view why);

// The next DLPDU of the IUT; `reason` when it says nothing for twice V(RR), or until `limit`.
DrivenDlpdu expect_next(LinkBench& bench, CaseJudge& judge, std::string_view reason, std::string_view what);
DrivenDlpdu expect_next(LinkBench& bench, CaseJudge& judge, kernel::Time limit, std::string_view reason,
                        std::string_view what);
// It begins in this span, to a rounding.
void expect_begins(CaseJudge& judge, const DrivenDlpdu& dlpdu, kernel::Time earliest,
                   std::string_view reason_early, kernel::Time latest, std::string_view reason_late);

// Why DLSDUs are not those that must be sent.
struct DlsduReasons {
  std::string missing;
  std::string more;
  std::string others = "data_wrong";
};
using DlsduOf = Octets (*)(const DrivenDlpdu&);
// Data DLPDUs carry exactly these DLSDUs.
void expect_dlsdus(CaseJudge& judge, const std::vector<DrivenDlpdu>& data, DlsduOf dlsdu_of,
                   const std::vector<Octets>& right, const DlsduReasons& reasons);
// Under a long token, all that waits is sent, and so this, which was submitted last: `does_not_recover`.
void expect_recovers(LinkBench& bench, CaseJudge& judge, bool is_submitted, const Octets& token,
                     DlsduOf dlsdu_of, const Octets& right);

// What the user of the IUT was told was sent by the tester as it was told: in that order, and no more often:
// `told_otherwise`. `is_told(sent, told)`: this was sent, for the user, and says the same. For the end of a
// procedure.
template <typename Reported, typename IsTold>
void judge_told(const LinkBench& bench, CaseJudge& judge, const std::vector<Reported>& all_told,
                IsTold is_told) {
  const auto sent = bench.sent();
  auto next = sent.begin();
  for (const Reported& told : all_told) {
    const auto is_same = [&](const DrivenDlpdu& one) { return one.has_right_check && is_told(one, told); };
    const auto found = std::find_if(next, sent.end(), is_same);
    if (found == sent.end() && std::ranges::any_of(bench.arrived_unsent(), is_same)) continue;
    judge.expect(found != sent.end(), "told_otherwise", [&] {
      return Mismatch{{"what was sent to its user is reported to it, once and as it was"}, describe(told)};
    });
    next = found + 1;
  }
}

// How each DLPDU of the IUT stands on the line, whatever the case was about: `frame_malformed`,
// `check_wrong`, `gap_too_short`. For the end of a procedure.
void judge_driven(const LinkBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance
