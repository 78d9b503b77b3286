#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/kernel/random.hpp"
#include "harness/network/attendance.hpp"
#include "harness/network/network.hpp"
#include "harness/network/word_exchanges.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/token_bus/device.hpp"

// A ring of the token bus as a file describes it, and one that runs.
//
//   { "name": "boiler", "stations": [2, 4, 6, 8],
//     "data": [ { "from": 2, "to": 4 }, { "from": 4, "to": 2 } ] }
//
// Each station with data sends a word for each of them under each token that it gets.
namespace fieldproof::token_bus {

struct RingData {
  Address from = 0;
  Address to = 0;
};

struct RingDescription {
  std::string name;
  std::vector<Address> stations;  // even: addresses of individuals
  std::vector<RingData> data;
  Rules rules{};

  // So many stations, each with a word for the next one.
  static RingDescription built_in(unsigned stations = 4);
  // Throw kernel::Error(configuration) with file, line, pointer and what would be right.
  static RingDescription load(const std::filesystem::path& path);
  static RingDescription read(const config::Value& root);
};

// The first thing in a description that no ring has, as a sentence with what would be right.
std::optional<std::string> violation_of(const RingDescription& ring);
// The most that a round of the token takes: all data, and a response window of each station.
kernel::Duration longest_rotation(const RingDescription& ring);

// Who plays; null, or a null from it: the references. Positions count from 1.
struct RingStations {
  std::function<std::unique_ptr<StationDevice>(std::size_t position, const StationConfiguration&)> make{};
};

// An exchange carries one word; it begins with the token for its source, as the lower tester sees it on the
// line, and ends when the word must be over. Served: the application of the destination has it. A token that
// is repeated is a retry of the exchange. Stopped: no source got the token for long, or a station under test
// drives no more.
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
  network::RecoveryLimit recovery_limit() const override;
  network::ExchangeWords exchange_words() const override {
    return {"words under a token", "", "words that were lost"};
  }
  std::vector<measure::Condition> conditions() const override;
  std::vector<network::ProtectedFrame> protected_frames() const override;
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
    void on_event(const Event&, kernel::Time) override {}

   private:
    RingNetwork& network_;
    Address address_;
  };
  struct Seat {
    Address address = 0;
    std::unique_ptr<StationDevice> device;
    std::unique_ptr<User> user;
    std::size_t number = 0;
  };

  void add(Address address, std::size_t position, const RingStations& stations);
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return wakes_at_; }
  void on_wave(const line::Waveform& wave) override;
  void on_token(Address destination, kernel::Time begin, kernel::Time end);
  void on_data(Address at, const Frame& frame, kernel::Time when);
  void give(std::size_t signal, kernel::Time now);
  void give_next(std::size_t signal, kernel::Time now);
  void set_wake();
  Seat& seat_of(Address address);

  RingDescription description_;
  kernel::Random random_;
  segment::Segment segment_;
  segment::Medium line_;
  FrameReader tester_;
  network::Attendance attendance_;
  std::deque<Seat> seats_;
  std::vector<network::Place> places_;
  std::vector<network::Signal> signals_;
  std::vector<network::CycleKind> cycles_;
  network::WordExchanges words_;
  std::vector<bool> waits_;  // by signal: submitted, and not seen on the line yet
  std::size_t tester_number_ = 0;
  bool has_tester_ = false;
  bool is_on_ = false;
  kernel::Time started_{};
  kernel::Time wakes_at_ = kernel::kNever;
  Address last_token_ = 0;  // for whom the last token was; 0: none yet
};

}  // namespace fieldproof::token_bus
