#include "harness/segment/stop.hpp"

#include <cstdint>
#include <utility>

namespace fieldproof::segment {
namespace {

// A look at the token costs some nanoseconds, an event of a line often no more.
constexpr std::uint32_t kEventsBetweenLooks = 1024;

thread_local const std::stop_token* stop_of_thread = nullptr;
thread_local std::uint32_t events = 0;

}  // namespace

StopScope::StopScope(std::stop_token stop)
    : stop_(std::move(stop)), before_(std::exchange(stop_of_thread, &stop_)) {}

StopScope::~StopScope() {
  stop_of_thread = before_;
}

void give_up_if_stopped() {
  if (++events % kEventsBetweenLooks != 0 || stop_of_thread == nullptr) return;
  if (stop_of_thread->stop_requested()) throw Interrupted{};
}

}  // namespace fieldproof::segment
