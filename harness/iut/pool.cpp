#include "harness/iut/pool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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
  const bool has_digits =
      !parts.port.empty() && std::ranges::all_of(parts.port, [](char c) { return c >= '0' && c <= '9'; });
  if (parts.host.empty() || !has_digits) {
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

DevicePool::Lease DevicePool::take() {
  const std::scoped_lock lock(mutex_);
  if (idle_.empty()) return {*this, started()};
  std::unique_ptr<MessageDevice> device = std::move(idle_.back());
  idle_.pop_back();
  if (device->is_quiet()) return {*this, std::move(device)};
  if (device->peer().is_alive()) {
    device->peer().blame(reasons::kGarbage, "has said something between two cases, when nothing was asked");
  }
  device->peer().blame(reasons::kDiedBetweenCases, "has died between two cases");
}

DevicePool::Lease::~Lease() {
  if (device_ == nullptr || !is_reusable_) return;
  const std::scoped_lock lock(pool_->mutex_);
  pool_->idle_.push_back(std::move(device_));
}

}  // namespace fieldproof::iut
