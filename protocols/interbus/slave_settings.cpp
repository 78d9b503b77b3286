#include "protocols/interbus/slave_settings.hpp"

#include "protocols/interbus/rules.hpp"

namespace fieldproof::interbus {
namespace {

using field::row;

constexpr std::string_view kCode = "Schneider 890USE196 and 170 series manuals: type and length code";

constexpr auto kGiven =
    field::kNames<&Rules::bit_rate, &Rules::telegram, &Rules::forward_delay_half_bits,
                  &Rules::return_delay_half_bits, &Rules::frame_check, &Rules::status_clean,
                  &Rules::status_marked, &Rules::silence_limit, &Rules::silence_tolerance,
                  &Rules::control_remote_off, &Rules::control_local_off, &Rules::control_reset,
                  &Rules::control_acknowledge, &Rules::message_reconfiguration, &Rules::message_check_error,
                  &Rules::message_peripheral_fault>;

constexpr auto kRows = field::rows<SlaveConfiguration>(
    row<&SlaveConfiguration::id_code>({field::kHexadecimal,
                                       {0, 0x1FFF},
                                       "the ID code: bits 0 to 12 of the ID register",
                                       kCode,
                                       judge::Standing::searched}),
    row<&SlaveConfiguration::words>(
        {{}, {0, 256}, "length of the register in words of 16 bits", kCode, judge::Standing::searched}),
    row<&SlaveConfiguration::has_branch>(
        {{}, {}, "there is an outgoing interface to a local bus or branch (OUT2)", kCode}),
    field::part<&SlaveConfiguration::rules>(kRulesTable, kGiven),
    // The delays are those of where the slave sits.
    field::internal<&SlaveConfiguration::is_local>(), field::internal<&SlaveConfiguration::name>());

}  // namespace

constexpr field::Table<SlaveConfiguration> kSlaveTable = field::table<SlaveConfiguration>(kRows);

field::Settings slave_settings(const SlaveConfiguration& configuration) {
  SlaveConfiguration given = configuration;
  Rules& rules = given.rules;
  if (given.is_local)
    rules.forward_delay_half_bits = rules.return_delay_half_bits = rules.local_delay_half_bits;
  return field::settings_of(kSlaveTable, given);
}

SlaveConfiguration slave_configuration_of(const iut::CaseBegin& begin) {
  return field::taken_from(kSlaveTable, begin.settings);
}

}  // namespace fieldproof::interbus
