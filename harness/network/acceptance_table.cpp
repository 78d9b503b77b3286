#include <array>

#include "harness/field/field.hpp"
#include "harness/network/acceptance.hpp"

namespace fieldproof::network {
namespace {

using field::row;
using judge::Standing;

constexpr field::Unit kCycles{"cycles"};
constexpr field::Unit kExchanges{"exchanges"};
constexpr field::Range kCount{1, 1'000'000};
constexpr field::Range kSpan = field::between({}, 1'000 * kernel::kSecond);

constexpr std::array kPublishedRecovery{
    field::Alternative{5, "INTERBUS: Beckhoff BC4000 documentation, propagation delay", Standing::searched}};

constexpr auto kRows = field::rows<AcceptanceRules>(
    row<&AcceptanceRules::recovery_cycles>(
        {kCycles,
         kCount,
         "after the last pulse, within which all data are exchanged again; beyond: criterion C",
         "this project's choice",
         Standing::own,
         {},
         kPublishedRecovery}),
    row<&AcceptanceRules::silence_cycles>({kCycles, kCount,
                                           "without an exchange: the network has stopped, criterion C",
                                           "this project's choice"}),
    row<&AcceptanceRules::least_silence>(
        {field::kTime, kSpan, "no shorter silence is a stop", "this project's choice"}),
    row<&AcceptanceRules::least_bring_up>({field::kTime, kSpan,
                                           "a start has at least so long until data are exchanged, more in a "
                                           "large network; beyond: criterion D",
                                           "this project's choice"}),
    row<&AcceptanceRules::limits_waited>(
        {{},
         kCount,
         "recovery limits for which recovery is waited for, until a start has to mend it",
         "this project's choice"}),
    row<&AcceptanceRules::least_exchanges_waited>(
        {kExchanges, kCount, "for which recovery is waited for at least", "this project's choice"}),
    row<&AcceptanceRules::least_time_waited>(
        {field::kTime, kSpan, "for which recovery is waited for at least", "this project's choice"}),
    row<&AcceptanceRules::pause_before_start>({field::kTime, kSpan,
                                               "from the stop of a network that did not recover to its start",
                                               "this project's choice"}));

}  // namespace

constexpr field::Table<AcceptanceRules> kAcceptanceTable = field::table<AcceptanceRules>(kRows);

}  // namespace fieldproof::network
