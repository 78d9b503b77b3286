#pragma once

#include <memory>
#include <vector>

#include "harness/line/telegram.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/ring.hpp"

// A network that runs: the reference master of a description and the slaves on their cables, in a segment of
// its own, with the starts of the data cycles as they are heard on the master's output.
namespace fieldproof::interbus {

class LiveNetwork {
 public:
  explicit LiveNetwork(const NetworkDescription& network, const Ring::MakeSlave& make_slave = nullptr);
  LiveNetwork(const LiveNetwork&) = delete;
  LiveNetwork& operator=(const LiveNetwork&) = delete;

  segment::Segment& segment() { return segment_; }
  Master& master() { return master_; }
  Ring& ring() { return ring_; }
  MasterStatus status() const { return master_.status(); }

  // Powers up and waits until data cycles run; false when the network does not get there in ten seconds.
  bool bring_up();

  // Since `forget_starts`.
  const std::vector<kernel::Time>& data_cycle_starts() const { return listener_.starts; }
  void forget_starts() { listener_.starts.clear(); }

 private:
  struct Listener final : segment::Tap {
    explicit Listener(const Rules& rules) : code(line::shared_telegram_code(rules.telegram)) {}
    void on_wave(const line::Waveform& wave) override;

    const line::TelegramCode& code;
    std::vector<kernel::Time> starts;
  };

  segment::Segment segment_;
  Master master_;
  std::size_t master_seat_;
  Ring ring_;
  Listener listener_;
};

}  // namespace fieldproof::interbus
