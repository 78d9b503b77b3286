// Every number of the valve bus with its source.
#include <array>

#include "harness/field/field.hpp"
#include "protocols/valve_bus/rules.hpp"

namespace fieldproof::valve_bus {
namespace {

using field::between;
using field::row;
using judge::Standing;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kSecond;

constexpr std::string_view kPaper = "Kim, Seo and Lee, pneumatic control by fieldbus";
constexpr std::string_view kOwn = "this project's choice; the paper is silent";
constexpr std::string_view kReadsAs = "this project's reading of a contradiction in the paper";
constexpr std::string_view kController = "the bit rate follows from serial mode 2 of the 8051 family";
constexpr std::string_view kLoads = "TIA-485-A: 32 unit loads, repeaters and masters count";

constexpr field::Unit kHalfCharacters{"characters", 2};
constexpr field::Unit kPicosecondsPerMetre{"ps/m"};
constexpr field::Range kOctet{0, 255};
constexpr field::Range kSomeBits{0, 1'000};
constexpr field::Range kSpan = between({}, 3'600 * kSecond);

constexpr std::array kCharacters{
    field::Choice{"P0", 0, "8 data bits and a ninth bit that is sent as 1 and ignored"},
    field::Choice{"P1", 1, "8 data bits and even parity"}, field::Choice{"P2", 2, "8 data bits"}};
constexpr std::array kHold{field::Choice{"valves hold", 0}};

constexpr auto kRows = field::rows<Rules>(
    row<&Rules::bit_rate>({field::kBitRate, {1'200, 1'000'000}, "on the line", kPaper, Standing::seed}),
    row<&Rules::characters>({{},
                             {},
                             "P0: 8 data bits and a ninth bit that is sent as 1 and ignored; P1: 8 data bits "
                             "and even parity; P2: 8 data bits; one start and one stop bit each",
                             kController,
                             Standing::derived,
                             kCharacters}),
    row<&Rules::longest_gap_half_characters>(
        {kHalfCharacters, kSomeBits, "longest silence inside a frame", kOwn}),
    row<&Rules::delimiter_half_characters>({kHalfCharacters, kSomeBits, "silence between frames", kOwn}),
    row<&Rules::driver_on_bits>(
        {field::kBits, kSomeBits, "at least, from driver on to the first start bit", kOwn}),
    row<&Rules::driver_off_bits>(
        {field::kBits, kSomeBits, "at most, from the last stop bit to driver off", kOwn}),
    row<&Rules::first_address>({{}, kOctet, "least ID of a node", kPaper, Standing::seed}),
    row<&Rules::last_address>({{}, kOctet, "greatest ID of a node", kPaper, Standing::seed}),
    row<&Rules::write_command>({{}, kOctet, "COMMAND of a write", kPaper, Standing::seed}),
    row<&Rules::read_command>({{}, kOctet, "COMMAND of a read", kPaper, Standing::seed}),
    row<&Rules::turnaround_time_span>(
        {field::kTime, kSpan, "after the delimiter, within which a response begins", kOwn}),
    row<&Rules::actuation_limit>(
        {field::kTime, kSpan, "after the delimiter, within which the valves have moved", kOwn}),
    row<&Rules::output_skew>({field::kTime, kSpan, "of the outputs that one command changes", kOwn}),
    row<&Rules::answers_writes>({{}, {}, "a write is answered with the data that it carried", kReadsAs}),
    row<&Rules::loss_limit>({field::kTime, kSpan, "valves go off without a command for so long; 0: they hold",
                             kReadsAs, Standing::own, kHold}),
    row<&Rules::response_wait>({field::kTime, kSpan,
                                "of the host for the first start bit of a response, after the delimiter",
                                kOwn}),
    row<&Rules::write_distance>(
        {field::kTime, kSpan, "from the delimiter after a write to the next frame", kOwn}),
    row<&Rules::read_attempts>({{}, {1, 1'000}, "of a read before it has failed", kOwn}),
    row<&Rules::refresh>({field::kTime, kSpan, "a node is written to again after so long", kOwn}),
    row<&Rules::fifo_octets>({field::kOctets, {4, 65'536}, "of commands of the PC", kOwn}),
    row<&Rules::partial_command_limit>(
        {field::kTime, kSpan, "within which the rest of a command of the PC comes", kOwn}),
    row<&Rules::unit_loads>(
        {{}, {1, 1'000}, "of a segment, host and repeaters included", kLoads, Standing::sure}),
    row<&Rules::max_nodes>({{}, {1, 1'000}, "nodes of a bus", kPaper, Standing::seed}),
    row<&Rules::max_length_m>(
        {field::kMetres, {1, 100'000}, "of cable without a repeater", kPaper, Standing::seed}),
    row<&Rules::repeater_delay>({field::kTime, kSpan, "of one repeater", kOwn}),
    row<&Rules::cable_delay_ps_per_m>(
        {kPicosecondsPerMetre, {0, 1'000'000}, "propagation along the cable", kOwn}));

}  // namespace

constexpr field::Table<Rules> kRulesTable = field::table<Rules>(kRows);

}  // namespace fieldproof::valve_bus
