#include "cli/attachments.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "harness/iut/plugin.hpp"
#include "harness/iut/pool.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"

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
    if (pool == nullptr) pool = made(uri);
    return *pool;
  }
  const iut::RoleName& role() const { return role_; }

 private:
  std::unique_ptr<iut::DevicePool> made(const std::string& uri) const {
    if (!uri.starts_with(kPlugin)) return std::make_unique<iut::DevicePool>(uri, role_);
    // This program itself loads it: one that crashes takes a process along that nobody misses.
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    return std::make_unique<iut::DevicePool>(
        uri, role_, std::vector<std::string>{self, "station", role_.protocol + "/" + role_.role, uri});
  }

  iut::RoleName role_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<iut::DevicePool>> pools_;
};

iut::Attachment attachment_of(Pools& pools, const std::string& uri) {
  if (uri.starts_with(kPlugin) && uri.ends_with(kInProcess)) {
    const std::string path = uri.substr(kPlugin.size(), uri.size() - kPlugin.size() - kInProcess.size());
    const std::shared_ptr<iut::Device> device =
        iut::load_plugin(path, pools.role().protocol, pools.role().role);
    return {device.get(), device, {}};
  }
  const auto lease = std::make_shared<iut::DevicePool::Lease>(pools.of(uri).take());
  return {&**lease, lease, [lease] { lease->set_reusable(); }};
}

// Makes what takes the place of a station of the bench in this role.
template <typename Attached, typename Make>
Make attached(iut::RoleName role) {
  const auto pools = std::make_shared<Pools>(std::move(role));
  return [pools](const conformance::Wanted& wanted, const auto& configuration) -> Make::result_type {
    if (!is_attachment(wanted.uri)) return nullptr;
    return std::make_unique<Attached>(attachment_of(*pools, wanted.uri), configuration, wanted.case_id,
                                      wanted.seed);
  };
}

}  // namespace

bool is_attachment(std::string_view uri) {
  return iut::DevicePool::is_meant(uri) || uri.starts_with(kPlugin);
}

conformance::GivenSlaves::Make attached_slaves() {
  return attached<interbus::AttachedSlave, conformance::GivenSlaves::Make>({"interbus", "slave"});
}

conformance::GivenNodes::Make attached_nodes() {
  return attached<valve_bus::AttachedNode, conformance::GivenNodes::Make>({"valve_bus", "node"});
}

conformance::GivenHosts::Make attached_hosts() {
  return attached<valve_bus::AttachedHost, conformance::GivenHosts::Make>({"valve_bus", "host"});
}

}  // namespace fieldproof::cli
