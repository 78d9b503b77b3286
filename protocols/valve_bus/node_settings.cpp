#include "protocols/valve_bus/node_settings.hpp"

namespace fieldproof::valve_bus {
namespace {

using field::row;

constexpr std::string_view kSwitches =
    "Kim, Seo and Lee: two address switches; what they read as is this project's choice";
constexpr std::string_view kBoards = "Kim, Seo and Lee, pneumatic control by fieldbus";

constexpr auto kGiven =
    field::kNames<&Rules::bit_rate, &Rules::characters, &Rules::answers_writes, &Rules::loss_limit>;

constexpr auto kRows = field::rows<NodeConfiguration>(
    field::part<&NodeConfiguration::rules>(kRulesTable, kGiven),
    row<&NodeConfiguration::address_tens>({{},
                                           {0, 15},
                                           "switch of the tens; the address is 10 tens + units, with a "
                                           "switch above 9 or both at 0 the node serves no ID",
                                           kSwitches}),
    row<&NodeConfiguration::address_units>({{}, {0, 15}, "switch of the units", kSwitches}),
    row<&NodeConfiguration::boards>(
        {{}, {1, 2}, "drive boards; the first drives DATA0", kBoards, judge::Standing::seed}));

}  // namespace

constexpr field::Table<NodeConfiguration> kNodeTable = field::table<NodeConfiguration>(kRows);

field::Settings node_settings(const NodeConfiguration& configuration) {
  return field::settings_of(kNodeTable, configuration);
}

NodeConfiguration node_configuration_of(const iut::CaseBegin& begin) {
  return field::taken_from(kNodeTable, begin.settings);
}

}  // namespace fieldproof::valve_bus
