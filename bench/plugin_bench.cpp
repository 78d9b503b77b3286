// A character to an implementation in this process: behind the functions of fieldproof_plugin.h in a shared
// library, beside the same node called directly.
#include <array>
#include <memory>

#include "bench/rows.hpp"
#include "harness/iut/device.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/kernel/check.hpp"

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

// Frames of characters and the silence behind each, to whoever takes `receive` and `on_time`.
template <typename Node>
std::uint64_t send_frames(Node& node, kernel::Time& now) {
  for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
    for (const std::uint16_t data : kFrame) {
      node.receive({now, now + kCharacter, data, false, false}, now + kCharacter);
      now += kCharacter;
    }
    FIELDPROOF_CHECK(node.next_time() != kernel::kNever, "the node waits for silence");
    now += kSilence;
    node.on_time(now);
  }
  return kFrames * kFrame.size();
}

// As the firmware's own tests would call it.
struct DirectNode {
  DirectNode() {
    static const fieldproof_bench bench{};
    node.bench = &bench;
    const fieldproof_case test_case{"valve_bus/node/bench/call", 0, nullptr, 0};
    valve_node_begin(&node, &test_case);
    valve_node_power(&node, 1, 0);
  }
  void receive(const iut::Character& character, kernel::Time at) {
    const fieldproof_character heard{character.start.time_since_epoch().count(),
                                     character.busy_until.time_since_epoch().count(), character.data, 0};
    valve_node_receive(&node, &heard, at.time_since_epoch().count());
  }
  void on_time(kernel::Time at) { valve_node_on_time(&node, at.time_since_epoch().count()); }
  kernel::Time next_time() const { return kernel::Time{kernel::Duration{valve_node_next_time(&node)}}; }

  valve_node node{};
};

class NoActs final : public iut::Bench {
  void transmit(const iut::Transmission&) override {}
  void transmit(unsigned, line::Waveform&) override {}
  void write(iut::Item, std::uint64_t, kernel::Time) override {}
  std::uint64_t read(iut::Item, kernel::Time) override { return 0; }
};

struct LoadedNode {
  LoadedNode() : device(iut::load_plugin(FIELDPROOF_VALVE_NODE_PLUGIN, "valve_bus", "node")) {
    device->begin({"valve_bus/node/bench/call", 0, {}}, bench);
    device->set_power(true, kernel::kStart);
  }
  void receive(const iut::Character& character, kernel::Time at) {
    device->receive(0, std::span(&character, 1), at);
  }
  void on_time(kernel::Time at) { device->on_time(at); }
  kernel::Time next_time() const { return device->next_time(); }

  NoActs bench;
  std::unique_ptr<iut::Device> device;
};

template <typename Node>
Batch frames_to() {
  const auto node = std::make_shared<Node>();
  return [node, now = kernel::kStart + kSilence]() mutable { return send_frames(*node, now); };
}

constexpr const char* kGroup = "one character to a node in this process";

const Rows kPluginRows({
    {kGroup, "direct: its functions", "characters", "", 0, frames_to<DirectNode>},
    {kGroup, "plugin: in-process", "characters", "direct", 0.83, frames_to<LoadedNode>},
});

}  // namespace
}  // namespace fieldproof::bench
