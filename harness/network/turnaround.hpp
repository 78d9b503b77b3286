#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "harness/kernel/time.hpp"
#include "harness/segment/station.hpp"

// How long a station takes to answer: from the end of what asks it to the beginning of what it drives then. A
// network whose stations are asked gives each of those under test one of these; its kind of delay stands
// among the cycles of the network.
//
// Contract: of each question the first transmission that begins after it is the answer, whatever it says. A
// question that nothing answers before the next one, or before somebody else begins a frame, is not counted;
// nor is what begins before a question ends.
namespace fieldproof::network {

// Where an answer begins in what a station drives.
enum class AnswerBegin : std::uint8_t {
  first_level,  // with its first level
  start_level,  // with the first level 0: in front of it the driver is on and the line idle
};

class Turnaround final : public segment::Tap {
 public:
  using OnAnswer = std::function<void(kernel::Time asked, kernel::Time answered)>;

  Turnaround(AnswerBegin begin, OnAnswer on_answer) : begin_(begin), on_answer_(std::move(on_answer)) {}

  // The question ends then.
  void ask(kernel::Time end) {
    asked_ = end;
    other_begins_ = kernel::kNever;
  }
  // A frame begins then, of anybody: what begins later answers something else. It may be said before the
  // frame is seen here.
  void expire(kernel::Time begin) { other_begins_ = std::min(other_begins_, begin); }
  void forget() { asked_.reset(); }
  void on_wave(const line::Waveform& wave) override;

 private:
  AnswerBegin begin_;
  OnAnswer on_answer_;
  std::optional<kernel::Time> asked_{};
  kernel::Time other_begins_ = kernel::kNever;
};

}  // namespace fieldproof::network
