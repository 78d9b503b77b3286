#include "cli/networks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "cli/attachments.hpp"
#include "cli/implementations.hpp"
#include "cli/run_setup.hpp"
#include "conformance/fieldbus_dll/ff_mutants.hpp"
#include "conformance/fieldbus_dll/isa_mutants.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "conformance/valve_bus/host_mutants.hpp"
#include "conformance/valve_bus/node_mutants.hpp"
#include "emc/interbus/undetected_cycle.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/ff_network.hpp"
#include "protocols/fieldbus_dll/isa_network.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/running_network.hpp"

namespace fieldproof::cli {
namespace {

// The stations that `--iut` names, of all roles.
std::vector<conformance::Assignment> assignments_of(const Session& session) {
  const auto entries = session.catalogue.select(std::vector{session.operands.front() + "/**"});
  return parse_implementations(session.settings.list("iut"), session.catalogue, entries, kAnyPosition);
}

// Whom `--iut` puts where, of one role.
template <typename Kind>
class Seats {
 public:
  using Configuration = typename Kind::Configuration;

  Seats(const Session& session, std::size_t places)
      : limits_(limits_from(session.settings)),
        case_id_(fmt::format("{}/{}/network", Kind::protocol, Kind::role)),
        attach_(attachments()) {
    for (const conformance::Assignment& one : assignments_of(session)) {
      if (one.role != Kind::role) continue;
      const auto position = static_cast<std::size_t>(std::max(one.position, 1));
      if (position > places) {
        session.settings.refuse(
            "iut", fmt::format("'{}': the network has {} {}; write {}@1 to {}@{}", one.uri, places,
                               Kind::role, Kind::role, Kind::role, places));
      }
      if (one.uri != conformance::kReferenceUri) uris_[position] = one.uri;
    }
  }

  bool is_empty() const { return uris_.empty(); }

  // Null where a reference plays.
  std::unique_ptr<typename Kind::Device> make(
      std::size_t position, const Configuration& configuration, std::uint64_t seed,
      const conformance::DeviceMutants<typename Kind::Device, Configuration>& mutants) const {
    const auto at = uris_.find(position);
    if (at == uris_.end()) return nullptr;
    if (at->second.starts_with(conformance::kMutantUri)) {
      return mutants.make(conformance::mutant_of(at->second, "station"), configuration);
    }
    auto attachment = attach_({Kind::protocol, Kind::role}, {at->second, case_id_, seed, limits_});
    if (!attachment) {
      throw kernel::Error(kernel::ErrorKind::usage,
                          fmt::format("'{}' cannot take part in a network", at->second));
    }
    if (attachment->device->capabilities().is_wall_clock) {
      throw kernel::Error(
          kernel::ErrorKind::usage,
          fmt::format("'{}': a network runs in virtual time, and a serial line does not", at->second));
    }
    return std::make_unique<typename Kind::Attached>(std::move(*attachment), configuration, case_id_, seed);
  }

 private:
  iut::PeerLimits limits_;
  std::string case_id_;  // that an implementation outside is given
  conformance::Attach attach_;
  std::map<std::size_t, std::string> uris_;  // by position
};

// What is named in --iut takes part or the call is refused.
void expect_roles(const Session& session, std::span<const std::string_view> roles) {
  for (const conformance::Assignment& one : assignments_of(session)) {
    if (one.uri == conformance::kReferenceUri && one.role.empty()) continue;
    if (std::ranges::find(roles, one.role) != roles.end()) continue;
    session.settings.refuse("iut", fmt::format("'{}' has no place in this network; write {}=URI or {}@N=URI",
                                               one.uri, fmt::join(roles, "=URI, "), roles.front()));
  }
}

class PlannedInterbus final : public PlannedNetwork {
 public:
  explicit PlannedInterbus(const Session& session)
      : network_(network_from(session.settings)),
        slaves_(session, interbus::ring_order(network_).size()),
        masters_(session, 1),
        latch_(latch_from(session.settings)) {
    static constexpr std::array<std::string_view, 2> kRoles = {"slave", "master"};
    expect_roles(session, kRoles);
  }

