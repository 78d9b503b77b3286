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

valve_bus::SerialAttachment SerialPool::take(const std::string& uri, const iut::PeerLimits& limits) {
  const auto use = std::make_shared<Use>(box(uri, limits));
  Box& box = use->box;
  valve_bus::SerialAttachment attachment;
  if (box.upper != nullptr) {
    use->upper.emplace(box.upper->take());
    attachment.upper = &**use->upper;
  }
  if (box.line == nullptr) box.line = std::make_unique<iut::SerialLine>(box.settings.path, iut::WallClock());
  attachment.line = box.line.get();
  attachment.latency = box.latency;
  attachment.lease = use;
  attachment.on_well_ended = [use] {
    use->is_well = true;
    if (use->upper) use->upper->set_reusable();
  };
  return attachment;
}

}  // namespace fieldproof::cli
