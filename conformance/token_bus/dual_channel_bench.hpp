#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/token_bus/mac_player.hpp"
#include "conformance/token_bus/sides_bench.hpp"
#include "conformance/token_bus/translator_sides.hpp"
#include "protocols/token_bus/dual_channel_device.hpp"
#include "protocols/token_bus/service_signals.hpp"

// The bench of one case for a dual channel manager: the implementation under test (IUT) between the MAC of
// IEEE 802.4 and the translators of two channels, all three played by testers. Verdicts rest on what it
// drives on its three sides, and on the faults that it reports.
namespace fieldproof::conformance {

using token_bus::Channel;

struct ManagerNeeds {
  void (*adjust)(token_bus::ChannelManagerConfiguration&) = nullptr;
};

using ManagerSetting =
    PlannedSetting<token_bus::ChannelManagerDevice, token_bus::ChannelManagerConfiguration>;

// What a channel carries, as letters, and so many symbols later than the bench begins.
struct ChannelText {
  std::string symbols{};
  std::int64_t later = 0;
  std::int64_t parts_per_million = 0;  // of its clock
};

class ManagerBench final
    : public SidesBench<token_bus::ChannelManagerDevice, token_bus::ChannelManagerConfiguration>,
      private token_bus::ChannelListener {
 public:
  ManagerBench(const ManagerNeeds& needs, const ManagerSetting& setting);

  kernel::Duration request_delay() const { return symbols(configuration().delay_symbols); }
  kernel::Duration indication_delay() const {
    return symbols(token_bus::indication_delay_symbols(configuration()));
  }
  kernel::Duration slot() const { return token_bus::slots(configuration().rules, 1); }

  // ---- the MAC; each runs until what is requested is over ----
  void request(std::string_view symbols);
  void command(SideCommand command, std::size_t symbols);
  // And does not wait for the end; the same of what channels carry.
  kernel::Time begin_request(std::string_view symbols);

  // A station of a ring in the place of the MAC, from now on; it begins anew.
  void begin_ring(token_bus::Address address);

  // ---- both channels, until what they carry is over ----
  void carry(const ChannelText& on_a, const ChannelText& on_b);
  kernel::Time begin_carrying(const ChannelText& on_a, const ChannelText& on_b);

  // Until everything has come out, and each fault has been found, though it be late.
  void settle() { wait(2 * slot() + 4 * indication_delay()); }
  void clear();
  void clear_requests();
  // Since the last `clear`.
  const SideLog& requested(Channel channel) const { return requested_[static_cast<std::size_t>(channel)]; }
  const SideLog& indicated() const { return indicated_; }
  // "A: no start delimiter".
  const std::vector<std::string>& events() const { return events_; }
  // Of the last one.
  kernel::Time last_event() const { return last_event_; }

  // ---- what else a bench does ----
  std::vector<std::string> decode_lines() const;
  // What it must answer: a request.
  void ask();

 private:
  void on_driven(segment::PortIndex port, const line::Waveform& wave) override;
  void on_channel_event(const token_bus::ChannelEvent& event, kernel::Time when) override;
  std::int64_t rate() const { return token_bus::mac_side_rate(configuration().rules.phy_bit_rate); }

  std::array<SideLog, 2> requested_;
  SideLog indicated_;
  segment::Link& mac_in_;
  std::array<segment::Link*, 2> channel_in_;
  segment::Link& mac_out_;
  std::array<segment::Link*, 2> channel_out_;
  std::vector<std::string> events_;
  kernel::Time last_event_{};
  std::unique_ptr<MacPlayer> mac_;  // where a ring runs
  std::size_t mac_seat_ = 0;
};

}  // namespace fieldproof::conformance
