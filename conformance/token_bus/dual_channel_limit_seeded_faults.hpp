#pragma once

#include "protocols/token_bus/dual_channel.hpp"

// Dual channel managers whose selection prefers, waits or tolerates otherwise: limits that are some symbols
// off.
namespace fieldproof::conformance::dual_channel_seeded_faults {

using namespace token_bus;

// ---- the selection: which channel ----

class WaitsOtherwise final : public ChannelSelection {
 public:
  WaitsOtherwise(const ChannelManagerConfiguration& of, kernel::Duration waits, bool leaves)
      : ChannelSelection(of.rules, of.channels), waits_(waits), leaves_(leaves) {}

 private:
  kernel::Duration waits_for_preferred() const override { return waits_; }
  bool is_left_for(ChannelEventKind) const override { return leaves_; }

  kernel::Duration waits_;
  bool leaves_;
};

using Preference = Channel (*)(const ChannelSelection& selection, Channel selected);

class PrefersOtherwise final : public ChannelSelection {
 public:
  PrefersOtherwise(const ChannelManagerConfiguration& of, Preference preference)
      : ChannelSelection(of.rules, of.channels), preference_(preference) {}

 private:
  Channel preferred_after_selection(Channel selected) const override { return preference_(*this, selected); }

  Preference preference_;
};
inline Channel a_always(const ChannelSelection&, Channel) {
  return Channel::a;
}
inline Channel who_did_not_serve(const ChannelSelection&, Channel selected) {
  return other_than(selected);
}
inline Channel a_when_it_is_clean(const ChannelSelection& selection, Channel selected) {
  return selection.has_fault(Channel::a) ? selected : Channel::a;
}

class SlotBeginsAnew final : public ChannelSelection {
 public:
  explicit SlotBeginsAnew(const ChannelManagerConfiguration& of) : ChannelSelection(of.rules, of.channels) {}

 private:
  bool begins_slot_anew() const override { return true; }
};

class AnAbortStaysSelected final : public ChannelSelection {
 public:
  explicit AnAbortStaysSelected(const ChannelManagerConfiguration& of)
      : ChannelSelection(of.rules, of.channels) {}

 private:
  bool keeps_an_abort() const override { return true; }
  bool is_new_transmission(Channel channel, kernel::Time when) const override {
    return is_within_transmission(*serving()) && ChannelSelection::is_new_transmission(channel, when);
  }
};

class TakesLateCopies final : public ChannelSelection {
 public:
  explicit TakesLateCopies(const ChannelManagerConfiguration& of) : ChannelSelection(of.rules, of.channels) {}

 private:
  bool takes_late_copies() const override { return true; }
};

enum class Begins : std::uint8_t { always, never, after_bad_signal };

template <Begins begins>
class BeginsOtherwise final : public ChannelSelection {
 public:
  explicit BeginsOtherwise(const ChannelManagerConfiguration& of) : ChannelSelection(of.rules, of.channels) {}

 private:
  bool is_new_transmission(Channel channel, kernel::Time) const override {
    if (begins != Begins::after_bad_signal) return begins == Begins::always;
    return !is_within_transmission(channel) && !may_complete(*serving(), kernel::kStart);
  }
};

// ---- the selection: limits that are some symbols off ----

class WaitsForMore final : public ChannelSelection {
 public:
  WaitsForMore(const ChannelManagerConfiguration& of, std::int64_t symbols)
      : ChannelSelection(of.rules, of.channels), more_(mac_symbols(of.rules, symbols)) {}

 private:
  kernel::Duration waits_for_preferred() const override { return skew() + more_; }

  kernel::Duration more_;
};

class CountsBadSignalForMore final : public ChannelSelection {
 public:
  CountsBadSignalForMore(const ChannelManagerConfiguration& of, std::int64_t symbols)
      : ChannelSelection(of.rules, of.channels), more_(mac_symbols(of.rules, symbols)) {}

 private:
  kernel::Duration bad_signal_counts_for() const override { return slot() + more_; }

  kernel::Duration more_;
};

// The selection keeps to the skew.
class CollidesForMore final : public ChannelSelection {
 public:
  CollidesForMore(const ChannelManagerConfiguration& of, int symbols)
      : ChannelSelection(of.rules, with_skew_of(of.channels, symbols)),
        waits_(mac_symbols(of.rules, of.channels.skew_symbols)) {}

 private:
  static ChannelRules with_skew_of(ChannelRules rules, int more) {
    rules.skew_symbols = static_cast<unsigned>(static_cast<int>(rules.skew_symbols) + more);
    return rules;
  }
  kernel::Duration waits_for_preferred() const override { return waits_; }

  kernel::Duration waits_;
};

}  // namespace fieldproof::conformance::dual_channel_seeded_faults
