#pragma once

#include <string>
#include <utility>

#include "protocols/token_bus/translator.hpp"

// Translators that take what is requested otherwise than it is, or drive answers otherwise, and managers that
// do something else than the table of commands says.
namespace fieldproof::conformance::translator_seeded_faults {

using namespace token_bus;

inline std::string unit_in(const std::string& levels, std::size_t unit) {
  return levels.substr(unit * kUnitLevels, kUnitLevels);
}
inline bool is_command(const std::string& levels, std::size_t unit) {
  return unit_in(levels, unit).starts_with('0');
}

// ---- what is requested ----

// What stands in the place of a unit; `taken` are the units in front of it, as they were taken.
using Taken = std::string (*)(const std::string& levels, std::size_t unit, const std::string& taken);

class TakesRequests final : public Translator {
 public:
  TakesRequests(const TranslatorConfiguration& configuration, Taken how)
      : Translator(configuration), how_(how) {}
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    if (port != kMacSide) return Translator::receive(port, reception);
    const std::string levels = reception.levels.text();
    std::string taken;
    taken.reserve(levels.size());
    for (std::size_t unit = 0; unit < units_in(reception.levels); ++unit) taken += how_(levels, unit, taken);
    Translator::receive(port, {reception.start, reception.rate, line::Levels::of_text(taken)});
  }

 private:
  Taken how_;
};

template <unsigned from, unsigned to>
std::string code_taken_for(const std::string& levels, std::size_t unit, const std::string&) {
  constexpr auto kText = [](unsigned code) {
    return std::string{(code & 8) != 0 ? '1' : '0', (code & 4) != 0 ? '1' : '0', (code & 2) != 0 ? '1' : '0',
                       (code & 1) != 0 ? '1' : '0'};
  };
  const std::string read = unit_in(levels, unit);
  return read == kText(from) ? kText(to) : read;
}
inline std::string single_silence_filled(const std::string& levels, std::size_t unit, const std::string&) {
  const auto is_silence = [&](std::size_t at) { return unit_in(levels, at).starts_with("111"); };
  const bool is_between =
      unit > 0 && unit + 1 < levels.size() / kUnitLevels && !is_silence(unit - 1) && !is_silence(unit + 1);
  return is_silence(unit) && is_between ? "1010" : unit_in(levels, unit);
}
inline std::string stuffs_after_64_zeros(const std::string& levels, std::size_t unit,
                                         const std::string& taken) {
  constexpr std::size_t kRow = 64 * kUnitLevels;
  static const std::string zeros = [] {
    std::string row;
    while (row.size() < kRow) row += "1000";
    return row;
  }();
  return taken.ends_with(zeros) ? "1001" : unit_in(levels, unit);
}
inline std::string first_after_a_command_lost(const std::string& levels, std::size_t unit,
                                              const std::string&) {
  const bool is_first = unit > 0 && is_command(levels, unit - 1) && !is_command(levels, unit);
  return is_first ? "1111" : unit_in(levels, unit);
}
inline std::string command_of_two_symbols(const std::string& levels, std::size_t unit, const std::string&) {
  const bool is_first =
      is_command(levels, unit) && (unit == 0 || unit_in(levels, unit - 1) != unit_in(levels, unit));
  return is_first ? "0001" : unit_in(levels, unit);
}
inline std::string first_command_stands(const std::string& levels, std::size_t unit,
                                        const std::string& taken) {
  const bool goes_on = unit > 0 && is_command(levels, unit) && is_command(levels, unit - 1);
  return goes_on ? unit_in(taken, unit - 1) : unit_in(levels, unit);
}
inline std::string reset_after_eight_symbols(const std::string& levels, std::size_t unit,
                                             const std::string&) {
  constexpr std::size_t kSymbols = 8;
  if (unit_in(levels, unit) != "0111") return unit_in(levels, unit);
  std::size_t first = unit;
  while (first > 0 && unit_in(levels, first - 1) == "0111") --first;
  return unit - first < kSymbols ? "0001" : "0111";
}

// By the clock that it has, not by that of the MAC.
class SendsByItsOwnClock final : public Translator {
  using Translator::Translator;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    if (port != kMacSide) return Translator::receive(port, reception);
    Translator::receive(
        port, {reception.start, mac_side_rate(configuration().rules.phy_bit_rate), reception.levels});
  }
};

// A signal error counts for a test after whatever was requested.
class MaskWithoutTransmitter final : public Translator {
  using Translator::Translator;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    if (port == kMacSide) requested_until_ = reception.end();
    if (port == kMacSide || requested_until_ == kernel::kNever) return Translator::receive(port, reception);
    std::string levels = reception.levels.text();
    const kernel::Time end =
        requested_until_ + mac_symbols(configuration().rules, configuration().error_mask_symbols);
    for (std::size_t n = 1; n < levels.size() && reception.time_of(n) < end; n += kUnitLevels)
      if (reception.time_of(n) >= requested_until_) levels[n] = '1';
    Translator::receive(port, {reception.start, reception.rate, line::Levels::of_text(levels)});
  }

  kernel::Time requested_until_ = kernel::kNever;
};

// ---- what is driven ----

// Of units that are driven directly after each other: the unit, and how many of its kind were in front.
using Driven = std::string (*)(std::string unit, std::size_t in_front);

