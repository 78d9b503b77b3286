#include "cli/attachments.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "cli/serial_pool.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/iut/pool.hpp"
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

  iut::DevicePool& of(const std::string& uri) {
    const std::scoped_lock lock(mutex_);
    auto& pool = pools_[uri];
    if (pool == nullptr) pool = pool_of(uri, role_);
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

valve_bus::NodeAttachment attachment_of(Pools& pools, const std::string& uri) {
  if (is_in_process(uri)) {
    const std::shared_ptr<iut::Device> device =
        iut::load_plugin(plugin_path(uri), pools.role().protocol, pools.role().role);
    return {device.get(), device, {}};
  }
  const auto lease = std::make_shared<iut::DevicePool::Lease>(pools.of(uri).take());
  return {&**lease, lease, [lease] { lease->set_reusable(); }};
}

}  // namespace

bool is_attachment(std::string_view uri) {
  return iut::DevicePool::is_meant(uri) || uri.starts_with(kPlugin) || uri.starts_with(iut::kSerialUri);
}

bool is_in_process(std::string_view uri) {
  return uri.starts_with(kPlugin) && uri.ends_with(kInProcess);
}

std::string plugin_path(std::string_view uri) {
  const std::size_t end = uri.size() - (is_in_process(uri) ? kInProcess.size() : 0);
  return std::string(uri.substr(kPlugin.size(), end - kPlugin.size()));
}

std::unique_ptr<iut::DevicePool> pool_of(const std::string& uri, const iut::RoleName& role) {
  if (!uri.starts_with(kPlugin)) return std::make_unique<iut::DevicePool>(uri, role);
  // This program itself loads it: one that crashes takes a process along that nobody misses.
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  return std::make_unique<iut::DevicePool>(
      uri, role, std::vector<std::string>{self, "station", role.protocol + "/" + role.role, uri});
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

conformance::ValveBusGiven::MakeNode attached_nodes() {
  const iut::RoleName role{"valve_bus", "node"};
  const auto pools = std::make_shared<Pools>(role);
  const auto lines = std::make_shared<SerialPool>(role);
  return [pools, lines](
             const conformance::ValveBusGiven::Wanted& wanted,
             const valve_bus::NodeConfiguration& configuration) -> std::unique_ptr<valve_bus::NodeDevice> {
    if (!is_attachment(wanted.uri)) return nullptr;
    if (wanted.uri.starts_with(iut::kSerialUri)) {
      return std::make_unique<valve_bus::SerialNode>(lines->take(wanted.uri), configuration, wanted.case_id,
                                                     wanted.seed);
    }
    return std::make_unique<valve_bus::AttachedNode>(attachment_of(*pools, wanted.uri), configuration,
                                                     wanted.case_id, wanted.seed);
  };
}

}  // namespace fieldproof::cli
