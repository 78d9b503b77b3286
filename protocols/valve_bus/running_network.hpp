#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/network/attendance.hpp"
#include "harness/network/network.hpp"
#include "harness/network/turnaround.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/device.hpp"
#include "protocols/valve_bus/network.hpp"
#include "protocols/valve_bus/poll_cycle.hpp"
#include "protocols/valve_bus/valve_block.hpp"

// A valve bus that runs: the host, its PC, and the nodes along the cable, in a segment of its own. The PC
// works through the nodes in the order of the cable, again and again: it writes valves, reads limit switches,
// and copies what it has read where the description says so.
//
// An exchange is the poll of one node, from its first command to the response; it ends when the response has
// been reported to the PC and a write in it must have reached the valves. Whether data are exchanged at all
// is decided on the line: a node must have driven it, lately, besides what the host reports, and each station
// under test once.
//
// Signals: of each node its valves, where the PC writes them, then its limit switches. Exposed are the host
// and the nodes on its segment; what lies after a repeater has a segment of its own.
namespace fieldproof::valve_bus {

// Who plays; null, or a null from them: the references. Nodes count from 1 in the order of the cable.
struct RunningStations {
  std::function<std::unique_ptr<HostDevice>(const HostConfiguration&)> make_host{};
  std::function<std::unique_ptr<NodeDevice>(std::size_t position, const NodeConfiguration&)> make_node{};
};

class RunningNetwork final : public network::Network, private HostApplication, private segment::Station {
 public:
  RunningNetwork(const NetworkDescription& description, std::uint64_t seed,
                 const RunningStations& stations = {});

  const std::string& name() const override { return description_.name; }
  segment::Segment& segment() override { return segment_; }
  void start() override;
  void stop() override;
  network::State state() const override;
  kernel::Duration bring_up_limit() const override;
  std::string complaint() const override { return attendance_.complaint(); }
  std::span<const network::Place> places() const override { return places_; }
  std::span<const network::CycleKind> cycles() const override { return cycles_; }
  network::RecoveryLimit recovery_limit() const override;
  network::ExchangeWords exchange_words() const override;
  std::vector<measure::Condition> conditions() const override;
  std::vector<network::ProtectedFrame> protected_frames() const override;
  std::shared_ptr<const trace::Dissector> dissector() const override;
  std::span<const network::Signal> signals() const override { return signals_; }
  void set_source(std::size_t signal, std::uint16_t word) override;
  void set_source_function(std::size_t signal, std::function<std::uint16_t(kernel::Time)> word) override;
  std::uint16_t image(std::size_t signal) const override;
  std::vector<network::CopiedPath> paths() const override;
  void watch(network::ExchangeWatcher& watcher) override { watcher_ = &watcher; }
  void end() override;

 private:
  // Notes when the line is driven.
  struct Driven final : segment::Tap {
    void on_wave(const line::Waveform& wave) override { last = wave.start; }
    std::optional<kernel::Time> last{};
  };
  // Counts on the line how often the host reads each node: that it has tried again is not its own word.
  class HostDrives final : public segment::Tap {
   public:
    explicit HostDrives(RunningNetwork& network);
    void on_wave(const line::Waveform& wave) override;

   private:
    void take_frame();

    RunningNetwork& network_;
    CharacterCodec codec_;
    FrameCollector collector_;
    kernel::Time end_{};  // of the last character
  };
  struct Seat {
    NodeDescription description;
    kernel::Duration way{};  // from the host
    std::unique_ptr<NodeDevice> device;
    ValveBlock block;
    std::size_t number = 0;  // in the segment
    std::size_t first_signal = 0;
    bool is_written = false;
    std::optional<network::Turnaround> turnaround{};  // of one under test
    std::size_t turnaround_kind = 0;                  // among the cycles
    // The PC's side.
    std::uint16_t valves = 0;  // to write next
    bool is_given = false;     // `valves` comes from outside, not from a copy
    std::uint16_t switches = 0;
    bool is_open = false;  // an exchange with it is going on
    bool is_read = false;  // its read is queued and not answered
    bool is_closing = false;
    network::Outcome outcome = network::Outcome::served;
    kernel::Time asked{};  // when the read was queued
    unsigned reads = 0;    // seen on the line in this exchange
  };
  struct Closing {
    kernel::Time at;
    std::size_t node;
  };

  void add_node(const NodeDescription& node, const RunningStations& stations);
  void plan_steps();
  void find_signals();
  void find_cycle();
  void find_turnaround_times();
  kernel::Duration begin_of(const PollStep& step) const;
  bool is_copied_to(unsigned address) const;
  std::size_t index_of(unsigned address) const;
  Seat* seat_of(std::uint8_t id);

  // The PC.
  void on_response(const HostResponse& response, kernel::Time when) override;
  void on_error(const HostError& error, kernel::Time when) override;
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return wakes_at_; }
  void wake();
  void give_up_lost(kernel::Time now);
  void ask_next(kernel::Time now);
  bool may_ask(const PollStep& step) const;
  void close_later(Seat& seat, network::Outcome outcome);
  void close(std::size_t node, kernel::Time now);
  Rules rules_on_line() const;
  kernel::Duration longest_silence() const;
  kernel::Duration longest_exchange() const;
  kernel::Duration longest_queue() const;

  NetworkDescription description_;
  kernel::Random random_;
  segment::Segment segment_;
  segment::Medium line_;
  network::Attendance attendance_;  // of those under test
  std::unique_ptr<HostDevice> host_;
  std::size_t host_number_;
  HostDrives host_drives_;
  std::deque<Seat> seats_;
  Driven node_drives_;
  std::vector<network::Place> places_;
  std::vector<network::Signal> signals_;
  std::vector<network::CycleKind> cycles_;
  std::vector<PollStep> steps_;
  PollCycle steady_cycle_;
  std::size_t next_step_ = 0;
  bool is_held_back_ = false;  // the PC, by commands that wait in the host
  std::size_t pc_number_;
  std::deque<Closing> closings_;
  kernel::Time wakes_at_ = kernel::kNever;
  bool is_on_ = false;
  kernel::Time started_{};
  bool has_response_ = false;  // since the last start
  network::ExchangeWatcher* watcher_ = nullptr;
};

}  // namespace fieldproof::valve_bus
