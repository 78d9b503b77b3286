#include "protocols/fieldbus_dll/rule_tables.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using field::kOctets;
using field::row;
using judge::Standing;
using kernel::kSecond;

constexpr std::string_view kOverview = "overviews of Foundation Fieldbus, not verified again";
constexpr field::Range kSpan = field::between({}, 3'600 * kSecond);

constexpr field::About code(std::string_view meaning) {
  return {field::kHexadecimal, kOctetRange, meaning, kSourceMemory, Standing::memory};
}
constexpr field::About node(field::Range range, std::string_view meaning, std::string_view source,
                            Standing standing) {
  return {field::kHexadecimal, range, meaning, source, standing};
}
constexpr field::About vendors(field::Unit unit, field::Range range, std::string_view meaning) {
  return {unit, range, meaning, kSourceVendors, Standing::searched};
}

constexpr auto kCodeRows = field::rows<FfCodes>(
    row<&FfCodes::cd>(code("CD, compel data")),
    row<&FfCodes::dt1>(code("DT1, data with destination and source")),
    row<&FfCodes::dt3>(code("DT3, data of a publisher")), row<&FfCodes::sr>(code("SR, status response")),
    row<&FfCodes::ct>(code("CT, compel time")), row<&FfCodes::td>(code("TD, time distribution")),
    row<&FfCodes::pn>(code("PN, probe node")), row<&FfCodes::pr>(code("PR, probe response")),
    row<&FfCodes::pt>(code("PT, pass token")), row<&FfCodes::rt>(code("RT, return token")),
    row<&FfCodes::ri>(code("RI, request interval")), row<&FfCodes::cl>(code("CL, claim LAS")),
    row<&FfCodes::tl>(code("TL, transfer LAS")), row<&FfCodes::idle>(code("IDLE")));
constexpr field::Table<FfCodes> kCodes = field::table<FfCodes>(kCodeRows);

constexpr auto kRows = field::rows<FfRules>(
    field::part<&FfRules::link>(kLinkRulesTable), field::part<&FfRules::codes>(kCodes, {}, "code_"),
    row<&FfRules::first_node>(node(kOctetRange, "least address of a node", kSourceMemory, Standing::memory)),
    row<&FfRules::last_node>(
        node(kOctetRange, "greatest address of a node", kSourceMemory, Standing::memory)),
    row<&FfRules::first_unpolled>(
        node({21, 247}, "V(FUN), first node that is not probed", kSourceVendors, Standing::searched)),
    row<&FfRules::unpolled>(vendors({}, {0, 228}, "V(NUN), how many nodes are not probed")),
    row<&FfRules::scheduling_overhead_octets>(
        vendors(kOctets, kOctetDurations, "V(MSO), scheduling overhead")),
    row<&FfRules::least_token_octets>(
        vendors(kOctets, {32, 32'767}, "V(DMDT), least time of a delegated token")),
    row<&FfRules::token_holding_octets>(
        vendors(kOctets, {276, 65'000}, "V(DTHT), of a node in a circulation")),
    row<&FfRules::claim_delay_octets>(
        vendors(kOctets, {1, 4095}, "V(MICD), delay before a claim of the LAS")),
    row<&FfRules::misses_until_removal>(
        {{}, kOctetRange, "missed tokens after which a node has left", kOverview, Standing::memory}),
    row<&FfRules::target_rotation>(vendors(field::kTime, kSpan, "V(TTRT), target token rotation time")),
    row<&FfRules::time_distribution_period>(vendors(field::kTime, kSpan, "V(TDP), between two TD")),
    row<&FfRules::steers_by_three_steps>(
        {{},
         {},
         "the priority of a token goes by all three steps; else from urgent to time-available at once",
         kSourceOwn}),
    row<&FfRules::returns_with_last_data>(
        {{}, {}, "the last DT1 under a token returns it; else an RT after it does", kSourceOwn}));

}  // namespace

constexpr field::Table<FfRules> kFfRulesTable = field::table<FfRules>(kRows);

}  // namespace fieldproof::fieldbus_dll
