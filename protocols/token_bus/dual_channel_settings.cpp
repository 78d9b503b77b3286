#include "protocols/token_bus/dual_channel_settings.hpp"

#include "protocols/token_bus/rules_table.hpp"

namespace fieldproof::token_bus {
namespace {

using field::part;
using field::row;

constexpr auto kRows = field::rows<ChannelManagerConfiguration>(
    part<&ChannelManagerConfiguration::rules>(kRulesTable),
    part<&ChannelManagerConfiguration::channels>(kChannelRulesTable),
    row<&ChannelManagerConfiguration::delay_symbols>(
        {field::Unit{"MAC symbols"},
         {2, 64},
         "most, from a request to the channels; an indication may take skew_symbols and 8 more",
         kSourceOwn}));

}  // namespace

constexpr field::Table<ChannelManagerConfiguration> kChannelManagerTable =
    field::table<ChannelManagerConfiguration>(kRows);

field::Settings channel_manager_settings(const ChannelManagerConfiguration& configuration) {
  return field::settings_of(kChannelManagerTable, configuration);
}

ChannelManagerConfiguration channel_manager_configuration_of(const iut::CaseBegin& begin) {
  return field::taken_from(kChannelManagerTable, begin.settings);
}

}  // namespace fieldproof::token_bus
