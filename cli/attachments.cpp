#include "cli/attachments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "cli/protocol_entry.hpp"
#include "cli/serial_pool.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/iut/pool.hpp"

namespace fieldproof::cli {
namespace {

constexpr std::string_view kPlugin = "plugin:";
constexpr std::string_view kInProcess = "?in-process";

// The pools of one role, by URI.
class Pools {
 public:
  explicit Pools(iut::RoleName role) : role_(std::move(role)) {}

  iut::Attachment attach(const conformance::IutRequest& request) {
    const std::string& uri = request.uri;
    if (uri.starts_with(iut::kSerialUri)) return at_line(uri, request.limits);
    if (is_in_process(uri)) {
      const std::shared_ptr<iut::Device> device = library_of(uri, role_);
      return {device.get(), device, {}};
    }
    const auto lease = std::make_shared<iut::DevicePool::Lease>(of(uri, request.limits).take());
    return {&**lease, lease, [lease] { lease->set_reusable(); }};
  }

 private:
  iut::DevicePool& of(const std::string& uri, const iut::PeerLimits& limits) {
    const std::scoped_lock lock(mutex_);
    auto& pool = pools_[uri];
    if (pool == nullptr) pool = pool_of(uri, role_, limits);
    return *pool;
  }
  iut::Attachment at_line(const std::string& uri, const iut::PeerLimits& limits) {
    const Role& role = role_named(role_.protocol + "/" + role_.role);
    if (role.uart == nullptr) {
      throw kernel::Error(kernel::ErrorKind::usage, fmt::format("'{}': {}", uri, no_serial_line_for(role)));
    }
    SerialPool* lines = nullptr;
    {
      const std::scoped_lock lock(mutex_);
      if (lines_ == nullptr) lines_ = std::make_unique<SerialPool>(role_, role.uart);
      lines = lines_.get();
    }
    return lines->take(uri, limits);
  }

  iut::RoleName role_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<iut::DevicePool>> pools_;
  std::unique_ptr<SerialPool> lines_;
};

// The protocol and the role that an id begins with.
std::string role_of(const std::string& case_id) {
  return case_id.substr(0, case_id.find('/', case_id.find('/') + 1));
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

std::string in_own_process(std::string_view uri) {
  if (is_in_process(uri)) uri.remove_suffix(kInProcess.size());
  return std::string(uri);
}

std::string plugin_path(std::string_view uri) {
  const std::size_t end = std::min(uri.find('?'), uri.size());
  const std::string path(uri.substr(kPlugin.size(), end - kPlugin.size()));
  if (path.empty() || (end != uri.size() && uri.substr(end) != kInProcess)) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("'{}' names no library; write plugin:./library.so, or with ?in-process "
                                    "after it",
                                    uri));
  }
  return path;
}

std::unique_ptr<iut::Device> library_of(const std::string& uri, const iut::RoleName& role) {
  const iut::UnitOffer units = role_named(role.path()).units;
  return iut::load_plugin(plugin_path(uri), role.protocol, role.role, units);
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

std::optional<judge::Pics> station_on_real_line(const std::string& uri, const std::string& case_id) {
  if (!uri.starts_with(iut::kSerialUri)) return std::nullopt;
  const iut::SerialSettings settings = iut::serial_settings(uri);
  const Role* role = find_role(role_of(case_id));
  // Another role is refused when it is attached.
  return role != nullptr && role->on_line != nullptr ? role->on_line(uri, settings) : judge::Pics{};
}

std::vector<iut::RoleName> served_among(const std::string& uri, std::span<const iut::RoleName> roles) {
  std::vector<iut::RoleName> served;
  std::vector<iut::RoleName> own;  // what it says of itself; a library is asked role by role
  std::exception_ptr refusal;
  const bool is_line = uri.starts_with(iut::kSerialUri);
  // A box without an upper channel does not say what it is.
  const std::string peer = is_line ? iut::serial_settings(uri).upper : uri;
  const bool is_peer = iut::DevicePool::is_meant(peer);
  if (is_peer) own = iut::DevicePool(peer, {}).served_roles();
  for (const iut::RoleName& role : roles) {
    const Role* row = find_role(role.path());
    bool is_served = false;
    if (is_peer) {
      is_served = std::ranges::find(own, role) != own.end();
    } else if (row == nullptr) {
      continue;  // a whole network is no implementation
    } else if (is_line) {
      is_served = row->uart != nullptr;
    } else {
      // A library that does not serve a role says so, and the process that loads it ends.
      try {
        is_served = !pool_of(uri, role)->served_roles(role).empty();
      } catch (const kernel::Error&) {
        refusal = std::current_exception();
      }
    }
    if (is_served) served.push_back(role);
  }
  if (served.empty() && refusal) std::rethrow_exception(refusal);
  return served;
}

std::string no_serial_line_for(const Role& role) {
  std::vector<std::string> known;
  for (const Role* one : roles())
    if (one->uart != nullptr) known.push_back(one->path());
  return fmt::format(
      "'{}' cannot be judged at a serial line: its line carries no characters of a UART; serial lines serve "
      "'{}'",
      role.path(), fmt::join(known, "' and '"));
}

conformance::Attach attachments() {
  struct All {
    std::mutex mutex;
    std::map<std::pair<std::string, std::string>, std::unique_ptr<Pools>> of_roles;
  };
  return [all = std::make_shared<All>()](
             const iut::RoleName& role,
             const conformance::IutRequest& request) -> std::optional<iut::Attachment> {
    if (!is_attachment(request.uri)) return std::nullopt;
    Pools* pools = nullptr;
    {
      const std::scoped_lock lock(all->mutex);
      auto& found = all->of_roles[{role.protocol, role.role}];
      if (found == nullptr) found = std::make_unique<Pools>(role);
      pools = found.get();
    }
    return pools->attach(request);
  };
}

}  // namespace fieldproof::cli
