#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "protocols/token_bus/dual_channel.hpp"

// Dual channel managers that take one decision otherwise.
namespace fieldproof::conformance::dual_channel_seeded_faults {

using namespace token_bus;

inline constexpr kernel::Duration kAlmostForEver = 1'000 * kernel::kSecond;

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

// ---- the manager: requests and answers ----

using Sends = bool (*)(const ChannelSelection& selection, Channel channel, bool is_management);

class SendsOtherwise final : public ChannelManager {
 public:
  SendsOtherwise(const ChannelManagerConfiguration& configuration, Sends sends)
      : ChannelManager(configuration), sends_(sends) {}

 private:
  bool sends_on(Channel channel, bool is_management) const override {
    return sends_(selection(), channel, is_management);
  }

  Sends sends_;
};
inline bool on_a_alone(const ChannelSelection&, Channel channel, bool) {
  return channel == Channel::a;
}
inline bool on_the_preferred_alone(const ChannelSelection& selection, Channel channel, bool) {
  return channel == selection.preferred();
}
inline bool on_clean_channels(const ChannelSelection& selection, Channel channel, bool) {
  return !selection.has_fault(channel);
}
inline bool commands_on_a_alone(const ChannelSelection&, Channel channel, bool is_management) {
  return !is_management || channel == Channel::a;
}

class ExchangesBitsOnB final : public ChannelManager {
  using ChannelManager::ChannelManager;
  std::uint64_t requested(Channel channel, std::uint64_t levels) const override {
    const bool is_bit = levels == levels_of(MacRequest{.symbol = MacSymbol::zero}) ||
                        levels == levels_of(MacRequest{.symbol = MacSymbol::one});
    constexpr std::uint64_t kOneOrZero = 8;
    return channel == Channel::b && is_bit ? levels ^ kOneOrZero : levels;
  }
};

class LateByMore final : public ChannelManager {
 public:
  // In symbols.
  LateByMore(const ChannelManagerConfiguration& configuration, unsigned requests, unsigned requests_of_b,
             unsigned indications)
      : ChannelManager(configuration),
        requests_(requests),
        requests_of_b_(requests_of_b),
        indications_(indications) {}

 private:
  kernel::Duration request_delay(Channel channel) const override {
    const unsigned more = channel == Channel::b ? requests_of_b_ : requests_;
    return ChannelManager::request_delay(channel) + mac_symbols(configuration().rules, more);
  }
  kernel::Duration indication_delay() const override {
    return ChannelManager::indication_delay() + mac_symbols(configuration().rules, indications_);
  }

  unsigned requests_;
  unsigned requests_of_b_;
  unsigned indications_;
};

using Gives = bool (*)(bool is_preferred, bool other_answers);

class AnswersFromElsewhere final : public ChannelManager {
 public:
  AnswersFromElsewhere(const ChannelManagerConfiguration& configuration, Gives gives)
      : ChannelManager(configuration), gives_(gives) {}

 private:
  bool gives_answer(Channel channel, bool other_answers) const override {
    return gives_(channel == selection().preferred(), other_answers);
  }

  Gives gives_;
};
inline bool no_answer(bool, bool) {
  return false;
}
inline bool any_answer(bool, bool) {
  return true;
}
inline bool of_the_preferred_alone(bool is_preferred, bool) {
  return is_preferred;
}
inline bool of_the_other_first(bool is_preferred, bool other_answers) {
  return !is_preferred || !other_answers;
}

// ---- the manager: symbols ----

using From = std::optional<Channel> (*)(const ChannelSelection& selection);

class IndicatesFromElsewhere final : public ChannelManager {
 public:
  IndicatesFromElsewhere(const ChannelManagerConfiguration& configuration, From from)
      : ChannelManager(configuration), from_(from) {}

 private:
  std::optional<Channel> source() const override { return from_(selection()); }

  From from_;
};
inline std::optional<Channel> transmissions_alone(const ChannelSelection& selection) {
  return selection.serving();
}
inline std::optional<Channel> the_preferred_always(const ChannelSelection& selection) {
  return selection.serving().value_or(selection.preferred());
}
inline std::optional<Channel> whoever_goes_on(const ChannelSelection& selection) {
  if (selection.serving()) return selection.serving();
  const Channel other = other_than(selection.preferred());
  return selection.is_within_transmission(other) ? other : selection.preferred();
}
inline std::optional<Channel> whoever_is_clean(const ChannelSelection& selection) {
  const Channel serving = selection.serving().value_or(selection.preferred());
  const bool is_better = selection.is_within_transmission(serving) &&
                         !selection.may_complete(serving, kernel::kStart) &&
                         selection.is_within_transmission(other_than(serving));
  return is_better ? other_than(serving) : serving;
}

class IndicatesBoth final : public ChannelManager {
  using ChannelManager::ChannelManager;
  bool gives_symbols(Channel, std::optional<Channel>) const override { return true; }
};

class BadSignalIsSilence final : public ChannelManager {
  using ChannelManager::ChannelManager;
  std::uint64_t indicated(std::uint64_t levels) const override {
    return levels == levels_of(MacIndication{.symbol = MacSymbol::bad_signal}) ? levels_of(MacIndication{})
                                                                               : levels;
  }
};

// Of each wave that comes.
class TakesApart final : public ChannelManager {
 public:
  TakesApart(const ChannelManagerConfiguration& configuration, std::size_t lost, std::size_t most)
      : ChannelManager(configuration), lost_(lost), most_(most) {}

