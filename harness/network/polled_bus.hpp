#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/line/character.hpp"
#include "harness/network/attendance.hpp"
#include "harness/network/network.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "harness/segment/station.hpp"

// A network of one master, which is this class, and the responders that a protocol adds: the master asks one
// of them in each slot, in turn, and takes a word of its answer. A protocol that needs more of its master
// writes a Network of its own.
//
// An exchange is a slot. It ends when the next one begins: served when the first answer that came in it was
// right. Each responder has one signal, an input with an image in the master; the bus has not come up before
// each has driven the line.
namespace fieldproof::network {

struct PolledBusSettings {
  std::string name;
  std::int64_t bit_rate = 0;
  line::CharacterFormat format{};
  kernel::Duration slot{};
  unsigned bits = 16;  // of the word of an answer
  std::vector<ProtectedFrame> frames{};
};

class PolledBus : public Network, private segment::Station {
 public:
  PolledBus(PolledBusSettings settings, std::uint64_t seed);

  const std::string& name() const override { return settings_.name; }
  segment::Segment& segment() override { return segment_; }
  void start() override;
  void stop() override;
  State state() const override;
  kernel::Duration bring_up_limit() const override { return 4 * cycle(); }
  std::string complaint() const override { return attendance_.complaint(); }
  std::span<const Place> places() const override { return places_; }
  std::span<const CycleKind> cycles() const override { return cycles_; }
  RecoveryLimit recovery_limit() const override;
  std::vector<ProtectedFrame> protected_frames() const override { return settings_.frames; }
  std::span<const Signal> signals() const override { return signals_; }
  void set_source(std::size_t signal, std::uint16_t word) override;
  void set_source_function(std::size_t signal, std::function<std::uint16_t(kernel::Time)> word) override;
  std::uint16_t image(std::size_t signal) const override { return seats_[signal].image; }
  std::vector<CopiedPath> paths() const override { return {}; }
  void watch(ExchangeWatcher& watcher) override { watcher_ = &watcher; }
  void end() override;

 protected:
  // The next responder, so far from the master; before the first start. Gives what it drives.
  segment::Port& add(std::string name, segment::Station& responder, kernel::Duration distance = {});
  // What the responder number n, from 0, has to send now.
  std::uint16_t source(std::size_t n, kernel::Time now) const;

 private:
  // What the master sends to a responder.
  virtual line::Waveform request(std::size_t n, kernel::Time now) = 0;
  // Of an answer that came whole and right from it.
  virtual std::optional<std::uint16_t> word_in(std::size_t n, const line::Waveform& answer) = 0;

  struct Seat {
    segment::Station* station;
    std::function<std::uint16_t(kernel::Time)> source{};
    std::uint16_t image = 0;  // as the master knows
  };

  kernel::Duration cycle() const { return settings_.slot * static_cast<std::int64_t>(seats_.size()); }
  void add_place(segment::MediumPort& place);
  void receive(segment::PortIndex, const line::Waveform& wave) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return next_; }

  PolledBusSettings settings_;
  segment::Segment segment_;
  segment::Medium line_;
  Attendance attendance_;
  std::size_t number_;
  segment::MediumPort& master_;
  std::deque<Seat> seats_;
  std::vector<Place> places_;
  std::vector<Signal> signals_;
  std::vector<CycleKind> cycles_;
  std::optional<std::size_t> slot_;
  Outcome outcome_ = Outcome::missing;
  kernel::Time started_{};
  kernel::Time next_ = kernel::kNever;
  std::optional<kernel::Time> answered_;
  ExchangeWatcher* watcher_ = nullptr;
};

}  // namespace fieldproof::network
