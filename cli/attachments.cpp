#include "cli/attachments.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "harness/iut/pool.hpp"
#include "protocols/valve_bus/attached_node.hpp"

namespace fieldproof::cli {
namespace {

// The pools of one role, by URI.
class Pools {
 public:
  explicit Pools(iut::RoleName role) : role_(std::move(role)) {}

  iut::DevicePool& of(const std::string& uri) {
    const std::scoped_lock lock(mutex_);
    auto& pool = pools_[uri];
    if (pool == nullptr) pool = std::make_unique<iut::DevicePool>(uri, role_);
    return *pool;
  }

 private:
  iut::RoleName role_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<iut::DevicePool>> pools_;
};

}  // namespace

conformance::ValveBusGiven::MakeNode attached_nodes() {
  const auto pools = std::make_shared<Pools>(iut::RoleName{"valve_bus", "node"});
  return
      [pools](const conformance::ValveBusGiven::Wanted& wanted,
              const valve_bus::NodeConfiguration& configuration) -> std::unique_ptr<valve_bus::NodeDevice> {
        if (!iut::DevicePool::is_meant(wanted.uri)) return nullptr;
        const auto lease = std::make_shared<iut::DevicePool::Lease>(pools->of(wanted.uri).take());
        return std::make_unique<valve_bus::AttachedNode>(
            valve_bus::NodeAttachment{&**lease, lease, [lease] { lease->set_reusable(); }}, configuration,
            wanted.case_id, wanted.seed);
      };
}

}  // namespace fieldproof::cli
