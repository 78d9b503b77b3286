#include "protocols/bandwidth/window_link.hpp"

#include <deque>
#include <string>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/bandwidth/window_load.hpp"

namespace fieldproof::bandwidth {
namespace {

using kernel::Duration;
using kernel::Time;

// The queues of the simulation, whose time begins at the origin of slots.
class LoadedQueues final : public OtherQueues {
 public:
  LoadedQueues(const WindowTraffic& traffic, const WindowRun& run, Time origin)
      : slot_(traffic),
        real_time_(traffic, traffic.real_time, run.real_time, traffic.real_time_packet,
                   kernel::Random(run.seed).split("real-time")),
        non_real_time_(traffic, traffic.non_real_time, run.non_real_time, traffic.non_real_time_packet,
                       kernel::Random(run.seed).split("non-real-time")),
        before_(origin - kernel::kStart) {}

  bool has_real_time(std::uint8_t node, Time now) override {
    slot_.advance(now - before_);
    return real_time_.is_at(node) && real_time_.offers(node, now - before_, slot_);
  }
  bool has_non_real_time(std::uint8_t node, Time now) override {
    return non_real_time_.is_at(node) && non_real_time_.offers(node, now - before_, slot_);
  }
  void on_packet(Packet packet, std::uint8_t node, Time end) override {
    if (packet == Packet::periodic) slot_.on_sent_periodic();
    if (packet == Packet::real_time) real_time_.on_sent(node, end - before_);
    if (packet == Packet::non_real_time) non_real_time_.on_sent(node, end - before_);
  }

 private:
  SlotView slot_;
  QueueSet real_time_;
  QueueSet non_real_time_;
  Duration before_;
};

class WindowLink : private segment::Tap {
 public:
  WindowLink(const WindowTraffic& traffic, const WindowLineRules& rules, const WindowRun& run)
      : traffic_(traffic),
        rules_(rules),
        line_(segment_, "line", segment::ContentionRule::noise, kernel::Random(run.seed).split("line")),
        origin_(kernel::kStart + (rules.is_polled ? traffic.overhead : Duration::zero())),
        counts_from_(origin_ + static_cast<std::int64_t>(slots_of_start(traffic)) * traffic.slot),
        end_(counts_from_ + static_cast<std::int64_t>(run.slots) * traffic.slot),
        queues_(traffic_, run, origin_) {
    line_.tap_driven(*this);
    for (unsigned node = 0; node < traffic.nodes; ++node) {
      const auto next = static_cast<std::uint8_t>((node + 1) % traffic.nodes);
      nodes_.emplace_back(rules, WindowNode::Setting{static_cast<std::uint8_t>(node), next}, queues_,
                          sampler_of(static_cast<std::uint8_t>(node)));
      seat(nodes_.back(), "node " + std::to_string(node), !rules.is_polled && node == run.first_node);
    }
    if (!rules.is_polled) return;
    masters_.emplace_back(rules, traffic.nodes, run.first_node);
    seat(masters_.back(), "master", true);
  }

  LinkRun run() {
    segment_.run_until(end_);
    found_.origin = origin_;
    for (const LoopTraffic& loop : traffic_.loops) {
      for (const std::uint8_t node : {loop.sensor, loop.controller})
        found_.books.push_back(nodes_[node].sampler()->books());
    }
    return std::move(found_);
  }

 private:
  template <typename Station>
  void seat(Station& station, const std::string& name, bool begins) {
    const std::size_t number = segment_.attach(station, name);
    station.wire(line_.attach(name, number, 0, {}));
    if (!begins) return;
    station.begin(kernel::kStart);
    segment_.refresh(number);
  }

  std::optional<WindowSampler> sampler_of(std::uint8_t node) const {
    for (const LoopTraffic& loop : traffic_.loops) {
      const bool is_controller = loop.controller == node;
      if (!is_controller && loop.sensor != node) continue;
      const Duration first = is_controller ? loop.controller_offset * traffic_.slot + loop.skew
                                           : loop.sensor_offset * traffic_.slot;
      return WindowSampler({.is_controller = is_controller,
                            .first = origin_ + first,
                            .period = loop.every * traffic_.slot,
                            .destination = is_controller ? node : loop.controller},
                           counts_from_);
    }
    return std::nullopt;
  }

  void on_wave(const line::Waveform& wave) override {
    for (const Octets& octets : line::checked_frames_in(wave, rules_.bit_rate)) {
      const auto frame = window_frame_of(octets);
      if (!frame || frame->type != FrameType::data || wave.start >= end_) continue;
      const bool is_periodic = frame->packet == Packet::periodic;
      found_.sent.push_back({frame->packet, frame->source, wave.start - rules_.gap(), wave.end(),
                             is_periodic ? frame->generated : Time{Duration{-1}}, frame->byte});
    }
  }

  WindowTraffic traffic_;
  WindowLineRules rules_;
  segment::Segment segment_;
  segment::Medium line_;
  Time origin_;
  Time counts_from_;
  Time end_;
  LoadedQueues queues_;
  std::deque<WindowNode> nodes_;
  std::deque<WindowMaster> masters_;
  LinkRun found_;
};

}  // namespace

WindowTraffic on_line(WindowTraffic traffic, const WindowLineRules& rules) {
  traffic.overhead = rules.time_of(kServerOctets);
  traffic.empty_answer = rules.is_polled ? rules.time_of(kServerOctets) : Duration::zero();
  traffic.periodic_packet = rules.time_of_packet(Packet::periodic);
  traffic.real_time_packet = rules.time_of_packet(Packet::real_time);
  traffic.non_real_time_packet = rules.time_of_packet(Packet::non_real_time);
  return traffic;
}

LinkRun run_window_link(const WindowTraffic& traffic, const WindowLineRules& rules, const WindowRun& run) {
  check(traffic);
  if (run.begins_in_packet || run.first_node >= traffic.nodes) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        "stations begin at a node of the line, and without a packet");
  }
  return WindowLink(traffic, rules, run).run();
}

}  // namespace fieldproof::bandwidth
