#pragma once

#include <string>

#include "protocols/token_bus/attached_sides.hpp"
#include "protocols/token_bus/dual_channel_settings.hpp"

// A dual channel manager between the bench and an implementation outside, in both directions: port 0 is
// towards the MAC, ports 1 and 2 are channels A and B. It is given the settings of channel_manager_settings,
// and writes each event as item iut::kEvent: its kind, and the port of the channel << 8.
namespace fieldproof::token_bus {

class AttachedChannelManager final : public AttachedSides<ChannelManagerDevice> {
 public:
  AttachedChannelManager(iut::Attachment attachment, const ChannelManagerConfiguration& configuration,
                         const std::string& case_id, std::uint64_t seed);

  void wire(segment::Port& mac, segment::Port& a, segment::Port& b, ChannelListener& listener) override;

 private:
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;

  ChannelListener* listener_ = nullptr;
};

class ServedChannelManager final : public ServedSides<ChannelManagerDevice, ChannelManagerConfiguration>,
                                   private ChannelListener {
 public:
  using ServedSides::ServedSides;

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;

 private:
  void on_channel_event(const ChannelEvent& event, kernel::Time when) override;
};

// The role as benches and attachments know it.
struct ChannelManagerRole {
  using Device = ChannelManagerDevice;
  using Configuration = ChannelManagerConfiguration;
  using Attached = AttachedChannelManager;
  using Served = ServedChannelManager;
  static constexpr const char* protocol = "token_bus";
  static constexpr const char* role = "channel_manager";
};

}  // namespace fieldproof::token_bus
