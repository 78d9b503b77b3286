#pragma once

#include <array>
#include <utility>

#include "protocols/token_bus/dual_channel.hpp"

// Dual channel managers that judge faults of a channel otherwise when they select.
namespace fieldproof::conformance::dual_channel_seeded_faults {

using namespace token_bus;

inline constexpr kernel::Duration kAlmostForEver = 1'000 * kernel::kSecond;

// ---- the selection: faults ----

class MissingOtherwise final : public ChannelSelection {
 public:
  MissingOtherwise(const ChannelManagerConfiguration& of, kernel::Duration after)
      : ChannelSelection(of.rules, of.channels), after_(after) {}

 private:
  kernel::Duration missing_after() const override { return after_; }

  kernel::Duration after_;
};

// Within a transmission always, or never though it is spoiled.
class MissesWithinOtherwise final : public ChannelSelection {
 public:
  MissesWithinOtherwise(const ChannelManagerConfiguration& of, bool misses)
      : ChannelSelection(of.rules, of.channels), misses_(misses) {}

 private:
  bool is_missed_by(Channel other, kernel::Time) const override {
    return misses_ || !is_within_transmission(other);
  }

  bool misses_;
};

// By whether the other channel has bad_signal, too.
class BadSignalOtherwise final : public ChannelSelection {
 public:
  BadSignalOtherwise(const ChannelManagerConfiguration& of, bool alone, bool both, bool at_any_time = false)
      : ChannelSelection(of.rules, of.channels), alone_(alone), both_(both), at_any_time_(at_any_time) {}

 private:
  bool is_bad_signal_a_fault(bool other_is_bad) const override { return other_is_bad ? both_ : alone_; }
  kernel::Duration bad_signal_counts_for() const override { return at_any_time_ ? kAlmostForEver : slot(); }

  bool alone_;
  bool both_;
  bool at_any_time_;
};

class StaysAfterBadSignal final : public ChannelSelection {
 public:
  explicit StaysAfterBadSignal(const ChannelManagerConfiguration& of)
      : ChannelSelection(of.rules, of.channels) {}

 private:
  bool is_left_for(ChannelEventKind kind) const override { return kind != ChannelEventKind::bad_signal; }
};

using Errors = unsigned (*)(unsigned errors, Carried carried, Carried other);

class CountsErrorsOtherwise final : public ChannelSelection {
 public:
  CountsErrorsOtherwise(const ChannelManagerConfiguration& of, Errors errors)
      : ChannelSelection(of.rules, of.channels), errors_(errors) {}

 private:
  unsigned errors_after(unsigned errors, Carried carried, Carried other) const override {
    return errors_(errors, carried, other);
  }

  Errors errors_;
};
inline unsigned no_errors(unsigned, Carried, Carried) {
  return 0;
}
inline unsigned errors_for_ever(unsigned errors, Carried carried, Carried other) {
  return carried == Carried::spoiled && other == Carried::clean ? errors + 1 : errors;
}
inline unsigned errors_of_both(unsigned errors, Carried carried, Carried) {
  return carried == Carried::clean ? 0 : errors + 1;
}

inline unsigned errors_of_senders_too(unsigned errors, Carried carried, Carried other) {
  if (carried == Carried::clean) return 0;
  return other == Carried::clean ? errors + 1 : errors;
}

inline unsigned errors_until_both(unsigned errors, Carried carried, Carried other) {
  if (carried == Carried::clean || (carried == Carried::spoiled && other == Carried::spoiled)) return 0;
  return carried == Carried::spoiled && other == Carried::clean ? errors + 1 : errors;
}
inline unsigned errors_until_neither(unsigned errors, Carried carried, Carried other) {
  if (carried != Carried::spoiled) return 0;
  return other == Carried::clean ? errors + 1 : errors;
}
inline unsigned errors_beside_neither(unsigned errors, Carried carried, Carried other) {
  if (carried == Carried::clean) return 0;
  return carried == Carried::spoiled && other != Carried::spoiled ? errors + 1 : errors;
}

using Clean = unsigned (*)(unsigned clean, Carried carried);

class CountsCleanOtherwise final : public ChannelSelection {
 public:
  CountsCleanOtherwise(const ChannelManagerConfiguration& of, Clean clean)
      : ChannelSelection(of.rules, of.channels), clean_(clean) {}

 private:
  unsigned clean_after(unsigned clean, Carried carried) const override { return clean_(clean, carried); }

  Clean clean_;
};
inline unsigned never_clean(unsigned, Carried) {
  return 0;
}
inline unsigned clean_whatever_it_is(unsigned clean, Carried) {
  return clean + 1;
}
inline unsigned clean_for_ever(unsigned clean, Carried carried) {
  return carried == Carried::clean ? clean + 1 : clean;
}

inline unsigned neither_is_clean(unsigned clean, Carried carried) {
  return carried == Carried::spoiled ? 0 : clean + 1;
}
inline unsigned clean_until_neither(unsigned clean, Carried carried) {
  return carried == Carried::clean ? clean + 1 : 0;
}

using Reported = ChannelEvent (*)(ChannelEvent right);

class ReportsOtherwise final : public ChannelSelection {
 public:
  ReportsOtherwise(const ChannelManagerConfiguration& of, Reported how)
      : ChannelSelection(of.rules, of.channels), how_(how) {}

 private:
  ChannelEvent reported(const ChannelEvent& event) const override { return how_(event); }

  Reported how_;
};
inline ChannelEvent of_the_other_channel(ChannelEvent right) {
  return {right.kind, other_than(right.channel)};
}
inline ChannelEvent of_another_cause(ChannelEvent right) {
  return right.kind == ChannelEventKind::bad_signal
             ? ChannelEvent{ChannelEventKind::frame_errors, right.channel}
             : right;
}

enum class Reports : std::uint8_t { nothing, again_and_again, of_the_preferred, once_for_ever };

template <Reports reports>
class ReportsAtOtherTimes final : public ChannelSelection {
 public:
  explicit ReportsAtOtherTimes(const ChannelManagerConfiguration& of)
      : ChannelSelection(of.rules, of.channels) {}

 private:
  bool is_reported(Channel channel, bool has_fault_already) const override {
    if (reports == Reports::nothing) return false;
    if (reports == Reports::again_and_again) return true;
    if (reports == Reports::of_the_preferred) return channel == preferred() && !has_fault_already;
    return !std::exchange(has_reported_.at(static_cast<std::size_t>(channel)), true);
  }

  mutable std::array<bool, 2> has_reported_{};
};

// ---- for `check`: both channels have a fault ----

class ReportsOneChannelAtATime final : public ChannelSelection {
 public:
  explicit ReportsOneChannelAtATime(const ChannelManagerConfiguration& of)
      : ChannelSelection(of.rules, of.channels) {}

 private:
  bool is_reported(Channel channel, bool has_fault_already) const override {
    return !has_fault_already && !has_fault(other_than(channel));
  }
};

class StaysWhereTheOtherHasAFault final : public ChannelSelection {
 public:
  explicit StaysWhereTheOtherHasAFault(const ChannelManagerConfiguration& of)
      : ChannelSelection(of.rules, of.channels) {}

 private:
  bool is_left_for(ChannelEventKind) const override { return !has_fault(other_than(preferred())); }
};

}  // namespace fieldproof::conformance::dual_channel_seeded_faults
