#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "conformance/comparison/observation.hpp"
#include "conformance/token_bus/following_station.hpp"
#include "conformance/token_bus/station_bench.hpp"

// A reference station on a line of its own, on which the tester drives what it drives to the station under
// test, at the same instants: as the receiver of a station follows the begin of a transmission and not only
// its end, it is the line that is copied, not what arrives.
//
// It runs after the station under test, and follows it in what stations may choose: what the tester and the
// user do is kept until `catch_up`.
namespace fieldproof::conformance {

class TokenTwin final : private segment::Tap, private segment::Station {
 public:
  // Powered at `now`; `tester` is the place on the line of the station under test, `followed` what that
  // drives.
  TokenTwin(const token_bus::StationConfiguration& configuration, segment::MediumPort& tester,
            const DrivenFrames& followed, kernel::Time now);

  void set_power(bool is_on, kernel::Time now);
  void submit(const token_bus::DataRequest& request, kernel::Time now);
  void set_in_ring_desired(bool is_desired, kernel::Time now);
  void set_response(const Octets& data, kernel::Time now);

  // Everything up to `now`, of which the station under test has driven what it does.
  void catch_up(kernel::Time now);
  // Until when the other may begin what is due; nothing is due: nothing.
  std::optional<kernel::Time> awaited_until() const { return station_.awaited_until(segment_.now()); }

  const std::optional<FollowingStation::EarlyBegin>& early_begin() const { return station_.early_begin(); }
  const std::optional<kernel::Time>& overdue() const { return station_.overdue(); }
  std::size_t sure_frames() const { return station_.sure_frames(); }
  bool may_be_silent() const { return station_.may_be_silent(); }
  bool is_doubtful() const { return station_.is_doubtful(); }

  // What the station under test has drawn since it has its supply.
  const std::vector<std::size_t>& tokens_to_windows() const { return station_.tokens_to_windows(); }
  const std::vector<std::size_t>& last_claims() const { return station_.last_claims(); }

  // What it has driven, when that might begin, and what it has reported to its user.
  const std::vector<DrivenFrame>& driven() const { return driven_.all(); }
  const std::vector<BeginSpan>& spans() const { return station_.spans(); }
  const TokenUser& user() const { return user_; }
  token_bus::Counters counters() const { return station_.counters(); }
  // Of each submission, whether it was taken.
  const std::vector<bool>& taken() const { return taken_; }

 private:
  struct Act {
    kernel::Time when;
    std::function<void(kernel::Time)> act;
  };

  void on_wave(const line::Waveform& wave) override;
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }
  void keep(kernel::Time when, std::function<void(kernel::Time)> act);

  segment::Segment segment_;
  segment::Medium line_;
  FollowingStation station_;
  TokenUser user_;
  DrivenFrames driven_;
  std::deque<Act> acts_;
  std::vector<bool> taken_;
  segment::MediumPort* tester_ = nullptr;
  std::size_t seat_ = 0;
};

Observations frames_of(std::span<const DrivenFrame> driven);
Observations indications_of(std::span<const token_bus::Frame> frames, const token_bus::Rules& rules);
Observations events_of(std::span<const TokenUser::Reported> events);

}  // namespace fieldproof::conformance
