#include "protocols/token_bus/attached_dual_channel.hpp"

#include <fmt/format.h>

#include <utility>

#include "harness/iut/user_line.hpp"

namespace fieldproof::token_bus {

AttachedChannelManager::AttachedChannelManager(iut::Attachment attachment,
                                               const ChannelManagerConfiguration& configuration,
                                               const std::string& case_id, std::uint64_t seed)
    : AttachedSides("a channel manager", std::move(attachment),
                    {case_id, seed, channel_manager_settings(configuration)}) {}

void AttachedChannelManager::wire(segment::Port& mac, segment::Port& a, segment::Port& b,
                                  ChannelListener& listener) {
  wire_ports({&mac, &a, &b});
  listener_ = &listener;
}

void AttachedChannelManager::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  if (item != iut::kEvent) return AttachedSides::write(item, value, when);
  attached().expect_supplied();
  attached().expect_in_order(when, "reports an event");
  const std::uint64_t kind = value & 0xFF;
  for (const Channel channel : kChannels) {
    if (kind < kChannelEventKinds && value >> 8 == port_of(channel))
      return listener_->on_channel_event({static_cast<ChannelEventKind>(kind), channel}, when);
  }
  iut::refuse_impossible(fmt::format("reports {:X}h as an event; there are kinds 0 to {} of channels 1 and 2",
                                     value, kChannelEventKinds - 1));
}

bool ServedChannelManager::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  make(channel_manager_configuration_of(begin), bench);
  station().wire(port(kTowardsMac), port(port_of(Channel::a)), port(port_of(Channel::b)), *this);
  return true;
}

void ServedChannelManager::on_channel_event(const ChannelEvent& event, kernel::Time when) {
  bench().write(iut::kEvent,
                static_cast<std::uint64_t>(event.kind) | std::uint64_t{port_of(event.channel)} << 8,
                not_past(when));
}

}  // namespace fieldproof::token_bus
