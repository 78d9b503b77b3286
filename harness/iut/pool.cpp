#include "harness/iut/pool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace fieldproof::iut {
namespace {

constexpr std::string_view kExec = "exec:";
constexpr std::string_view kUnix = "unix:";
constexpr std::string_view kTcp = "tcp:";

struct HostAndPort {
  std::string host;
  std::string port;
};

// "host:port", "[::1]:port".
HostAndPort host_and_port(const std::string& uri) {
  const std::string rest = uri.substr(kTcp.size());
  const std::size_t colon = rest.rfind(':');
  HostAndPort parts;
  if (colon != std::string::npos) parts = {rest.substr(0, colon), rest.substr(colon + 1)};
  if (parts.host.size() > 2 && parts.host.front() == '[' && parts.host.back() == ']') {
    parts.host = parts.host.substr(1, parts.host.size() - 2);
  }
  unsigned number = 0;
  const char* const last = parts.port.data() + parts.port.size();
  const auto [behind, failure] = std::from_chars(parts.port.data(), last, number);
  const bool is_port = failure == std::errc{} && behind == last && number >= 1 && number <= 65'535;
  if (parts.host.empty() || !is_port) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("'{}' names no port; write tcp:HOST:PORT, for example tcp:127.0.0.1:4850", uri));
  }
  return parts;
}

}  // namespace

bool DevicePool::is_meant(std::string_view uri) {
  return uri.starts_with(kExec) || uri.starts_with(kUnix) || uri.starts_with(kTcp);
}

DevicePool::DevicePool(std::string uri, RoleName role, PeerLimits limits)
    : uri_(std::move(uri)), role_(std::move(role)), limits_(limits) {
  if (uri_.starts_with(kExec)) {
    command_ = words_of(uri_.substr(kExec.size()));
  } else if (uri_.starts_with(kTcp)) {
    host_and_port(uri_);
  } else if (uri_ == kUnix) {
    throw kernel::Error(kernel::ErrorKind::usage, "'unix:' names no socket; write unix:/path/of/it");
  } else if (!uri_.starts_with(kUnix)) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("'{}' is no implementation in another process; write exec:, unix: or tcp:", uri_));
  }
}

Peer DevicePool::open() const {
  if (!command_.empty()) return Peer::spawned(uri_, command_);
  if (uri_.starts_with(kUnix)) return Peer::at_unix_socket(uri_, uri_.substr(kUnix.size()));
  const HostAndPort parts = host_and_port(uri_);
  return Peer::at_tcp_port(uri_, parts.host, parts.port, limits_.start);
}

std::vector<RoleName> DevicePool::served_roles(const RoleName& asked) const {
  Peer peer = open();
  return hello(peer, asked, limits_.start).roles;
}

std::unique_ptr<MessageDevice> DevicePool::started() {
  if (failed_starts_ >= kMostFailedStarts) {
    throw Misbehaviour(reasons::kCrashed,
                       fmt::format("{} is not started any more after {} starts that failed; the last one: {}",
                                   uri_, failed_starts_, last_failure_));
  }
  try {
    auto device = std::make_unique<MessageDevice>(open(), role_, limits_);
    if (!is_tested_) device->test_itself();
    is_tested_ = true;
    failed_starts_ = 0;
    return device;
  } catch (const kernel::Error& error) {
    ++failed_starts_;
    last_failure_ = error.what();
    throw;
  }
}

std::unique_ptr<MessageDevice> DevicePool::idle_or_waited_for() {
  std::unique_lock lock(mutex_);
  const auto has_none = [&] { return idle_.empty() && is_limited_ && leased_ > 0; };
  // Two cases that hold one each and wait for another would wait for each other.
  if (has_none() && holders_.contains(std::this_thread::get_id())) {
    throw kernel::Error(kernel::ErrorKind::implementation,
                        fmt::format("{} serves {} connections at the same time, and this case needs one more",
                                    uri_, leased_));
  }
  while (has_none()) returned_.wait(lock);
  ++leased_;
  holders_.insert(std::this_thread::get_id());
  if (idle_.empty()) return nullptr;
  std::unique_ptr<MessageDevice> device = std::move(idle_.back());
  idle_.pop_back();
  return device;
}

bool DevicePool::has_others() {
  const std::scoped_lock lock(mutex_);
  return leased_ > 1 || !idle_.empty();
}

// Who listens at a socket may serve so many connections and no more: the next case waits for one of them.
// Null when this is so, which who waits for its turn to start learns from the one before.
std::unique_ptr<MessageDevice> DevicePool::started_in_turn() {
  const std::scoped_lock lock(start_mutex_);
  const bool had_others = has_others();
  if (is_limited_ && had_others) return nullptr;
  try {
    return started();
  } catch (const kernel::Error&) {
    // Those that were in use when this one tried may have come back in the meantime.
    const bool is_one_too_many = command_.empty() && (had_others || has_others());
    if (!is_one_too_many) throw;
    failed_starts_ = 0;
    const std::scoped_lock lock_of_leases(mutex_);
    is_limited_ = true;
    return nullptr;
  }
}

void DevicePool::give_back(std::unique_ptr<MessageDevice> device, std::thread::id holder) {
  {
    const std::scoped_lock lock(mutex_);
    --leased_;
    if (const auto one = holders_.find(holder); one != holders_.end()) holders_.erase(one);
    if (device != nullptr) idle_.push_back(std::move(device));
  }
  returned_.notify_one();
}

DevicePool::Lease DevicePool::take() {
  while (true) {
    std::unique_ptr<MessageDevice> device = idle_or_waited_for();
    try {
      if (device == nullptr) {
        if (device = started_in_turn(); device != nullptr) return {*this, std::move(device)};
        give_back(nullptr);
        continue;
      }
      if (device->is_quiet()) return {*this, std::move(device)};
      if (device->peer().is_alive()) {
        device->peer().blame(reasons::kGarbage,
                             "has said something between two cases, when nothing was asked");
      }
      device->peer().blame(reasons::kDiedBetweenCases, "has died between two cases");
    } catch (const kernel::Error&) {
      give_back(nullptr);
      throw;
    }
  }
}

DevicePool::Lease::~Lease() {
  if (device_ != nullptr) pool_->give_back(is_reusable_ ? std::move(device_) : nullptr, holder_);
}

}  // namespace fieldproof::iut
