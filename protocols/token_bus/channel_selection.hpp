#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "protocols/token_bus/channel_rules.hpp"
#include "protocols/token_bus/frame.hpp"

// Which of two channels a MAC is given, where both carry the same transmissions: the decision of the dual
// channel manager, apart from levels and symbols. It is told what each channel shows, in the order of time.
//
// A transmission begins on a channel with a start delimiter, and ends with an end delimiter after which
// nothing follows, or with silence.
//
//   selection   the preferred channel, when its start delimiter comes within the skew of that of the other;
//               else the other. So it stays until the transmission has ended there, or cannot complete: then
//               the next one that begins on the other channel is taken. What comes later than the skew on a
//               channel that was not selected is no second transmission.
//   preference  the channel that was selected last; the other one, when a fault is found on it.
//   fault       no start delimiter within a slot time after one of the other channel, unless a frame is under
//               way; bad_signal within that time, and none on the other within the skew; so many
//               transmissions in a row that are spoiled here and clean on the other. Reported once.
//   clean       so many clean transmissions in a row: reported, and the next fault is, too.
//
// What both channels spoil says nothing about either.
namespace fieldproof::token_bus {

enum class Channel : std::uint8_t { a, b };
inline constexpr std::array kChannels{Channel::a, Channel::b};
inline Channel other_than(Channel channel) {
  return channel == Channel::a ? Channel::b : Channel::a;
}
// "A".
std::string_view text_of(Channel channel);

enum class ChannelEventKind : std::uint8_t {
  no_start_delimiter,
  bad_signal,
  frame_errors,  // checks that are wrong, frames without an end
  clean          // it had a fault
};
inline constexpr std::size_t kChannelEventKinds = 4;
std::string_view text_of(ChannelEventKind kind);

struct ChannelEvent {
  ChannelEventKind kind;
  Channel channel;

  friend bool operator==(const ChannelEvent&, const ChannelEvent&) = default;
};

// What a channel carried from a start delimiter to the end of the transmission.
enum class Carried : std::uint8_t {
  clean,    // frames, each with the right check
  spoiled,  // a frame with a wrong check, or without its end
  neither   // E bits of 1, frames that are too long: the sender's doing, or that of a repeater for both
};
Carried carried_by(std::span<const Reception> receptions);

// Who is told of faults.
class ChannelListener {
 public:
  virtual ~ChannelListener() = default;
  virtual void on_channel_event(const ChannelEvent& event, kernel::Time when) = 0;
};

class ChannelUser : public ChannelListener {
 public:
  // The transmission whose start delimiter was complete then is taken from this channel.
  virtual void on_selected(Channel channel, kernel::Time start_delimiter) = 0;
};

class ChannelSelection {
 public:
  ChannelSelection(const Rules& rules, const ChannelRules& channels) : rules_(rules), channels_(channels) {}
  ChannelSelection(const ChannelSelection&) = delete;
  ChannelSelection& operator=(const ChannelSelection&) = delete;
  virtual ~ChannelSelection() = default;

  // Before anything else; the user must stay.
  void wire(ChannelUser& user) { user_ = &user; }
  // As at the start: A is preferred, and no channel has a fault.
  void reset();

  // ---- what a channel shows; instants never decrease ----
  // Complete at that time.
  void on_start_delimiter(Channel channel, kernel::Time when);
  void on_bad_signal(Channel channel, kernel::Time when);
  // The transmission has ended on this channel. Nothing where none has begun.
  void on_end(Channel channel, Carried carried, kernel::Time when);
  // Nothing that happens at the same instant comes after it.
  void on_time(kernel::Time now);
  kernel::Time next_time() const;

  Channel preferred() const { return preferred_; }
  // From which a transmission is under way.
  std::optional<Channel> serving() const { return serving_; }
  bool is_within_transmission(Channel channel) const { return of(channel).is_within; }
  bool has_fault(Channel channel) const { return of(channel).has_fault; }
  // A frame is under way on the channel, neither spoiled nor longer than any.
  bool may_complete(Channel channel, kernel::Time when) const;

 protected:
  const ChannelRules& channels() const { return channels_; }
  kernel::Duration skew() const { return mac_symbols(rules_, channels_.skew_symbols); }
  kernel::Duration slot() const { return slots(rules_, 1); }

  // ---- decisions ----
  // The other channel has had a start delimiter and this one none for so long.
  virtual kernel::Duration missing_after() const { return slot(); }
  virtual bool begins_slot_anew() const { return false; }
  virtual bool keeps_an_abort() const { return false; }
  virtual kernel::Duration waits_for_preferred() const { return skew(); }
  // A start delimiter of `channel` while the other one serves.
  virtual bool is_new_transmission(Channel channel, kernel::Time when) const;
  virtual bool is_missed_by(Channel other, kernel::Time when) const { return !may_complete(other, when); }
  virtual bool takes_late_copies() const { return false; }
  virtual Channel preferred_after_selection(Channel selected) const { return selected; }
  virtual bool is_left_for(ChannelEventKind) const { return true; }
  virtual kernel::Duration bad_signal_counts_for() const { return slot(); }
  virtual bool is_bad_signal_a_fault(bool other_is_bad) const { return !other_is_bad; }
  virtual unsigned errors_after(unsigned errors, Carried carried, Carried other) const;
  virtual unsigned clean_after(unsigned clean, Carried carried) const;
  virtual bool is_reported(Channel /*channel*/, bool has_fault_already) const { return !has_fault_already; }
  virtual ChannelEvent reported(const ChannelEvent& event) const { return event; }

 private:
  struct Ended {
    Carried carried;
    kernel::Time start_delimiter;
  };
  struct State {
    std::optional<kernel::Time> start_delimiter{};  // the last one
    bool is_within = false;                         // a transmission
    bool is_bad = false;                            // since the last start delimiter
    kernel::Time missing_at = kernel::kNever;       // a start delimiter is due until then
    kernel::Time bad_at = kernel::kNever;           // bad_signal counts, if the other shows none until then
    std::optional<Ended> ended{};                   // not compared with the other channel yet
    unsigned errors = 0;                            // in a row
    unsigned clean = 0;
    bool has_fault = false;
  };
  struct Waiting {
    Channel channel;
    kernel::Time start_delimiter;
  };

  State& of(Channel channel) { return states_[static_cast<std::size_t>(channel)]; }
  const State& of(Channel channel) const { return states_[static_cast<std::size_t>(channel)]; }
  void settle(kernel::Time until);
  void settle_at(kernel::Time at);
  kernel::Time selected_at() const;
  void choose(Channel channel, kernel::Time when);
  void select(Channel channel, kernel::Time start_delimiter);
  void compare(kernel::Time when);
  void find_fault(Channel channel, ChannelEventKind kind, kernel::Time when);

  Rules rules_;
  ChannelRules channels_;
  ChannelUser* user_ = nullptr;
  std::array<State, 2> states_{};
  Channel preferred_ = Channel::a;
  std::optional<Channel> serving_{};
  std::optional<Waiting> waiting_{};  // for the preferred channel
};

}  // namespace fieldproof::token_bus
