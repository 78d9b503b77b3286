#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "protocols/token_bus/dual_channel.hpp"

// Dual channel managers that pass symbols and reports on otherwise.
namespace fieldproof::conformance::dual_channel_seeded_faults {

using namespace token_bus;

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
