#include "protocols/fieldbus_dll/rule_tables.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using field::kOctets;
using field::row;

constexpr field::About code(std::string_view meaning) {
  return {field::kHexadecimal, kOctetRange, meaning, kSourceOwn};
}

constexpr auto kCodeRows = field::rows<IsaCodes>(
    row<&IsaCodes::cd>(code("CD, compel data")), row<&IsaCodes::dt>(code("DT, data")),
    row<&IsaCodes::du>(code("DU, unit data")), row<&IsaCodes::et>(code("ET, token for one frame")),
    row<&IsaCodes::es>(code("ES, token for a duration")), row<&IsaCodes::ee>(code("EE, token returned")),
    row<&IsaCodes::tl>(code("TL, transfer of the link")));
constexpr field::Table<IsaCodes> kCodes = field::table<IsaCodes>(kCodeRows);

constexpr auto kRows = field::rows<IsaRules>(
    field::part<&IsaRules::link>(kLinkRulesTable), field::part<&IsaRules::codes>(kCodes, {}, "code_"),
    row<&IsaRules::first_address>(code("least address of a station")),
    row<&IsaRules::last_address>(code("greatest address of a station")),
    row<&IsaRules::everybody>(code("destination of a DU to everybody")),
    row<&IsaRules::reply_wait_octets>(
        {kOctets, kOctetDurations, "V(RR), for the reply to a CD", "V(MRD) x V(ST)"}),
    row<&IsaRules::reply_forming_octets>(
        {kOctets, kOctetDurations, "V(FD), within which a compelled station begins its reply", kSourceOwn}),
    row<&IsaRules::supervision_margin_octets>(
        {kOctets, kOctetDurations, "added to the duration of a token before it is reclaimed", kSourceOwn}));

}  // namespace

constexpr field::Table<IsaRules> kIsaRulesTable = field::table<IsaRules>(kRows);

}  // namespace fieldproof::fieldbus_dll
