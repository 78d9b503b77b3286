#include "conformance/fieldbus_dll/planned_network.hpp"

#include <array>

#include "conformance/fieldbus_dll/ff_mutants.hpp"
#include "conformance/fieldbus_dll/isa_mutants.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/ff_network.hpp"
#include "protocols/fieldbus_dll/isa_network.hpp"

namespace fieldproof::conformance {
namespace {

// Lines of IEC 61158-2: the weakest signal of 31.25 kbit/s, and a fast line.
std::string profile_of(const fieldbus_dll::LinkDescription& link) {
  constexpr std::int64_t kSlow = 31'250;
  return link.bit_rate == kSlow ? "E2" : "F";
}

class PlannedFoundation final : public PlannedNetwork {
 public:
  PlannedFoundation(const NetworkRequest& request, fieldbus_dll::LinkDescription link)
      : link_(std::move(link)),
        masters_(request, link_.masters.size()),
        devices_(request, link_.devices.size()) {
    static constexpr std::array<std::string_view, 2> kRoles = {"ff_device", "ff_las"};
    expect_roles(request, kRoles);
  }

  std::string name() const override { return link_.name; }
  std::string default_profile() const override { return profile_of(link_); }
  std::string_view exchange() const override { return "item of the schedule"; }

  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    using fieldbus_dll::FfConfiguration;
    using fieldbus_dll::FfDevice;
    fieldbus_dll::FfStations stations;
    stations.make_master = [this, seed](std::size_t position, const FfConfiguration& configuration) {
      return masters_.make(position, configuration, seed, ff_las_mutants());
    };
    stations.make_device = [this, seed](std::size_t position, const FfConfiguration& configuration) {
      return devices_.make(position, configuration, seed, ff_device_mutants());
    };
    return std::make_unique<fieldbus_dll::FfNetwork>(link_, seed, stations);
  }

 private:
  fieldbus_dll::LinkDescription link_;
  Seats<fieldbus_dll::FfLasRole> masters_;
  Seats<fieldbus_dll::FfDeviceRole> devices_;
};

class PlannedIsa final : public PlannedNetwork {
 public:
  PlannedIsa(const NetworkRequest& request, fieldbus_dll::LinkDescription link)
      : link_(std::move(link)),
        masters_(request, link_.masters.size()),
        devices_(request, link_.devices.size()) {
    static constexpr std::array<std::string_view, 2> kRoles = {"isa_dle", "isa_las"};
    expect_roles(request, kRoles);
  }

  std::string name() const override { return link_.name; }
  std::string default_profile() const override { return profile_of(link_); }
  std::string_view exchange() const override { return "delegation of the token"; }

  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    using fieldbus_dll::IsaConfiguration;
    using fieldbus_dll::IsaDevice;
    fieldbus_dll::IsaStations stations;
    stations.make_master = [this, seed](std::size_t position, const IsaConfiguration& configuration) {
      return masters_.make(position, configuration, seed, isa_las_mutants());
    };
    stations.make_device = [this, seed](std::size_t position, const IsaConfiguration& configuration) {
      return devices_.make(position, configuration, seed, isa_dle_mutants());
    };
    return std::make_unique<fieldbus_dll::IsaNetwork>(link_, seed, stations);
  }

 private:
  fieldbus_dll::LinkDescription link_;
  Seats<fieldbus_dll::IsaLasRole> masters_;
  Seats<fieldbus_dll::IsaDleRole> devices_;
};

}  // namespace

// The profile is that of the file, else that of the roles that play.
std::unique_ptr<PlannedNetwork> plan_link(const NetworkRequest& request) {
  using fieldbus_dll::LinkDescription;
  using fieldbus_dll::LinkProfile;
  const bool is_isa = std::ranges::any_of(request.implementations,
                                          [](const Assignment& one) { return one.role.starts_with("isa_"); });
  LinkDescription link = request.file.empty()
                             ? LinkDescription::built_in(is_isa ? LinkProfile::isa : LinkProfile::foundation)
                             : LinkDescription::load(request.file);
  if (link.profile == LinkProfile::isa) return std::make_unique<PlannedIsa>(request, std::move(link));
  return std::make_unique<PlannedFoundation>(request, std::move(link));
}

}  // namespace fieldproof::conformance
