// Sixteen stations of the token bus at full fidelity: how much faster than a real line are they, and how much
// of their time is the line code?
//
// Each frame is encoded to half bits, driven, heard by all and decoded by each. One peer is real time; the
// other encodes and decodes the same frames, once and fifteen times, and does nothing else.
#include <cstdint>
#include <ctime>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/rows.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/token_bus/token_station.hpp"

namespace fieldproof::bench {
namespace {

using token_bus::Address;
using token_bus::Frame;
using token_bus::FrameReader;
using token_bus::Rules;

constexpr unsigned kStations = 16;
constexpr std::size_t kPayload = 64;
constexpr kernel::Duration kSlice = 5 * kernel::kMillisecond;

struct Unasked final : token_bus::StationUser {
  void on_data(const Frame&, kernel::Time) override { ++data; }
  void on_event(const token_bus::Event&, kernel::Time) override {}
  std::uint64_t data = 0;
};

// Keeps what is on the line.
class Listener final : public segment::Tap {
 public:
  void on_wave(const line::Waveform& wave) override {
    if (!keeps) return;
    const auto receptions = reader_.read(wave);
    if (receptions[0].kind == token_bus::ReceptionKind::frame)
      frames.push_back(*token_bus::frame_of(receptions[0].octets, Rules{}));
  }
  bool keeps = false;
  std::vector<Frame> frames{};

 private:
  FrameReader reader_{Rules{}};
};

// Each station has an urgent frame for its neighbour in each slice.
class FullRing {
 public:
  FullRing() {
    for (unsigned n = 0; n < kStations; ++n) {
      auto& station = stations_.emplace_back(token_bus::StationConfiguration{.address = address(n)});
      const std::string name = "station@" + std::to_string(n);
      seats_.push_back(segment_.attach(station, name));
      segment::MediumPort& place = line_.attach(name + "/in", seats_.back(), 0, {});
      place.sense_activity();
      place.tap_driven(listener_);
      station.wire(place, user_);
      station.start(segment_.now());
    }
    refresh();
    for (unsigned n = 0; n < 1'000 && !is_whole(); ++n) segment_.run_for(kSlice);
    run_slices(4);
    if (!is_whole() || user_.data < 4 * (kStations - 1))
      throw std::logic_error("the ring of the benchmark is not busy");
  }

  void run_slices(unsigned count) {
    for (unsigned slice = 0; slice < count; ++slice) {
      for (unsigned n = 0; n < kStations; ++n) {
        stations_[n].submit({.priority = 6,
                             .destination = address((n + 1) % kStations),
                             .data = token_bus::Octets(kPayload, static_cast<std::uint8_t>(n))},
                            segment_.now());
      }
      refresh();
      segment_.run_for(kSlice);
    }
  }
  std::vector<Frame> frames_of(unsigned slices) {
    listener_.keeps = true;
    run_slices(slices);
    listener_.keeps = false;
    return std::exchange(listener_.frames, {});
  }

 private:
  static Address address(unsigned n) { return 2 * Address{n} + 2; }
  bool is_whole() const {
    for (const auto& station : stations_) {
      if (!station.is_in_ring()) return false;
    }
    return true;
  }
  void refresh() {
    for (const std::size_t seat : seats_) segment_.refresh(seat);
  }

  Unasked user_;
  Listener listener_;
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  std::deque<token_bus::TokenStation> stations_;
  std::vector<std::size_t> seats_;
};

// The line itself takes a millisecond for a millisecond.
std::uint64_t real_time() {
  const std::clock_t end = std::clock() + CLOCKS_PER_SEC / 1'000;
  while (std::clock() < end) {
  }
  return 1;
}

constexpr unsigned kSlices = 2;
constexpr std::uint64_t kMilliseconds = kSlices * static_cast<std::uint64_t>(kSlice / kernel::kMillisecond);

Batch line_code_alone() {
  return [frames = FullRing().frames_of(kSlices)] {
    const Rules rules;
    const FrameReader reader(rules);
    std::size_t octets = 0;
    for (const Frame& frame : frames) {
      const line::Waveform wave{{}, 2 * rules.phy_bit_rate, token_bus::levels_of(frame, rules)};
      for (unsigned n = 1; n < kStations; ++n) octets += reader.read(wave)[0].octets.size();
    }
    if (octets == 0) throw std::logic_error("the ring of the benchmark has sent no frame");
    return kMilliseconds;
  };
}

Batch simulated_ring() {
  return [ring = std::make_shared<FullRing>()] {
    ring->run_slices(kSlices);
    return kMilliseconds;
  };
}

constexpr const char* kGroup = "sixteen stations of a token bus at 10 Mbit/s";
const Rows kRing({{kGroup, "real time", "ms of the line", "", 0, [] { return Batch(&real_time); }},
                  {kGroup, "line code alone", "ms of the line", "", 0, &line_code_alone},
                  {kGroup, "stations, frames and half bits", "ms of the line", "real time", 1,
                   &simulated_ring},
                  {kGroup, "the same", "ms of the line", "line code", 0.5, &simulated_ring}});

}  // namespace
}  // namespace fieldproof::bench