  std::string name() const override { return network_.name; }
  std::string default_profile() const override { return "A"; }
  std::string_view exchange() const override { return "cycle"; }

  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    interbus::RunningStations stations;
    stations.latch = latch_;
    if (!masters_.is_empty()) {
      stations.make_master = [this, seed](const interbus::MasterConfiguration& configuration) {
        return masters_.make(1, configuration, seed, conformance::master_mutants());
      };
    }
    if (!slaves_.is_empty()) {
      stations.make_slave = [this, seed](int position, const interbus::SlaveConfiguration& configuration) {
        return slaves_.make(static_cast<std::size_t>(position), configuration, seed,
                            conformance::slave_mutants());
      };
    }
    return std::make_unique<interbus::RunningNetwork>(network_, stations);
  }

  std::vector<UndetectedPart> undetected(double flip_probability) const override {
    const emc::UndetectedCycle parts = emc::undetected_cycle(network_, flip_probability);
    return {
        {"code_word", parts.by_code_word}, {"shift", parts.by_shift}, {"misframing", parts.by_misframing}};
  }
  std::vector<std::string> undetected_caveats() const override {
    return {
        "That a flipped header level moves the end of the data, and how often a check fits then, follows "
        "from "
        "this project's reading of the header: the simulated stations and the theory share it."};
  }

 private:
  static interbus::NetworkDescription network_from(const Settings& settings) {
    if (settings.is_set("network")) return interbus::NetworkDescription::load(settings.text("network"));
    interbus::NetworkDescription network = interbus::paper_network();
    network.cycle_time = interbus::kPaperBestCycle;
    return network;
  }

  static interbus::LatchModel latch_from(const Settings& settings) {
    constexpr std::array kModels = {interbus::LatchModel::same_instant, interbus::LatchModel::frame_edges,
                                    interbus::LatchModel::previous_frame};
    return kModels.at(settings.choice("latch"));
  }

  interbus::NetworkDescription network_;
  Seats<interbus::SlaveRole> slaves_;
  Seats<interbus::MasterRole> masters_;
  interbus::LatchModel latch_;
};

void refuse_latch(const Settings& settings) {
  if (settings.origin("latch") != Origin::command_line) return;
  settings.refuse("latch", "only slaves of INTERBUS have a latch model; leave it out");
}

class PlannedValveBus final : public PlannedNetwork {
 public:
  explicit PlannedValveBus(const Session& session)
      : network_(network_from(session.settings)), nodes_(session, network_.nodes.size()), hosts_(session, 1) {
    static constexpr std::array<std::string_view, 2> kRoles = {"node", "host"};
    expect_roles(session, kRoles);
    refuse_latch(session.settings);
  }

  std::string name() const override { return network_.name; }
  std::string default_profile() const override { return "A"; }
  std::string_view exchange() const override { return "poll of a node"; }

  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    valve_bus::RunningStations stations;
    stations.make_host = [this, seed](const valve_bus::HostConfiguration& configuration) {
      return hosts_.make(1, configuration, seed, conformance::host_mutants());
    };
    stations.make_node = [this, seed](std::size_t position,
                                      const valve_bus::NodeConfiguration& configuration) {
      return nodes_.make(position, configuration, seed, conformance::node_mutants());
    };
    return std::make_unique<valve_bus::RunningNetwork>(network_, seed, stations);
  }

 private:
  static valve_bus::NetworkDescription network_from(const Settings& settings) {
    if (settings.is_set("network")) return valve_bus::NetworkDescription::load(settings.text("network"));
    constexpr unsigned kNodes = 8;
    valve_bus::NetworkDescription network = valve_bus::NetworkDescription::even(0, kNodes, 1000);
    network.copy.push_back({1, 2});
    return network;
  }

  valve_bus::NetworkDescription network_;
  Seats<valve_bus::NodeRole> nodes_;
  Seats<valve_bus::HostRole> hosts_;
};

// Lines of IEC 61158-2: the weakest signal of 31.25 kbit/s, and a fast line.
std::string profile_of(const fieldbus_dll::LinkDescription& link) {
  constexpr std::int64_t kSlow = 31'250;
  return link.bit_rate == kSlow ? "E2" : "F";
}

