#include "cli/attachments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "cli/roles.hpp"
#include "cli/serial_pool.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/iut/pool.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/serial_node.hpp"

namespace fieldproof::cli {
namespace {

constexpr std::string_view kPlugin = "plugin:";
constexpr std::string_view kInProcess = "?in-process";

// The pools of one role, by URI.
class Pools {
 public:
  explicit Pools(iut::RoleName role) : role_(std::move(role)) {}

  iut::DevicePool& of(const std::string& uri, const iut::PeerLimits& limits) {
    const std::scoped_lock lock(mutex_);
    auto& pool = pools_[uri];
    if (pool == nullptr) pool = pool_of(uri, role_, limits);
    return *pool;
  }
  const iut::RoleName& role() const { return role_; }

 private:
  iut::RoleName role_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<iut::DevicePool>> pools_;
};

// The words of a PICS for the format of a UART.
std::string characters_of(const std::string& uri, const line::CharacterFormat& format) {
  const std::string text = format.text();
  if (text == "8m1") return "P0";
  if (text == "8e1") return "P1";
  if (text == "8n1") return "P2";
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("'{}': no node of the valve bus talks in characters {}; there are 8m1 (a "
                                  "ninth bit of 1), 8e1 and 8n1",
                                  uri, text));
}

iut::Attachment attachment_of(Pools& pools, const conformance::IutRequest& wanted) {
  const std::string& uri = wanted.uri;
  if (is_in_process(uri)) {
    const std::shared_ptr<iut::Device> device = library_of(uri, pools.role());
    return {device.get(), device, {}};
  }
  const auto lease = std::make_shared<iut::DevicePool::Lease>(pools.of(uri, wanted.limits).take());
  return {&**lease, lease, [lease] { lease->set_reusable(); }};
}

// Makes what takes the place of a station of the bench in this role.
template <typename Attached, typename Make>
Make attached(iut::RoleName role) {
  const auto pools = std::make_shared<Pools>(std::move(role));
  return [pools](const conformance::IutRequest& wanted, const auto& configuration) -> Make::result_type {
    if (!is_attachment(wanted.uri)) return nullptr;
    return std::make_unique<Attached>(attachment_of(*pools, wanted), configuration, wanted.case_id,
                                      wanted.seed);
  };
}

}  // namespace

bool is_plugin_uri(std::string_view uri) {
  return uri.starts_with(kPlugin);
}

bool is_attachment(std::string_view uri) {
  return iut::DevicePool::is_meant(uri) || is_plugin_uri(uri) || uri.starts_with(iut::kSerialUri);
}

bool is_in_process(std::string_view uri) {
  return is_plugin_uri(uri) && uri.ends_with(kInProcess);
}

std::string plugin_path(std::string_view uri) {
  const std::size_t end = std::min(uri.find('?'), uri.size());
  const std::string path(uri.substr(kPlugin.size(), end - kPlugin.size()));
  if (path.empty() || (end != uri.size() && uri.substr(end) != kInProcess)) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("'{}' names no library; write plugin:./library.so, or with ?in-process "
                                    "behind it",
                                    uri));
  }
  return path;
}

std::unique_ptr<iut::Device> library_of(const std::string& uri, const iut::RoleName& role) {
  const auto row = std::ranges::find(roles(), role.protocol + "/" + role.role, &Role::path);
  FIELDPROOF_CHECK(row != roles().end(), "who attaches a library has a role for it");
  return iut::load_plugin(plugin_path(uri), role.protocol, role.role, row->told);
}

std::unique_ptr<iut::DevicePool> pool_of(const std::string& uri, const iut::RoleName& role,
                                         const iut::PeerLimits& limits) {
  if (!is_plugin_uri(uri)) return std::make_unique<iut::DevicePool>(uri, role, limits);
  plugin_path(uri);  // refuses before anything is started
  // This program itself loads it: one that crashes takes a process along that nobody misses.
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  return std::make_unique<iut::DevicePool>(
      uri, role, std::vector<std::string>{self, "station", role.protocol + "/" + role.role, uri}, limits);
}

std::optional<judge::Pics> node_on_real_line(const std::string& uri) {
  if (!uri.starts_with(iut::kSerialUri)) return std::nullopt;
  const iut::SerialSettings settings = iut::serial_settings(uri);
  judge::Pics pics;
  if (settings.bit_rate) pics.declare("bit_rate", *settings.bit_rate);
  if (settings.format) pics.declare("characters", characters_of(uri, *settings.format));
  // Without an upper channel the box is as it stands there.
  pics.declare("address_switches_can_be_set", !settings.upper.empty());
  pics.declare("power_can_be_switched", !settings.upper.empty());
  return pics;
}

conformance::GivenSlaves::Make attached_slaves() {
  return attached<interbus::AttachedSlave, conformance::GivenSlaves::Make>({"interbus", "slave"});
}

conformance::GivenMasters::Make attached_masters() {
  return attached<interbus::AttachedMaster, conformance::GivenMasters::Make>({"interbus", "master"});
}

conformance::GivenNodes::Make attached_nodes() {
  const iut::RoleName role{"valve_bus", "node"};
  return [in_lock_step = attached<valve_bus::AttachedNode, conformance::GivenNodes::Make>(role),
          lines = std::make_shared<SerialPool>(role)](
             const conformance::IutRequest& wanted,
             const auto& configuration) -> std::unique_ptr<valve_bus::NodeDevice> {
    if (!wanted.uri.starts_with(iut::kSerialUri)) return in_lock_step(wanted, configuration);
    return std::make_unique<valve_bus::SerialNode>(lines->take(wanted.uri, wanted.limits), configuration,
                                                   wanted.case_id, wanted.seed);
  };
}

conformance::GivenHosts::Make attached_hosts() {
  return attached<valve_bus::AttachedHost, conformance::GivenHosts::Make>({"valve_bus", "host"});
}

conformance::GivenIsaStations::Make attached_isa_stations(const std::string& role) {
  return attached<fieldbus_dll::AttachedIsaDevice, conformance::GivenIsaStations::Make>(
      {"fieldbus_dll", role});
}

conformance::GivenFfStations::Make attached_ff_stations(const std::string& role) {
  return attached<fieldbus_dll::AttachedFfDevice, conformance::GivenFfStations::Make>({"fieldbus_dll", role});
}

}  // namespace fieldproof::cli
