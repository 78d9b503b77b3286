#pragma once

#include "conformance/comparison/observation.hpp"
#include "conformance/token_bus/station_bench.hpp"
#include "protocols/token_bus/token_station.hpp"

// A reference station on a line of its own, on which the tester drives what it drives to the station under
// test, at the same instants: as the receiver of a station follows the begin of a transmission and not only
// its end, it is the line that is copied, not what arrives.
namespace fieldproof::conformance {

class TokenTwin final : private segment::Tap, private segment::Station {
 public:
  // Powered at `now`; `tester` is the place on the line of the station under test.
  TokenTwin(const token_bus::StationConfiguration& configuration, segment::MediumPort& tester,
            kernel::Time now);

  void run_until(kernel::Time now) { segment_.run_until(now); }
  bool submit(const token_bus::DataRequest& request, kernel::Time now);
  void set_in_ring_desired(bool is_desired, kernel::Time now);
  void set_response(const Octets& data, kernel::Time now);

  // What it has driven, and what it has reported to its user.
  Observations frames() const;
  // When it has begun to drive the last of these.
  kernel::Time last_begin() const;
  Observations indications() const;

 private:
  void on_wave(const line::Waveform& wave) override;
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  segment::Segment segment_;
  segment::Medium line_;
  token_bus::Rules rules_;
  token_bus::TokenStation station_;
  TokenUser user_;
  DrivenFrames driven_;
  segment::MediumPort* tester_ = nullptr;
  std::size_t seat_ = 0;
};

Observations frames_of(std::span<const DrivenFrame> driven);
Observations indications_of(const TokenUser& user, const token_bus::Rules& rules);

}  // namespace fieldproof::conformance
