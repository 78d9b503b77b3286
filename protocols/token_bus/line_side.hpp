#pragma once

#include <optional>
#include <utility>

#include "harness/line/waveform.hpp"
#include "harness/segment/station.hpp"
#include "protocols/token_bus/rules.hpp"

// What a MAC knows of its line: since when it is silent, and what is hidden from it. After a transmission the
// receiver is blanked: what begins then is seen from the end of blanking on, and what ends then is not seen.
// While a station drives, its receiver is off.
namespace fieldproof::token_bus {

class LineSide {
 public:
  explicit LineSide(const Rules& rules) : rules_(rules) {}

  void wire(segment::Port& line) { line_ = &line; }
  // Silence begins now.
  void begin(kernel::Time now);
  // Half bits, as they are. Gives their end.
  kernel::Time drive(line::Levels half_bits, kernel::Time start);

  // What is seen of a reception that is over; nothing where it is hidden.
  std::optional<line::Waveform> seen(const line::Waveform& reception);
  bool is_of_own_time(const line::Waveform& reception) const { return reception.start < driven_until_; }
  kernel::Time blanked_until() const { return blanked_until_; }
  // A transmission has ended with an end delimiter that says so.
  void blank_from(kernel::Time end);

  void on_activity(bool begins, kernel::Time now);
  // Others are on the line, and it is not hidden: true once for each time.
  bool takes_notice(kernel::Time now);
  // What was noticed has ended without a reception.
  bool has_ended_unseen() { return std::exchange(has_ended_unseen_, false); }
  kernel::Time next_time() const { return is_active_ && !is_noticed_ ? blanked_until_ : kernel::kNever; }

  bool is_active() const { return is_active_ && is_noticed_; }
  // kNever while others are active.
  kernel::Time silent_since() const;

 private:
  Rules rules_;
  segment::Port* line_ = nullptr;
  bool is_active_ = false;
  bool is_noticed_ = false;
  bool has_ended_unseen_ = false;
  kernel::Time active_until_ = kernel::kStart;
  kernel::Time driven_until_ = kernel::kStart;
  kernel::Time blanked_until_ = kernel::kStart;
};

}  // namespace fieldproof::token_bus
