#include "cli/serial_pool.hpp"

#include <optional>

namespace fieldproof::cli {
namespace {

constexpr unsigned kLatencyRounds = 200;

}  // namespace

// One case at a box: its line is free again when nobody uses this any more.
struct SerialPool::Use {
  explicit Use(Box& taken) : box(taken), lock(taken.in_use) {}
  ~Use() {
    // What the case has left in the line, or of it, is not the next one's.
    if (!is_well) box.line.reset();
  }

  Box& box;
  std::unique_lock<std::mutex> lock;
  std::optional<iut::DevicePool::Lease> upper;
  std::unique_ptr<iut::WallClockDevice> device;
  bool is_well = false;
};

SerialPool::Box& SerialPool::box(const std::string& uri, const iut::PeerLimits& limits) {
  const std::scoped_lock lock(mutex_);
  auto& found = boxes_[uri];
  if (found == nullptr) {
    auto made = std::make_unique<Box>();
    made->settings = iut::serial_settings(uri);
    const std::string& upper = made->settings.upper;
    if (!upper.empty()) made->upper = std::make_unique<iut::DevicePool>(upper, role_, limits);
    made->latency = made->settings.latency.value_or(2 * iut::measured_latency(kLatencyRounds));
    found = std::move(made);
  }
  return *found;
}

iut::Attachment SerialPool::take(const std::string& uri, const iut::PeerLimits& limits) {
  const auto use = std::make_shared<Use>(box(uri, limits));
  Box& box = use->box;
  iut::SerialAttachment at;
  if (box.upper != nullptr) {
    use->upper.emplace(box.upper->take());
    at.upper = &**use->upper;
  }
  if (box.line == nullptr) box.line = std::make_unique<iut::SerialLine>(box.settings.path, iut::WallClock());
  box.line->set_echo(box.settings.receives_own_echo);
  at.line = box.line.get();
  at.latency = box.latency;
  use->device = std::make_unique<iut::WallClockDevice>(at, make_uart_);
  return {use->device.get(), use, [use] {
            use->is_well = true;
            if (use->upper) use->upper->set_reusable();
          }};
}

}  // namespace fieldproof::cli
