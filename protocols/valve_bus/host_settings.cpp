#include "protocols/valve_bus/host_settings.hpp"

namespace fieldproof::valve_bus {
namespace {

using field::row;

constexpr std::string_view kOwn = "this project's choice; the paper is silent";
constexpr std::string_view kController =
    "what a timer of the 8051 family at 12 MHz makes of its reload values";

// The bit rate of the rules is not given: the DIP switches say it.
constexpr auto kGiven = field::kNames<&Rules::characters, &Rules::answers_writes>;

constexpr auto kRows = field::rows<HostConfiguration>(
    field::part<&HostConfiguration::rules>(kRulesTable, kGiven),
    row<&HostConfiguration::dip>({{},
                                  {0, 7},
                                  "position of the DIP switches at the beginning, which is the bit rate",
                                  kController,
                                  judge::Standing::derived}),
    row<&HostConfiguration::receives_own_echo>(
        {{}, {}, "the receiver of the host stays on while it drives", kOwn}),
    row<&HostConfiguration::verifies_writes>(
        {{}, {}, "after each write of the PC the host reads the node and compares", kOwn}));

}  // namespace

constexpr field::Table<HostConfiguration> kHostTable = field::table<HostConfiguration>(kRows);

field::Settings host_settings(const HostConfiguration& configuration) {
  return field::settings_of(kHostTable, configuration);
}

HostConfiguration host_configuration_of(const iut::CaseBegin& begin) {
  return field::taken_from(kHostTable, begin.settings);
}

}  // namespace fieldproof::valve_bus
