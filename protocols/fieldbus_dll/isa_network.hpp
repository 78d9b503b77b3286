#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "protocols/fieldbus_dll/isa_device.hpp"
#include "protocols/fieldbus_dll/link_network.hpp"

// A running link of the profile ISA-D: link masters, the first of which schedules, and devices. A word is
// what a device sends (DU) under the token that the scheduler delegates to it for a duration (ES), which
// calls for what waits there longest. Cycles: the period of the schedule, and the rotation of the token (from
// a delegation for the first word to the next for it).
namespace fieldproof::fieldbus_dll {

// Who plays; null, or a null from them: the references. Positions count from 1, masters and devices each.
struct IsaStations {
  using Make = std::function<std::unique_ptr<IsaDevice>(std::size_t position, const IsaConfiguration&)>;
  Make make_master{};
  Make make_device{};
};

class IsaNetwork final : public LinkNetwork {
 public:
  IsaNetwork(const LinkDescription& description, std::uint64_t seed, const IsaStations& stations = {});

  // A station without a token takes part by a word that it gets.
  std::vector<network::ProtectedFrame> protected_frames() const override;
  std::shared_ptr<const trace::Dissector> dissector() const override;

 private:
  class User final : public IsaUser {
   public:
    User(IsaNetwork& network, std::uint8_t node) : network_(network), node_(node) {}
    void on_data(const IsaDlpdu& dlpdu, kernel::Time when) override { network_.on_data(node_, dlpdu, when); }
    void on_event(const IsaEvent&, kernel::Time) override {}
    bool is_reply_coming(Priority, kernel::Time) override { return false; }

   private:
    IsaNetwork& network_;
    std::uint8_t node_;
  };
  struct Station {
    std::uint8_t node = 0;
    std::unique_ptr<IsaDevice> device;
    std::unique_ptr<User> user;
  };

  void add(std::uint8_t node, std::size_t position, const std::string& name, const IsaStations::Make& make,
           bool is_master);
  void on_data(std::uint8_t node, const IsaDlpdu& dlpdu, kernel::Time when);
  std::size_t called_by_token(std::uint8_t node) const;
  std::uint16_t token_octets() const;
  std::vector<network::CycleKind> kinds() const;

  void power_up(kernel::Time now) override;
  void power_down(kernel::Time now) override;
  void on_driven(const Octets& octets, kernel::Time begin, kernel::Time end) override;
  void give(std::size_t signal, std::uint16_t word, kernel::Time now) override;
  kernel::Duration answer_time() const override;
  kernel::Duration least_delay(std::size_t signal) const override;

  IsaRules rules_;
  std::deque<Station> stations_;
  std::deque<std::size_t> waiting_;  // signals submitted and not seen on the line yet, the first goes first
};

}  // namespace fieldproof::fieldbus_dll
