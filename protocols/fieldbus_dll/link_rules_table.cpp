#include <array>

#include "protocols/fieldbus_dll/rule_tables.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using field::kOctets;
using field::row;
using judge::Standing;

constexpr field::Unit kSlots{"slot times"};

constexpr std::array kSizeRow{field::item<std::size_t>({kOctets, {0, 256}, "octets of a DLSDU"})};
constexpr field::Table<std::size_t> kSizeTable = field::table<std::size_t>(kSizeRow);

constexpr auto kRows = field::rows<LinkRules>(
    row<&LinkRules::bit_rate>(
        {field::kBitRate, {1'000, 100'000'000}, "on the line", "IEC 61158-2: its rates", Standing::sure}),
    row<&LinkRules::preamble_octets>({kOctets,
                                      {1, 8},
                                      "in front of a frame, 1 + V(PhPE)",
                                      "nanoFIP, an open implementation; 1 to 8",
                                      Standing::searched}),
    row<&LinkRules::slot_time_octets>(
        {kOctets, {1, 4095}, "V(ST), slot time", kSourceVendors, Standing::searched}),
    row<&LinkRules::response_delay_slots>(
        {kSlots, {1, 11}, "V(MRD), greatest response delay", kSourceVendors, Standing::searched}),
    row<&LinkRules::inter_pdu_delay_octets>(
        {kOctets,
         {0, 120},
         "V(MID), least delay between DLPDUs, at most (V(MRD) - 1) x V(ST)",
         kSourceVendors,
         Standing::searched}),
    field::list<&LinkRules::most_data>(
        kSizeTable, 3,
        {kOctets,
         {},
         "most octets of a DLSDU of this priority",
         "IEC 61158, from memory; the frames of 75 and 267 octets of Hong and Son fit",
         Standing::memory},
        1));

}  // namespace

constexpr field::Table<LinkRules> kLinkRulesTable = field::table<LinkRules>(kRows);

}  // namespace fieldproof::fieldbus_dll
