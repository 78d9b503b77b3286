#pragma once

#include <string_view>
#include <vector>

#include "conformance/fieldbus_dll/ff_bench.hpp"
#include "conformance/fieldbus_dll/link_expect.hpp"

// What the cases of the profile FF-P require again and again, each with its reason codes.
namespace fieldproof::conformance {

// The types of DLPDUs as the lower tester reads their first octets.
bool is_pt(const FfBench& bench, const DrivenDlpdu& dlpdu);
bool is_cd(const FfBench& bench, const DrivenDlpdu& dlpdu);
bool is_dt1(const FfBench& bench, const DrivenDlpdu& dlpdu);
bool is_dt3(const FfBench& bench, const DrivenDlpdu& dlpdu);
// Types whose first octet has nothing free.
bool is_of(const DrivenDlpdu& dlpdu, std::uint8_t code);
bool has_final_use(const DrivenDlpdu& dlpdu);
fieldbus_dll::Priority priority_in(const DrivenDlpdu& dlpdu);
unsigned duration_in(const DrivenDlpdu& pt);
// Destination and source of a DT1.
struct AddressesOfDt1 {
  fieldbus_dll::FfAddress to;
  fieldbus_dll::FfAddress from;
};
AddressesOfDt1 addresses_in(const DrivenDlpdu& dt1);
Octets dlsdu_of(const DrivenDlpdu& dt1);
// What a DT3 carries.
struct BufferOfDt3 {
  fieldbus_dll::FfAddress from = 0;
  std::uint8_t writes = 0;
  Octets data{};
};
BufferOfDt3 buffer_in(const DrivenDlpdu& dt3);

// All that the IUT says under a token that came at `from`, until it is silent: DT1, RI, RT. It returns the
// token exactly once, by RT or by F: `token_not_returned`, `token_returned_twice`, `unexpected_dlpdu`,
// `answers_too_late`. Gives the DT1s.
std::vector<DrivenDlpdu> expect_token_used(FfBench& bench, CaseJudge& judge, kernel::Time from);
// What is submitted is sent under a long PT: `does_not_recover`.
void expect_serves(FfBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance
