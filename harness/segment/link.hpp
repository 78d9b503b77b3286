#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/kernel/scheduler.hpp"
#include "harness/segment/receiver.hpp"
#include "harness/segment/station.hpp"
#include "harness/trace/trace.hpp"

// A one-way link from one driver to one receiver with a propagation delay: one direction of a segment of a
// ring. Several transmissions may be on their way at once. A channel (faults) may change what arrives; taps
// hear what was driven, or what arrives.
namespace fieldproof::segment {

class Segment;

class Link final : public Port, public Receiver, private kernel::Timer {
 public:
  // Made by Segment::connect.
  Link(Segment& segment, std::string name, std::size_t receiver, PortIndex port, kernel::Duration delay);

  void drive(line::Waveform& wave) override;

  const std::string& name() const;
  trace::Channel trace_channel() const { return trace_channel_; }
  kernel::Duration delay() const { return delay_; }

  void tap_driven(Tap& tap) { driven_taps_.push_back(&tap); }
  void tap_arrived(Tap& tap) { arrived_taps_.push_back(&tap); }

  // A link that is not connected carries nothing to its receiver: an open ring, a cable that was cut.
  void set_connected(bool connected) { connected_ = connected; }
  bool is_connected() const { return connected_; }

  // End of the last transmission that was driven.
  kernel::Time driven_until() const { return driven_until_; }
  // Transmissions that began before the one before them had ended.
  std::uint64_t overlap_count() const { return overlap_count_; }

 private:
  struct InFlight {
    line::Waveform wave;  // start is the instant of arrival
    bool passed = false;  // has gone through the channel
  };

  void on_time(kernel::Time now) override;
  void arrive(InFlight& flight);
  void launch(line::Waveform& wave, kernel::Time arrival, bool passed);
  void deliver(const line::Waveform& wave);
  void arm();

  Segment& segment_;
  std::size_t receiver_;
  PortIndex port_;
  kernel::Duration delay_;
  trace::Channel trace_channel_;
  kernel::SlotId slot_;
  bool connected_ = true;
  std::vector<Tap*> driven_taps_;
  std::vector<Tap*> arrived_taps_;
  std::vector<InFlight> queue_;  // sorted by arrival from head_ on; before head_ lie buffers for reuse
  std::size_t head_ = 0;
  std::size_t tail_ = 0;
  InFlight arriving_;  // what the receiver is being told
  line::Waveforms arrivals_;
  kernel::Time driven_until_{kernel::Duration::min()};
  std::uint64_t overlap_count_ = 0;
};

}  // namespace fieldproof::segment
