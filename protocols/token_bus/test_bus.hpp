#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/token_bus/token_station.hpp"

// For tests: stations on one line, and somebody who drives what the test needs. What stations drive is kept
// as text, "@40 token, 000A -> 0004", in octet durations from the start.
namespace fieldproof::token_bus {

class TestBus : private segment::Station {
 public:
  class User final : public StationUser {
   public:
    void on_data(const Frame& frame, kernel::Time) override { text += describe(frame, rules) + "\n"; }
    void on_event(const Event& event, kernel::Time) override {
      text += std::string(text_of(event.kind)) + " " + text_of(event.address, rules) + "\n";
    }
    std::string take() { return std::exchange(text, {}); }

    Rules rules{};
    std::string text{};
  };

  explicit TestBus(const Rules& rules = {}) : rules_(rules), reader_(rules) {
    place_ = &line_.attach("test/in", segment_.attach(*this, "test"), 0, {});
  }

  User& add(StationDevice& station, kernel::Duration position = {}) {
    User& user = users_.emplace_back();
    user.rules = rules_;
    seats_.push_back(segment_.attach(station, "station"));
    segment::MediumPort& place =
        line_.attach("station/in" + std::to_string(seats_.back()), seats_.back(), 0, position);
    place.sense_activity();
    station.wire(place, user);
    return user;
  }
  // Something outside of the segment changed a station.
  void refresh() {
    for (const std::size_t seat : seats_) segment_.refresh(seat);
  }
  kernel::Time now() const { return segment_.now(); }
  std::int64_t octets_now() const { return (now() - kernel::kStart) / octets(rules_, 1); }
  void wait(std::int64_t octet_times) { segment_.run_for(octets(rules_, octet_times)); }
  void wait_slots(std::int64_t count) { segment_.run_for(slots(rules_, count)); }

  // From now on, and until it is over.
  void drive(const Frame& frame) { drive_levels(levels_of(frame, rules_)); }
  void drive_levels(line::Levels levels) {
    line::Waveform wave{now(), 2 * rules_.phy_bit_rate, std::move(levels)};
    const kernel::Time end = wave.end();
    place_->drive(wave);
    segment_.run_until(end);
  }
  // Symbols without a start delimiter.
  void drive_noise(std::size_t octet_times) {
    drive_levels(half_bits_of(MacSymbols(8 * octet_times, MacSymbol::zero)));
  }
  // What stations have driven since the last call.
  std::string take() { return std::exchange(text_, {}); }

 private:
  void receive(segment::PortIndex, const line::Waveform& wave) override {
    for (const Reception& one : reader_.read(wave)) {
      const auto frame = one.kind == ReceptionKind::frame ? frame_of(one.octets, rules_) : std::nullopt;
      text_ += "@" + std::to_string((wave.start - kernel::kStart) / octets(rules_, 1)) + " " +
               (frame ? describe(*frame, rules_) : std::string(text_of(one.kind))) + "\n";
    }
  }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  Rules rules_;
  FrameReader reader_;
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  segment::MediumPort* place_ = nullptr;
  std::vector<std::size_t> seats_;
  std::deque<User> users_;
  std::string text_;
};

inline Frame control(FrameKind kind, Address destination, Address source) {
  return {.kind = kind, .destination = destination, .source = source};
}
inline Frame with_address(FrameKind kind, Address destination, Address source, Address data) {
  Frame frame = control(kind, destination, source);
  frame.data = octets_of(data, Rules{});
  return frame;
}

}  // namespace fieldproof::token_bus