 private:
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    const std::size_t first = port == kTowardsMac ? 0 : kUnitLevels * lost_;
    if (reception.levels.size() <= first) return;
    const std::size_t rest = std::min(reception.levels.size() - first, kUnitLevels * most_);
    ChannelManager::receive(port,
                            {reception.time_of(first), reception.rate, reception.levels.slice(first, rest)});
  }

  std::size_t lost_;
  std::size_t most_;
};

// The symbols of a channel, as the text of their levels.
using Rewrite = void (*)(std::string& levels);

class ReadsOtherwise final : public ChannelManager {
 public:
  ReadsOtherwise(const ChannelManagerConfiguration& configuration, Rewrite rewrite)
      : ChannelManager(configuration), rewrite_(rewrite) {}

 private:
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    std::string levels = reception.levels.text();
    if (port != kTowardsMac) rewrite_(levels);
    ChannelManager::receive(port, {reception.start, reception.rate, line::Levels::of_text(levels)});
  }

  Rewrite rewrite_;
};
inline void put_behind(std::string& levels, std::string_view what, std::string_view then) {
  for (std::size_t at = levels.find(what); at != std::string::npos; at = levels.find(what, at + 1)) {
    const std::size_t behind = at + what.size();
    if (at % kUnitLevels == 0 && behind + then.size() <= levels.size())
      levels.replace(behind, then.size(), then);
  }
}
inline void end_start_delimiters(std::string& levels) {
  put_behind(levels, "110011001000110011001000", "10001000");
}
inline void set_all_i(std::string& levels) {
  put_behind(levels, "110011001001110011001001", "1001");
}
inline void look_at_any_circuit(std::string& levels) {
  for (std::size_t at = 0; at + kUnitLevels <= levels.size(); at += kUnitLevels) {
    const std::string_view unit = std::string_view(levels).substr(at, kUnitLevels);
    if (unit == "1101" || unit == "1011") levels.replace(at, kUnitLevels, "1001");
  }
}

// What it is given on its sides, and when.
enum class Receives : std::uint8_t { at_its_own_rate, nothing_while_it_sends, anew_each_time };

template <Receives how>
class ReceivesOtherwise final : public ChannelManager {
  using ChannelManager::ChannelManager;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    line::Waveform given = reception;
    if (how == Receives::at_its_own_rate) given.rate = mac_side_rate(configuration().rules.phy_bit_rate);
    if (how == Receives::anew_each_time) set_power(true, reception.start);
    if (port == kTowardsMac) sends_until_ = reception.end();
    const bool is_deaf = how == Receives::nothing_while_it_sends && port != kTowardsMac;
    if (!is_deaf || reception.start >= sends_until_) ChannelManager::receive(port, given);
  }

  kernel::Time sends_until_ = kernel::kStart;
};

// So many reports, and none after a time.
class ReportsUntil final : public ChannelManager {
 public:
  ReportsUntil(const ChannelManagerConfiguration& configuration, unsigned most, kernel::Duration last)
      : ChannelManager(configuration), gate_(most, last) {}
  void wire(segment::Port& mac, segment::Port& a, segment::Port& b,
            token_bus::ChannelListener& listener) override {
    gate_.listener = &listener;
    ChannelManager::wire(mac, a, b, gate_);
  }

 private:
  struct Gate final : token_bus::ChannelListener {
    Gate(unsigned most, kernel::Duration last_) : left(most), last(last_) {}
    void on_channel_event(const ChannelEvent& event, kernel::Time when) override {
      if (left == 0 || when > kernel::kStart + last) return;
      --left;
      listener->on_channel_event(event, when);
    }

    unsigned left;
    kernel::Duration last;
    token_bus::ChannelListener* listener = nullptr;
  };

  Gate gate_;
};

class RemembersChannels final : public ChannelManager {
  using ChannelManager::ChannelManager;
  void set_power(bool is_on, kernel::Time now) override {
    if (is_on && !std::exchange(is_on_, true)) ChannelManager::set_power(is_on, now);
  }

  bool is_on_ = false;
};

// A watchdog where nobody has to send.
class ReportsSilence final : public ChannelManager {
 public:
  using ChannelManager::ChannelManager;
  void wire(segment::Port& mac, segment::Port& a, segment::Port& b,
            token_bus::ChannelListener& listener) override {
    listener_ = &listener;
    ChannelManager::wire(mac, a, b, listener);
  }
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    due_ = reception.end() + slots(configuration().rules, kSlots);
    ChannelManager::receive(port, reception);
  }
  void set_power(bool is_on, kernel::Time now) override {
    due_ = is_on ? now + slots(configuration().rules, kSlots) : kernel::kNever;
    ChannelManager::set_power(is_on, now);
  }
  void on_time(kernel::Time now) override {
    ChannelManager::on_time(now);
    if (now < due_) return;
    due_ = kernel::kNever;
    listener_->on_channel_event({ChannelEventKind::no_start_delimiter, Channel::a}, now);
  }
  kernel::Time next_time() const override { return std::min(due_, ChannelManager::next_time()); }

 private:
  static constexpr std::int64_t kSlots = 10;

  token_bus::ChannelListener* listener_ = nullptr;
  kernel::Time due_ = kernel::kNever;
};

}  // namespace fieldproof::conformance::dual_channel_seeded_faults
