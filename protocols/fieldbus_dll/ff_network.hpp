#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "protocols/fieldbus_dll/ff_device.hpp"
#include "protocols/fieldbus_dll/link_network.hpp"

// A running link of the profile FF-P: link masters, the first of which schedules, and devices. Words are
// published buffers; the scheduler publishes its own without a call. Cycles: the macrocycle, and the rotation
// of the token (from a pass to the first device to the next pass to it).
namespace fieldproof::fieldbus_dll {

// Who plays; null, or a null from them: the references. Positions count from 1, masters and devices each.
struct FfStations {
  using Make = std::function<std::unique_ptr<FfDevice>(std::size_t position, const FfConfiguration&)>;
  Make make_master{};
  Make make_device{};
};

class FfNetwork final : public LinkNetwork {
 public:
  FfNetwork(const LinkDescription& description, std::uint64_t seed, const FfStations& stations = {});

  std::vector<network::ProtectedFrame> protected_frames() const override;
  std::shared_ptr<const trace::Dissector> dissector() const override;

 private:
  // The applications of one station.
  class User final : public FfUser {
   public:
    explicit User(FfNetwork& network) : network_(network) {}
    void on_data(const FfDlpdu&, kernel::Time) override {}
    void on_published(const FfDlpdu& dlpdu, kernel::Time when) override {
      network_.on_published(*this, dlpdu, when);
    }
    void on_event(const FfEvent&, kernel::Time) override {}

   private:
    FfNetwork& network_;
  };
  struct Station {
    std::uint8_t node = 0;
    FfConfiguration configuration;
    std::unique_ptr<FfDevice> device;
    std::unique_ptr<User> user;
  };

  void add(std::uint8_t node, std::size_t position, const std::string& name, const FfStations::Make& make,
           bool is_master);
  FfConfiguration configuration_of(std::uint8_t node, bool is_master) const;
  void on_published(const User& user, const FfDlpdu& dlpdu, kernel::Time when);
  void find_addresses();
  bool has_master(std::uint8_t node) const;
  std::vector<network::CycleKind> kinds() const;

  void power_up(kernel::Time now) override;
  void power_down(kernel::Time now) override;
  void on_driven(const Octets& octets, kernel::Time begin, kernel::Time end) override;
  void give(std::size_t signal, std::uint16_t word, kernel::Time now) override;
  kernel::Duration answer_time() const override;
  kernel::Duration least_delay(std::size_t signal) const override;

  FfRules rules_;
  std::deque<Station> stations_;
  std::vector<FfAddress> addresses_;  // of the buffers, by signal
  std::map<FfAddress, std::size_t> signal_of_address_;
};

}  // namespace fieldproof::fieldbus_dll
