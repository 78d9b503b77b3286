#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "conformance/fieldbus_dll/isa_bench.hpp"
#include "conformance/fieldbus_dll/link_expect.hpp"
#include "conformance/judging.hpp"
#include "protocols/fieldbus_dll/isa_dlpdu.hpp"

// What the cases of the profile ISA-D require again and again, each with its reason codes.
namespace fieldproof::conformance {

// Control octets of the profile, as the lower tester reads them.
bool is_type(const DrivenDlpdu& dlpdu, std::uint8_t code);
fieldbus_dll::Priority priority_of(const DrivenDlpdu& dlpdu);
bool is_final(const DrivenDlpdu& dlpdu);
// Of a DU or DT.
Octets dlsdu_in(const DrivenDlpdu& dlpdu);

// Data for the peer that no other has, accepted by the IUT: `data_refused`.
Octets expect_submitted(IsaBench& bench, CaseJudge& judge, fieldbus_dll::IsaService service,
                        fieldbus_dll::Priority priority, std::size_t size);

// What a token was used for.
struct TokenUse {
  std::vector<DrivenDlpdu> data;  // DU, in order
  DrivenDlpdu end;                // EE
};

// All that the IUT says until it has returned its token by EE and is silent, when the token came at `from`:
// `token_not_returned`, `unexpected_dlpdu`, `talks_behind_end`, `answers_too_late`, `dlpdu_wrong`.
TokenUse expect_token_use(IsaBench& bench, CaseJudge& judge, kernel::Time from);
void expect_end_reason(CaseJudge& judge, const TokenUse& use, fieldbus_dll::EndReason reason);

// What is submitted is sent under a long ES: `does_not_recover`.
void expect_serves(IsaBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance
