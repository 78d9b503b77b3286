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
      : TokenStation(configuration),
        followed_(followed),
        is_desired_at_start_(configuration.in_ring_desired),
        is_desired_(configuration.in_ring_desired) {}

  bool start(kernel::Time now) override;
  void set_in_ring_desired(bool is_desired, kernel::Time now) override;

  void receive(segment::PortIndex port, const line::Waveform& reception) override;

  void on_activity(segment::PortIndex port, bool begins, kernel::Time now) override;
  void on_time(kernel::Time now) override;

  // Something was received of which no source says what it means: what comes then may be anything.
  bool is_doubtful() const { return is_doubtful_ || has_group_answered_; }
  // Tokens between two windows, octets of the last claims, as the other has drawn them since its start.
  const std::vector<std::size_t>& tokens_to_windows() const { return tokens_to_windows_; }
  const std::vector<std::size_t>& last_claims() const { return last_claims_; }
  // Of its transmissions, those from before that.
  std::size_t sure_frames() const { return sure_frames_; }
  // The other has begun what was due later, and was replied to before that.
  struct EarlyBegin {
    kernel::Time begin;
    kernel::Time due;
  };
  const std::optional<EarlyBegin>& early_begin() const { return early_begin_; }
  // Until when the other had to begin what it had not when others began.
  const std::optional<kernel::Time>& overdue() const { return overdue_; }
  // Whether it has data is not said, so neither is whether it claims a token.
  bool may_be_silent() const { return has_lost_request_; }
  // Of each transmission.
  const std::vector<BeginSpan>& spans() const { return spans_; }
  // Until when the other may begin what is due now or before; nothing is due: nothing.
  std::optional<kernel::Time> awaited_until(kernel::Time now) const;

 private:
  using Frame = token_bus::Frame;

  bool is_unsaid(const Frame& frame) const;
  bool has_pending() const;
  bool is_at_an_end(kernel::Time now) const;
  void note_before(kernel::Time now);
  std::vector<token_bus::Reception> received(const line::Waveform& wave) const override;
  std::optional<Frame> understood(const Octets& octets) const override;
  kernel::Time begin_of(const Frame& frame, kernel::Time due) const override;
  line::Levels written(const Frame& frame, kernel::Time begin) const override;
  unsigned bus_idle_slots() const override;
  unsigned claim_bits(unsigned pass) override;
  unsigned demand_bits(unsigned pass) override;
  bool drops_token_on(const Frame& frame) const override;
  bool resolves(unsigned passes) const override;
  bool wants_ring() const override;
  bool may_begin(unsigned place, kernel::Time begin) const override;
  bool opens_window(kernel::Time now) override;
  bool is_window_due(unsigned count) override;
  unsigned drawn_count_bits() override { return 0; }

  const DrivenFrame* next_followed() const;
  BeginSpan span_of_due() const;
  bool may_be(const DrivenFrame& claim, const Frame& own) const;

  const DrivenFrames& followed_;
  bool is_desired_at_start_;
  bool is_desired_;
  mutable kernel::Time due_ = kernel::kNever;  // of what is pending, when it was last looked at
  mutable std::vector<BeginSpan> spans_;
  mutable bool is_doubtful_ = false;
  mutable std::size_t sure_frames_ = 0;
  kernel::Time wait_ended_ = kernel::kNever;    // by itself, for want of an answer
  kernel::Time demand_until_ = kernel::kNever;  // of one in demand_in, when what is received began
  std::optional<EarlyBegin> early_begin_{};
  std::optional<kernel::Time> overdue_{};
  bool is_last_claim_ = false;
  mutable bool has_lost_request_ = false;  // with its token
  bool has_opened_window_ = false;
  bool has_passed_ = false;
  mutable bool is_count_unsure_ = false;  // which tokens count after it was alone, or outside of the ring
  std::vector<std::size_t> tokens_to_windows_;
  mutable std::vector<std::size_t> last_claims_;
  mutable bool has_group_answered_ = false;  // in a window, and nothing was driven since
  mutable unsigned tokens_ = 0;              // since the last window, or since it was outside of the ring
  unsigned tokens_more_ = 0;                 // than the least number between two windows
};

}  // namespace fieldproof::conformance
