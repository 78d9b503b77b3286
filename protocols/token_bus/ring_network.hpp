#pragma once

#include <array>
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
#include "harness/network/word_exchanges.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/token_bus/channel_pair.hpp"
#include "protocols/token_bus/device.hpp"
#include "protocols/token_bus/ring_bounds.hpp"
#include "protocols/token_bus/ring_flow.hpp"
#include "protocols/token_bus/ring_line.hpp"

// A ring that runs, as a RingDescription says.
namespace fieldproof::token_bus {

// Who plays; null, or a null from it: the references. Positions count from 1.
struct RingStations {
  std::function<std::unique_ptr<StationDevice>(std::size_t position, const StationConfiguration&)> make{};
};

// An exchange carries one datum of a flow, with a word in it. It begins when the application gives it to its
// MAC, and ends when it must be over: a slot time after it was on the line, with the response where it is
// confirmed, or when it was not sent for long. Served: the application of the destination has it. A token
// that is repeated while it waits, and each repetition, is a retry of the exchange. A confirmed datum that
// comes once more is dropped by the application of its destination, as this service has it; nothing else may
// come twice.
//
// Stopped: no source got the token for long, or a station under test drives no more.
class RingNetwork final : public network::Network, private segment::Station, private segment::Tap {
 public:
  RingNetwork(const RingDescription& description, std::uint64_t seed, const RingStations& stations = {});

  const std::string& name() const override { return description_.name; }
  segment::Segment& segment() override { return segment_; }
  void start() override;
  void stop() override;
  network::State state() const override;
  kernel::Duration bring_up_limit() const override;
  std::string complaint() const override;
  std::span<const network::Place> places() const override { return places_; }
  std::span<const network::CycleKind> cycles() const override { return cycles_; }
  std::vector<measure::Count> delivery_faults() const override;
  std::vector<measure::Count> remarks() const override;
  network::RecoveryLimit recovery_limit() const override;
  network::ExchangeWords exchange_words() const override {
    return {"data of the services", "", "data that were lost"};
  }
  std::vector<measure::Condition> conditions() const override;
  std::vector<network::ProtectedFrame> protected_frames() const override;
  std::shared_ptr<const trace::Dissector> dissector() const override;
  std::span<const network::Signal> signals() const override { return signals_; }
  void set_source(std::size_t signal, std::uint16_t word) override;
  void set_source_function(std::size_t signal, std::function<std::uint16_t(kernel::Time)> word) override;
  std::uint16_t image(std::size_t signal) const override;
  std::vector<network::CopiedPath> paths() const override;
  void watch(network::ExchangeWatcher& watcher) override { words_.watch(watcher); }
  void end() override;

 private:
  class User final : public StationUser {
   public:
    User(RingNetwork& network, Address address) : network_(network), address_(address) {}
    void on_data(const Frame& frame, kernel::Time when) override { network_.on_data(address_, frame, when); }
    void on_event(const Event& event, kernel::Time when) override {
      network_.on_event(address_, event, when);
    }

   private:
    RingNetwork& network_;
    Address address_;
  };
  struct Seat {
    Address address = 0;
    std::unique_ptr<StationDevice> device;
    std::unique_ptr<User> user;
    std::unique_ptr<ChannelPair> channels;                 // where there are two
    std::array<std::uint64_t, kChannels.size()> faults{};  // of each, reported since all data have come once
    std::size_t number = 0;
    bool has_had_token = false;                       // since the start
    std::optional<std::size_t> asks = {};             // the flow whose confirmed datum was sent last
    std::optional<network::Turnaround> turnaround{};  // of one under test
    std::size_t turnaround_kind = 0;                  // among the cycles
  };

  void list_cycles();
  void add(Address address, std::size_t position, const RingStations& stations);
  segment::MediumPort& attach(const std::string& name, std::size_t station, Channel channel,
                              std::size_t position);
  void connect(Seat& seat, const std::string& name, std::size_t position, bool is_under_test);
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return wakes_at_; }
  void on_wave(const line::Waveform& wave) override;
  void on_token(Address destination, kernel::Time begin, kernel::Time end);
  void on_data(Address at, const Frame& frame, kernel::Time when);
  void on_response(Seat& seat, const Frame& frame, kernel::Time when);
  void on_event(Address at, const Event& event, kernel::Time when);
  void on_datum(const Frame& frame, kernel::Time begin, kernel::Time end);
  void give(std::size_t signal, kernel::Time now);
  void close(std::size_t signal, kernel::Time now);
  void after_close(std::size_t signal, kernel::Time now);
  void count(Delivery delivery) { ++deliveries_by_kind_[static_cast<std::size_t>(delivery)]; }
  void begin_round(kernel::Time now);
  void begin_cuts(std::optional<kernel::Time> from);
  void set_wake();
  Seat& seat_of(Address address);
  kernel::Duration longest_period() const;

  RingDescription description_;
  RingBounds bounds_;
  kernel::Random random_;
  segment::Segment segment_;
  std::deque<RingLine> lines_;  // A, and B where there are two channels
  ChannelReader channel_reader_;
  FrameReader tester_;
  network::Attendance attendance_;
  std::deque<Seat> seats_;
  std::vector<network::Place> places_;
  std::vector<network::Signal> signals_;
  std::vector<network::CycleKind> cycles_;
  network::WordExchanges words_;
  std::array<std::size_t, kRingServices.size()> delay_kinds_{};  // by service; 0: none has it
  std::deque<RingFlow> flows_;                                   // by signal
  Deliveries deliveries_;
  std::array<std::uint64_t, kDeliveries> deliveries_by_kind_{};
  std::optional<kernel::Time> last_token_at_{};
  std::optional<kernel::Time> last_round_at_{};
  std::optional<kernel::Time> came_up_at_{};
  std::size_t cut_kind_ = 0;           // of rounds in which a channel was cut or repaired; 0: none is
  std::uint64_t repeated_tokens_ = 0;  // since then, too
  std::uint64_t claims_ = 0;
  std::size_t tester_number_ = 0;
  bool has_tester_ = false;
  bool is_on_ = false;
  kernel::Time started_{};
  kernel::Time wakes_at_ = kernel::kNever;
  Address last_token_ = 0;  // for whom the last token was; 0: none yet
};

}  // namespace fieldproof::token_bus