class DrivesOtherwise final : public Translator, private segment::Port {
 public:
  DrivesOtherwise(const TranslatorConfiguration& configuration, Driven how, kernel::Duration later)
      : Translator(configuration), how_(how), later_(later) {}
  void wire(segment::Port& phy, segment::Port& mac) override {
    mac_ = &mac;
    Translator::wire(phy, *this);
  }

 private:
  void drive(line::Waveform& wave) override {
    const std::string levels = wave.levels.text();
    if (wave.start > driven_until_) in_front_ = 0;
    driven_until_ = wave.end();
    std::string driven;
    for (std::size_t unit = 0; unit < units_in(wave.levels); ++unit) {
      const std::string right = unit_in(levels, unit);
      in_front_ = right == last_ ? in_front_ + 1 : 0;
      last_ = right;
      driven += how_(right, in_front_);
    }
    line::Waveform other{wave.start, wave.rate, line::Levels::of_text(driven)};
    if (last_.starts_with('0')) other.start += later_;
    mac_->drive(other);
  }

  Driven how_;
  kernel::Duration later_;
  segment::Port* mac_ = nullptr;
  kernel::Time driven_until_ = kernel::kStart;
  std::size_t in_front_ = 0;
  std::string last_;
};

inline std::string as_it_is(std::string unit, std::size_t) {
  return unit;
}
template <std::size_t most>
std::string answers_of_at_most(std::string unit, std::size_t in_front) {
  return unit.starts_with('0') && in_front >= most ? "1111" : unit;
}
inline std::string symbol_0_off(std::string unit, std::size_t) {
  if (unit.starts_with('0')) unit.back() = '0';
  return unit;
}

// ---- SMANAGER ----

// Each symbol of a command does it.
class EnableToggles final : public StationManager {
  bool may_transmit() const override { return StationManager::may_transmit() && is_on_; }
  ManagementAnswer answer_to(ManagementCommand command) const override {
    if (command == ManagementCommand::reset) is_on_ = false;
    if (command == ManagementCommand::enable_transmitter) is_on_ = !is_on_;
    return StationManager::answer_to(command);
  }

  mutable bool is_on_ = false;
};

class DisableToggles final : public StationManager {
  bool is_looped_back() const override { return StationManager::is_looped_back() || !is_off_; }
  ManagementAnswer answer_to(ManagementCommand command) const override {
    if (command == ManagementCommand::reset) is_off_ = false;
    if (command == ManagementCommand::disable_loopback) is_off_ = !is_off_;
    return StationManager::answer_to(command);
  }

  mutable bool is_off_ = false;
};

class EnableDisablesLoopback final : public StationManager {
  bool is_looped_back() const override { return StationManager::is_looped_back() && !may_transmit(); }
};

class OnTheLineAtPowerUp final : public StationManager {
  bool loops_back_at_reset() const override { return std::exchange(is_command_, false); }
  ManagementAnswer answer_to(ManagementCommand command) const override {
    is_command_ = command == ManagementCommand::reset;
    return StationManager::answer_to(command);
  }

  mutable bool is_command_ = false;
};

class EnabledAfterAJabber final : public StationManager {
  bool may_transmit() const override { return StationManager::may_transmit() || is_enabled_; }
  ManagementAnswer answer_to(ManagementCommand command) const override {
    if (command == ManagementCommand::reset) is_enabled_ = false;
    is_enabled_ |= command == ManagementCommand::enable_transmitter && has_jabbered();
    return StationManager::answer_to(command);
  }

  mutable bool is_enabled_ = false;
};

class JabberLoopsBack final : public StationManager {
  bool is_looped_back() const override { return StationManager::is_looped_back() || has_jabbered(); }
};

class JabberOutlivesSupply final : public StationManager {
  bool ends_jabber_at_reset() const override { return std::exchange(is_command_, false); }
  ManagementAnswer answer_to(ManagementCommand command) const override {
    is_command_ = command == ManagementCommand::reset;
    return StationManager::answer_to(command);
  }

  mutable bool is_command_ = false;
};

inline ManagementAnswer disable_refused_after_jabber(ManagementCommand command, bool has_jabbered,
                                                     ManagementAnswer right) {
  const bool is_refused = has_jabbered && command == ManagementCommand::disable_loopback;
  return is_refused ? ManagementAnswer::physical_error : right;
}

inline ManagementAnswer serial_data_tell_a_jabber(ManagementCommand command, bool has_jabbered,
                                                  ManagementAnswer right) {
  const bool is_told = has_jabbered && command == ManagementCommand::serial_data;
  return is_told ? ManagementAnswer::physical_error : right;
}

// The second time that it is asked by this command.
class AnswersAJabberOnce final : public StationManager {
 public:
  AnswersAJabberOnce(ManagementCommand command, ManagementAnswer second)
      : command_(command), second_(second) {}

 private:
  ManagementAnswer answer_to(ManagementCommand command) const override {
    if (!has_jabbered()) times_ = 0;
    const bool is_second = has_jabbered() && command == command_ && ++times_ > 1;
    return is_second ? second_ : StationManager::answer_to(command);
  }

  ManagementCommand command_;
  ManagementAnswer second_;
  mutable unsigned times_ = 0;
};

// With a command something else begins anew, too.
template <typename Block>
class CommandResets final : public StationManager {
 public:
  explicit CommandResets(Block& block) : block_(block) {}

 private:
  ManagementAnswer answer_to(ManagementCommand command) const override {
    block_.reset();
    return StationManager::answer_to(command);
  }

  Block& block_;
};

}  // namespace fieldproof::conformance::translator_seeded_faults
