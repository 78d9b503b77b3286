// A character to an implementation in this process: after the functions of fieldproof_plugin.h in a shared
// library, beside the same node called directly.
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "bench/rows.hpp"
#include "harness/iut/device.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/valve_bus/attached_node.hpp"

extern "C" {
#include "examples/valve_node/valve_node.h"
}

namespace fieldproof::bench {
namespace {

constexpr std::uint64_t kFrames = 400;
constexpr kernel::Duration kCharacter = 30 * kernel::kMicrosecond;
constexpr kernel::Duration kSilence = kernel::kMillisecond;
// A write to another node: it is collected, checked and left alone.
constexpr std::array<std::uint16_t, 5> kFrame{0x163, 0x100, 0x112, 0x134, 0x145};

// A station of ours that calls the functions of the firmware itself, as one that is compiled in would: each
// call tells the bench when the next one is wanted.
class DirectDevice final : public iut::Device {
 public:
  iut::UnitKind unit_kind() const override { return iut::UnitKind::characters; }
  bool begin(const iut::CaseBegin& begin, iut::Bench&) override {
    bench_.write = [](void*, unsigned, fieldproof_word, fieldproof_time) {};
    node_.bench = &bench_;
    std::vector<fieldproof_setting> settings;
    for (const auto& [name, value] : begin.settings) settings.push_back({name.c_str(), value});
    const fieldproof_case test_case{begin.id.c_str(), begin.seed, settings.data(),
                                    static_cast<unsigned>(settings.size())};
    valve_node_begin(&node_, &test_case);
    return true;
  }
  void set_power(bool is_on, kernel::Time now) override {
    next_time_ = time(valve_node_power(&node_, is_on ? 1 : 0, ticks(now)));
  }
  void receive(unsigned, std::span<const iut::Character> characters, kernel::Time now) override {
    for (const iut::Character& one : characters) {
      const fieldproof_character heard{ticks(one.start), ticks(one.busy_until), one.data, one.is_parity_wrong,
                                       one.is_stop_missing};
      next_time_ = time(valve_node_receive(&node_, &heard, 1, ticks(now)));
    }
  }
  void receive(unsigned, const line::Waveform&) override {}
  void on_time(kernel::Time now) override { next_time_ = time(valve_node_on_time(&node_, ticks(now))); }
  kernel::Time next_time() const override { return next_time_; }
  void end() override {}

 private:
  static fieldproof_time ticks(kernel::Time at) { return at.time_since_epoch().count(); }
  static kernel::Time time(fieldproof_time ticks) { return kernel::Time{kernel::Duration{ticks}}; }

  fieldproof_bench bench_{};
  valve_node node_{};
  kernel::Time next_time_{};
};

class NoActs final : public iut::Bench {
  void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override {}
  void transmit(unsigned, line::Waveform&) override {}
  void write(iut::Item, std::uint64_t, kernel::Time) override {}
  std::uint64_t read(iut::Item, kernel::Time) override { return 0; }
};

// Frames of characters and the silence after each.
Batch frames_to(std::shared_ptr<iut::Device> device) {
  const auto bench = std::make_shared<NoActs>();
  device->begin({"valve_bus/node/bench/call", 0, valve_bus::node_settings({})}, *bench);
  device->set_power(true, kernel::kStart);
  return [device, bench, now = kernel::kStart + kSilence]() mutable -> std::uint64_t {
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
      for (const std::uint16_t data : kFrame) {
        const iut::Character character{now, now + kCharacter, data, false, false};
        now += kCharacter;
        device->receive(0, std::span(&character, 1), now);
        FIELDPROOF_CHECK(device->next_time() != kernel::kNever, "the node waits for silence");
      }
      device->on_time(now += kSilence);
    }
    return kFrames * kFrame.size();
  };
}

Batch frames_to_plugin() {
  return frames_to(iut::load_plugin(FIELDPROOF_VALVE_NODE_PLUGIN, "valve_bus", "node"));
}

Batch frames_to_direct() {
  return frames_to(std::make_shared<DirectDevice>());
}

constexpr const char* kGroup = "one character to a node in this process";

const Rows kPluginRows({
    {kGroup, "direct: its functions", "characters", "", 0, frames_to_direct},
    {kGroup, "plugin: in-process", "characters", "direct", 0.83, frames_to_plugin},
});

}  // namespace
}  // namespace fieldproof::bench
