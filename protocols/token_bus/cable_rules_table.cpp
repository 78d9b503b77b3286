#include "protocols/token_bus/cable_rules.hpp"

#include "protocols/token_bus/rules_table.hpp"

namespace fieldproof::token_bus {
namespace {

using field::row;
using judge::Standing;

constexpr std::string_view kRepeaters = "descriptions of IEEE 802.3 repeaters";
constexpr std::string_view kEthernetMemory = "IEEE 802.3, from memory";
constexpr field::Unit kDelayOfCable{"ps/m"};
constexpr field::Unit kMetres{"m"};

constexpr auto kRows = field::rows<CableRules>(
    row<&CableRules::cable_delay_ps_per_m>(
        {kDelayOfCable, {3'336, 10'000}, "of the cable; 500 m take 2.2 us", kSourceOwn}),
    row<&CableRules::longest_segment_m>(
        {kMetres, {1, 10'000}, "between two repeaters", kEthernetMemory, Standing::memory}),
    row<&CableRules::most_repeaters>(
        {{}, {0, 16}, "between two stations", kEthernetMemory, Standing::memory}),
    row<&CableRules::repeater_delay_bits>(
        {field::kBits, {0, 200}, "from the first bit at one side to the first one at the other", kSourceOwn}),
    row<&CableRules::repeater_preamble_bits>(
        {field::kBits,
         {56, 64},
         "that a repeater sends at least, with the start delimiter of IEEE 802.3; the paper asks for 56",
         kRepeaters,
         Standing::searched}),
    row<&CableRules::least_fragment_bits>({field::kBits,
                                           {0, 512},
                                           "that a repeater sends at least, however little it receives",
                                           kRepeaters,
                                           Standing::searched}),
    row<&CableRules::jabber>({field::kTime, field::between(kernel::kMillisecond, 100 * kernel::kMillisecond),
                              "after which a repeater forwards no more of a transmission", kEthernetMemory,
                              Standing::memory}),
    row<&CableRules::most_octets_with_repeaters>(
        {field::kOctets,
         {64, 8'191},
         "most octets between the delimiters of a frame that repeaters let through",
         kSourceOwn}),
    row<&CableRules::station_delay>({field::kTime, field::between({}, kernel::kMillisecond),
                                     "that a station may take to answer; a slot time holds it twice",
                                     kSourceOwn}));

}  // namespace

constexpr field::Table<CableRules> kCableRulesTable = field::table<CableRules>(kRows);

}  // namespace fieldproof::token_bus
