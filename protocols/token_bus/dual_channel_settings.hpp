#pragma once

#include "harness/field/settings.hpp"
#include "harness/iut/device.hpp"
#include "protocols/token_bus/dual_channel_device.hpp"

// What an implementation outside is given of the configuration of a dual channel manager.
namespace fieldproof::token_bus {

extern const field::Table<ChannelManagerConfiguration> kChannelManagerTable;

field::Settings channel_manager_settings(const ChannelManagerConfiguration& configuration);
ChannelManagerConfiguration channel_manager_configuration_of(const iut::CaseBegin& begin);

}  // namespace fieldproof::token_bus
