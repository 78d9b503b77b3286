#include "protocols/token_bus/rules_table.hpp"

#include <array>

namespace fieldproof::token_bus {
namespace {

using field::kOctets;
using field::row;
using judge::Standing;

constexpr field::Unit kSymbols{"MAC symbols"};
constexpr field::Unit kSlots{"slot times"};
constexpr field::Unit kTokens{"tokens"};
constexpr field::Range kRotations{0, 2'097'151};
constexpr std::string_view kSlotSpan =
    "MC68824 token bus controller, user's manual, 1 to 2^13 - 1; less here, so that the longest claim fits a "
    "frame";

constexpr std::array kLengths{field::Choice{"16", 2, "bits"}, field::Choice{"48", 6, "bits"}};

constexpr std::array kRotationRow{field::item<std::uint32_t>({kOctets, kRotations, "of one class"})};
constexpr field::Table<std::uint32_t> kRotationTable = field::table<std::uint32_t>(kRotationRow);

constexpr field::About memory(field::Unit unit, field::Range range, std::string_view meaning) {
  return {unit, range, meaning, kSourceMemory, Standing::memory};
}

// What a file of a ring may say of them.
constexpr field::Row kSlotTimeRow = row<&Rules::slot_time_octets>(
    {kOctets, {12, 1'362}, "slot_time, the same for all", kSlotSpan, Standing::searched});
constexpr field::Row kHoldRow = row<&Rules::high_priority_hold_octets>(
    {kOctets, {0, 65'535}, "hi_pri_token_hold_time, of class 6", kSourceController, Standing::searched});
constexpr field::Row kTargetsRow = field::list<&Rules::target_rotation_octets>(
    kRotationTable, 3,
    {kOctets, {}, "target_rotation_time of the classes 4, 2, 0", kSourceController, Standing::searched});
constexpr std::array kRingRows{kSlotTimeRow, kHoldRow, kTargetsRow};

constexpr auto kRows = field::rows<Rules>(
    row<&Rules::phy_bit_rate>({field::kBitRate,
                               {1'000'000, 100'000'000},
                               "of the IEEE 802.3 line; the MAC runs at half of it",
                               kSourcePaper,
                               Standing::seed}),
    row<&Rules::preamble_octets>(
        {kOctets,
         {4, 32},
         "in front of a frame; 4 hold the preamble of IEEE 802.3 up to the last two bits of its SFD",
         "the paper's table of codes, and the preamble of IEEE 802.3",
         Standing::derived}),
    row<&Rules::response_gap_octets>({kOctets,
                                      {4, 64},
                                      "least silence in front of a transmission; 6 are the gap of IEEE 802.3",
                                      kSourceOwn}),
    row<&Rules::blanking_symbols>(
        memory(kSymbols, {24, 32}, "after a transmission, in which the receiver reports silence")),
    row<&Rules::address_length>(
        {field::kBits, {}, "of all addresses of the network", kSourceStandard, Standing::sure, kLengths}),
    kSlotTimeRow,
    row<&Rules::most_octets>({kOctets,
                              {64, 8'191},
                              "most octets between the delimiters of a frame",
                              kSourcePaper,
                              Standing::seed}),
    row<&Rules::bus_idle_slots>(memory(kSlots, {2, 64}, "of silence, then a station claims the token")),
    row<&Rules::lowest_bus_idle_slots>(
        memory(kSlots, {2, 64}, "the same of the station with the lowest address of the ring")),
    row<&Rules::noise_wait_slots>(
        memory(kSlots, {0, 16}, "that a token passer waits longer when noise followed the token")),
    row<&Rules::demand_wait_slots>(
        {kSlots, {1, 16}, "that a station which has answered waits for the token", kSourceOwn}),
    row<&Rules::response_wait_slots>(
        memory(kSlots, {2, 16}, "for the response to a request; the responder has two")),
    row<&Rules::max_retry_limit>(
        {{}, {0, 7}, "repetitions of a request with response", kSourceMib, Standing::searched}),
    row<&Rules::max_inter_solicit_count>({kTokens,
                                          {16, 255},
                                          "between two response windows; the two low bits are drawn anew",
                                          kSourceMib,
                                          Standing::searched}),
    row<&Rules::transmitter_fault_limit>(
        memory({}, {1, 64}, "failures in a row to pass the token, then the station goes offline")),
    kHoldRow, kTargetsRow,
    row<&Rules::ring_maintenance_octets>(
        {kOctets, kRotations, "target_rotation_time of ring maintenance: a slower ring opens no window",
         kSourceController, Standing::searched}),
    row<&Rules::solicits_at_first>({{},
                                    {},
                                    "ring maintenance begins with time left, so the first window may open",
                                    kSourceMib,
                                    Standing::searched}));

}  // namespace

constexpr field::Table<Rules> kRulesTable = field::table<Rules>(kRows);
constexpr field::Table<Rules> kRulesInARingFile = field::table<Rules>(kRingRows);

}  // namespace fieldproof::token_bus
