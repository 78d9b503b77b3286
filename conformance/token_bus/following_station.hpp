#pragma once

#include <optional>
#include <vector>

#include "conformance/token_bus/driven_frames.hpp"
#include "protocols/token_bus/token_station.hpp"

// The reference as the companion of a station under test: it decides everything itself, and takes over what a
// station may choose. That is when it begins within the time that it has for it, the length of its last
// claim, its delay in the last pass of a contest, and after how many tokens it opens a window.
//
// It must be run after the other: what that one has driven by then is looked up. What is due, and was not
// driven yet, waits.
namespace fieldproof::conformance {

// When a transmission may begin.
struct BeginSpan {
  kernel::Time earliest;
  kernel::Time latest;
};

class FollowingStation final : public token_bus::TokenStation {
 public:
  // `followed`: what the station under test drives.
  FollowingStation(const token_bus::StationConfiguration& configuration, const DrivenFrames& followed)
      : TokenStation(configuration), followed_(followed) {}

  bool start(kernel::Time now) override;

  void receive(segment::PortIndex port, const line::Waveform& reception) override;

  // Something was received of which no source says what it means: what comes then may be anything.
  bool is_doubtful() const { return is_doubtful_; }
  // Of each transmission.
  const std::vector<BeginSpan>& spans() const { return spans_; }
  // Until when the other may begin what is due now or before; nothing is due: nothing.
  std::optional<kernel::Time> awaited_until(kernel::Time now) const;

 private:
  using Frame = token_bus::Frame;

  bool is_unsaid(const Frame& frame) const;
  bool has_pending() const;
  std::vector<token_bus::Reception> received(const line::Waveform& wave) const override;
  std::optional<Frame> understood(const Octets& octets) const override;
  kernel::Time begin_of(const Frame& frame, kernel::Time due) const override;
  line::Levels written(const Frame& frame, kernel::Time begin) const override;
  unsigned bus_idle_slots() const override;
  unsigned claim_bits(unsigned pass) override;
  unsigned demand_bits(unsigned pass) override;
  bool drops_token_on(const Frame& frame) const override;
  bool may_begin(unsigned place, kernel::Time begin) const override;
  bool opens_window(kernel::Time now) override;
  bool is_window_due(unsigned count) override;
  unsigned drawn_count_bits() override { return 0; }

  const DrivenFrame* next_followed() const;
  BeginSpan span_of_due() const;
  bool may_be(const DrivenFrame& claim, const Frame& own) const;

  const DrivenFrames& followed_;
  mutable kernel::Time due_ = kernel::kNever;  // of what is pending, when it was last looked at
  mutable std::vector<BeginSpan> spans_;
  mutable bool is_doubtful_ = false;
  bool is_last_claim_ = false;
  mutable bool has_lost_request_ = false;  // with its token
  bool has_opened_window_ = false;
  bool has_passed_ = false;
  mutable bool is_count_unsure_ = false;  // which tokens count after it was alone, or outside of the ring
  unsigned tokens_ = 0;                   // since the last window
  unsigned tokens_more_ = 0;              // than the least number between two windows
};

}  // namespace fieldproof::conformance
