#include "cli/attachments.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "harness/iut/plugin.hpp"
#include "harness/iut/pool.hpp"
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

valve_bus::NodeAttachment attachment_of(Pools& pools, const std::string& uri) {
  if (uri.starts_with(kPlugin) && uri.ends_with(kInProcess)) {
    const std::string path = uri.substr(kPlugin.size(), uri.size() - kPlugin.size() - kInProcess.size());
    const std::shared_ptr<iut::Device> device =
        iut::load_plugin(path, pools.role().protocol, pools.role().role);
    return {device.get(), device, {}};
  }
  const auto lease = std::make_shared<iut::DevicePool::Lease>(pools.of(uri).take());
  return {&**lease, lease, [lease] { lease->set_reusable(); }};
}

}  // namespace

bool is_attachment(std::string_view uri) {
  return iut::DevicePool::is_meant(uri) || uri.starts_with(kPlugin);
}

conformance::GivenNodes::Make attached_nodes() {
  const auto pools = std::make_shared<Pools>(iut::RoleName{"valve_bus", "node"});
  return
      [pools](const conformance::Wanted& wanted,
              const valve_bus::NodeConfiguration& configuration) -> std::unique_ptr<valve_bus::NodeDevice> {
        if (!is_attachment(wanted.uri)) return nullptr;
        return std::make_unique<valve_bus::AttachedNode>(attachment_of(*pools, wanted.uri), configuration,
                                                         wanted.case_id, wanted.seed);
      };
}

}  // namespace fieldproof::cli
