#include "protocols/token_bus/channel_rules.hpp"

#include "protocols/token_bus/rules_table.hpp"

namespace fieldproof::token_bus {
namespace {

using field::row;

constexpr field::Unit kTransmissions{"transmissions"};

constexpr auto kRows = field::rows<ChannelRules>(
    row<&ChannelRules::skew_symbols>(
        {field::Unit{"MAC symbols"}, {1, 32}, "most, that one channel is later than the other", kSourceOwn}),
    row<&ChannelRules::errors_in_a_row>({kTransmissions,
                                         {1, 16},
                                         "spoiled on a channel and clean on the other, then it has a fault",
                                         kSourceOwn}),
    row<&ChannelRules::clean_in_a_row>(
        {kTransmissions, {1, 16}, "clean on a channel that has a fault, then it has none", kSourceOwn}));

}  // namespace

constexpr field::Table<ChannelRules> kChannelRulesTable = field::table<ChannelRules>(kRows);

}  // namespace fieldproof::token_bus
