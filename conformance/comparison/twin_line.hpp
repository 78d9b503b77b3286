#pragma once

#include "harness/segment/segment.hpp"
#include "harness/segment/station.hpp"

// The line of a reference beside an implementation under test: what arrives at the receiver of the
// implementation (after all faults) arrives at the reference as well, at the same instant, and nothing else
// does. What the reference drives reaches the tap and nobody else, so it disturbs nothing.
//
// It is a tap for the place of the implementation, and follows its segment: `run_until` brings it to the same
// instant.
namespace fieldproof::conformance {

class TwinLine final : public segment::Tap, public segment::Port {
 public:
  // Both must outlive it.
  TwinLine(segment::Station& reference, segment::Tap& driven)
      : driven_(driven), seat_(segment_.attach(reference, "reference")) {}

  void on_wave(const line::Waveform& wave) override;
  void drive(line::Waveform& wave) override;

  void run_until(kernel::Time now);
  // Something outside of the line has changed the reference.
  void refresh() { segment_.refresh(seat_); }

 private:
  segment::Tap& driven_;
  segment::Segment segment_;
  std::size_t seat_;
};

// Passes on what it receives while there is somebody to pass it on to: a place keeps its taps for good.
class PassingTap final : public segment::Tap {
 public:
  void pass_to(segment::Tap* next) { next_ = next; }
  void on_wave(const line::Waveform& wave) override {
    if (next_ != nullptr) next_->on_wave(wave);
  }

 private:
  segment::Tap* next_ = nullptr;
};

}  // namespace fieldproof::conformance