class PlannedFoundation final : public PlannedNetwork {
 public:
  PlannedFoundation(const Session& session, fieldbus_dll::LinkDescription link)
      : link_(std::move(link)),
        masters_(session, link_.masters.size()),
        devices_(session, link_.devices.size()) {
    static constexpr std::array<std::string_view, 2> kRoles = {"ff_device", "ff_las"};
    expect_roles(session, kRoles);
  }

  std::string name() const override { return link_.name; }
  std::string default_profile() const override { return profile_of(link_); }
  std::string_view exchange() const override { return "item of the schedule"; }

  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    using fieldbus_dll::FfConfiguration;
    using fieldbus_dll::FfDevice;
    fieldbus_dll::FfStations stations;
    stations.make_master = [this, seed](std::size_t position, const FfConfiguration& configuration) {
      return masters_.make(position, configuration, seed, conformance::ff_las_mutants());
    };
    stations.make_device = [this, seed](std::size_t position, const FfConfiguration& configuration) {
      return devices_.make(position, configuration, seed, conformance::ff_device_mutants());
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
  PlannedIsa(const Session& session, fieldbus_dll::LinkDescription link)
      : link_(std::move(link)),
        masters_(session, link_.masters.size()),
        devices_(session, link_.devices.size()) {
    static constexpr std::array<std::string_view, 2> kRoles = {"isa_dle", "isa_las"};
    expect_roles(session, kRoles);
  }

  std::string name() const override { return link_.name; }
  std::string default_profile() const override { return profile_of(link_); }
  std::string_view exchange() const override { return "delegation of the token"; }

  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    using fieldbus_dll::IsaConfiguration;
    using fieldbus_dll::IsaDevice;
    fieldbus_dll::IsaStations stations;
    stations.make_master = [this, seed](std::size_t position, const IsaConfiguration& configuration) {
      return masters_.make(position, configuration, seed, conformance::isa_las_mutants());
    };
    stations.make_device = [this, seed](std::size_t position, const IsaConfiguration& configuration) {
      return devices_.make(position, configuration, seed, conformance::isa_dle_mutants());
    };
    return std::make_unique<fieldbus_dll::IsaNetwork>(link_, seed, stations);
  }

 private:
  fieldbus_dll::LinkDescription link_;
  Seats<fieldbus_dll::IsaLasRole> masters_;
  Seats<fieldbus_dll::IsaDleRole> devices_;
};

// The profile is that of the file, else that of the roles that `--iut` names.
std::unique_ptr<PlannedNetwork> plan_link(const Session& session) {
  const Settings& settings = session.settings;
  refuse_latch(settings);
  using fieldbus_dll::LinkDescription;
  using fieldbus_dll::LinkProfile;
  const std::vector<std::string>& texts = settings.list("iut");
  const bool is_isa =
      std::ranges::any_of(texts, [](const std::string& text) { return text.starts_with("isa_"); });
  LinkDescription link = settings.is_set("network")
                             ? LinkDescription::load(settings.text("network"))
                             : LinkDescription::built_in(is_isa ? LinkProfile::isa : LinkProfile::foundation);
  if (link.profile == LinkProfile::isa) return std::make_unique<PlannedIsa>(session, std::move(link));
  return std::make_unique<PlannedFoundation>(session, std::move(link));
}

template <typename Planned>
std::unique_ptr<PlannedNetwork> planned(const Session& session) {
  return std::make_unique<Planned>(session);
}

constexpr std::array kRows = {
    NetworkRow{"interbus", "of the cycle-time paper", &planned<PlannedInterbus>},
    NetworkRow{"valve_bus", "of 8 nodes on 1000 m", &planned<PlannedValveBus>},
    NetworkRow{"fieldbus_dll", "of two link masters and 4 devices", &plan_link},
};

}  // namespace

const NetworkRow& network_row_of(const Session& session, std::string_view verb) {
  const std::string& protocol = session.operands.front();
  const auto row = std::ranges::find(kRows, protocol, &NetworkRow::protocol);
  if (row != kRows.end()) return *row;
  std::vector<std::string_view> names;
  for (const NetworkRow& one : kRows) names.push_back(one.protocol);
  throw kernel::Error(kernel::ErrorKind::usage, fmt::format("'{}' runs no network of '{}'; there are '{}'",
                                                            verb, protocol, fmt::join(names, "', '")));
}

}  // namespace fieldproof::cli
