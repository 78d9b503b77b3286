// Every number of INTERBUS with its source.
#include <array>
#include <span>

#include "protocols/interbus/rule_members.hpp"
#include "protocols/interbus/rules.hpp"

namespace fieldproof::interbus {
namespace {

using field::Alternative;
using field::between;
using field::row;
using judge::Standing;
using kernel::kMicrosecond;
using kernel::kSecond;

constexpr std::string_view kPark1 = "Park 2004, section 1";
constexpr std::string_view kOwn = "this project's choice; the standard was not at hand";
constexpr std::string_view kHalf =
    "half of the 3 bit a station of Park 2004; the equal halves are this project's choice";
constexpr std::string_view kManuals = "Lenze, Schneider and Beckhoff manuals";
constexpr std::string_view kControl =
    "the coding is this project's choice; Practical Guide has such a register";
constexpr std::string_view kMessage =
    "the meaning of each bit is this project's choice; bits 13..15: WAGO 750-304";
constexpr std::string_view kMemory = "literature from memory";

constexpr field::Unit kPicosecondsPerMetre{"ps/m"};
constexpr field::Unit kThousandthsOfBits{"bit", 1'000};
constexpr field::Unit kInARow{"in a row"};
constexpr field::Unit kInAWindow{"in a window"};
constexpr field::Unit kDataCycles{"data cycles"};
constexpr field::Unit kCycles{"cycles"};
constexpr field::Unit kBitsOfRegisters{"bit of registers"};

constexpr field::Range kWord{0, 0xFFFF};
constexpr field::Range kDelay{0, 1'000};
constexpr field::Range kCount{0, 1'000'000'000};
constexpr field::Range kPositive{1, 1'000'000'000};
constexpr field::Range kSpan = between({}, 1'000 * kSecond);

constexpr std::array kFastRate{
    Alternative{2'000'000, "Lenze E94AYCIB manual; Park 2004 has 500 kbit/s", Standing::searched}};
constexpr std::array kPrintedFormula{
    Alternative{2, "Park 2004, section 2.2, the formula: 8 + n telegrams", Standing::seed}};
constexpr std::array kChip3{
    Alternative{700'000'000, "Park 2004, section 2.2: master chip generation 3", Standing::seed}};
constexpr std::array kShortDistance{
    Alternative{150, "Lenze, Schneider and Beckhoff manuals: 150 m at 2 Mbit/s", Standing::searched}};

constexpr field::About word(std::string_view meaning, std::string_view source) {
  return {field::kHexadecimal, kWord, meaning, source};
}

// The bit rate first: a network file gives it beside the others.
constexpr auto kRows = field::rows<Rules>(
    row<&Rules::bit_rate>({field::kBitRate,
                           {1'000, 100'000'000},
                           "on the line",
                           "Park 2004, sections 1 and 2.2",
                           Standing::seed,
                           {},
                           kFastRate}),
    field::custom<&Rules::telegram>(
        kTelegramMember, {{},
                          {},
                          "order and polarity of the header levels",
                          "order and polarity are this project's choice; 5 + 8 bit: Park 2004, section 2.2"}),
    row<&Rules::telegram_gap_millibits>(
        {kThousandthsOfBits,
         {0, 1'000'000},
         "mean idle time after a telegram of a cycle",
         "the factor 1.15 of Park 2004 read as 0.15 * 13 bit of idle; the source does not explain it"}),
    row<&Rules::status_pitch_bits>({field::kBits,
                                    {line::kStatusTelegramLevels, 1'000'000},
                                    "from start to start of status telegrams in a pause",
                                    kOwn}),
    row<&Rules::forward_delay_half_bits>(
        {field::kHalfBits, kDelay, "of the station, away from the master", kHalf}),
    row<&Rules::return_delay_half_bits>(
        {field::kHalfBits, kDelay, "of the station, towards the master", kHalf}),
    row<&Rules::local_delay_half_bits>({field::kHalfBits, kDelay, "of a station on a local bus, both ways",
                                        "m in the formula of Park 2004 counts remote-bus stations only",
                                        Standing::derived}),
    row<&Rules::cable_delay_ps_per_m>({kPicosecondsPerMetre,
                                       {0, 1'000'000},
                                       "propagation along the cable",
                                       "two thirds of the speed of light, usual for twisted pairs",
                                       Standing::memory}),
    row<&Rules::loopback_word>(
        word("leads each cycle", "the value is this project's choice; 16 bit: Park 2004")),
    field::custom<&Rules::frame_check>(
        kFrameCheckMember,
        {{},
         {},
         "16-bit check by the name of the public catalogues",
         "CCITT polynomial: an encoder manual; bit order and final XOR are this project's choice"}),
    row<&Rules::status_clean>(word("the status word of a cycle without an error", kOwn)),
    row<&Rules::status_marked>(word("bits that a station with an error sets in the status word", kOwn)),
    row<&Rules::end_telegrams>({{},
                                {0, 1'000},
                                "telegrams after the status word",
                                "Park 2004, section 2.2, the text: loopback word 2, FCS 4 octets",
                                Standing::seed,
                                {},
                                kPrintedFormula}),
    row<&Rules::software_time>({field::kTime,
                                kSpan,
                                "what the master needs after a frame",
                                "Park 2004, section 2.2: master chip generation 4",
                                Standing::seed,
                                {},
                                kChip3}),
    row<&Rules::silence_limit>({field::kTime, kSpan, "without a telegram: a slave resets itself",
                                "Phoenix Contact UK, operation and maintenance of INTERBUS",
                                Standing::searched}),
    row<&Rules::silence_tolerance>({field::kTime, kSpan, "of the silence limit, in both directions", kOwn}),
    row<&Rules::latch_limit>(
        {field::kTime, kSpan, "outputs have moved so long after the last check telegram", kOwn}),
    row<&Rules::stop_after_bad_cycles>(
        {kInARow, kPositive, "rejected cycles after which the master stops", kOwn}),
    row<&Rules::quality_bad_cycles>(
        {kInAWindow, kPositive, "rejected data cycles that set the quality bit",
         "literature from memory; that quality is evaluated statistically: Phoenix Contact UK",
         Standing::memory}),
    row<&Rules::quality_window_cycles>(
        {kDataCycles, kPositive, "over which quality is evaluated", kMemory, Standing::memory}),
    row<&Rules::published_recovery_cycles>({kCycles, kPositive, "within which the bus works again",
                                            "Beckhoff BC4000 documentation, propagation delay",
                                            Standing::searched}),
    row<&Rules::max_stations>({{}, {1, 4096}, "stations of a ring", kPark1, Standing::seed}),
    row<&Rules::max_io_points>({kBitsOfRegisters, kCount, "of a ring",
                                "Hyundai Hi5, Schneider and Beckhoff manuals: 512 octets in each direction",
                                Standing::searched}),
    row<&Rules::max_levels>(
        {{}, {1, 30}, "of branches; the main line is the first", "Hyundai Hi5 manual", Standing::searched}),
    row<&Rules::max_distance_m>(
        {field::kMetres,
         kCount,
         "of cable between two remote-bus stations",
         "Lenze, Schneider and Beckhoff manuals: 400 m at 500 kbit/s, 150 m at 2 Mbit/s",
         Standing::searched,
         {},
         kShortDistance}),
    row<&Rules::max_cable_m>(
        {field::kMetres, kCount, "of remote bus in a network", kManuals, Standing::searched}),
    row<&Rules::control_remote_off>(word("bit of the control word: OUT1 is off", kControl)),
    row<&Rules::control_local_off>(word("bit of the control word: OUT2 is off", kControl)),
    row<&Rules::control_reset>(word("bit of the control word: the outgoing bus is reset", kControl)),
    row<&Rules::control_acknowledge>(word("bit of the control word: clears the messages", kControl)),
    row<&Rules::message_reconfiguration>(
        word("bit of the ID register: a reconfiguration is asked for", kMessage)),
    row<&Rules::message_check_error>(word("bit of the ID register: a check was wrong", kMessage)),
    row<&Rules::message_peripheral_fault>(word("bit of the ID register: a peripheral fault", kMessage)),
    field::custom<&Rules::length_codes>(kLengthCodesMember, {{},
                                                             {},
                                                             "replaces the published table of length codes",
                                                             "Schneider 890USE196; 14h from memory",
                                                             Standing::searched}));

}  // namespace

constexpr field::Table<Rules> kRulesTable = field::table<Rules>(kRows);
constexpr field::Table<Rules> kRulesInAFile = field::table<Rules>(std::span(kRows).subspan(1));

}  // namespace fieldproof::interbus
