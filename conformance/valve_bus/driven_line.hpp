#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/line/character.hpp"
#include "harness/line/waveform.hpp"
#include "harness/segment/station.hpp"
#include "protocols/valve_bus/rules.hpp"

// The lower tester's ear for what one station drives on an RS-485 line: transmissions from the instant at
// which its driver comes on to that at which it goes off, with the characters in them. It decodes with the
// receiver of the harness, by no code of the stations that it judges.
namespace fieldproof::conformance {

struct DrivenCharacter {
  kernel::Time start;       // of its start bit
  kernel::Time busy_until;  // end of its last stop bit
  std::uint16_t data = 0;   // all data bits
  bool is_good = false;

  std::uint8_t octet() const { return static_cast<std::uint8_t>(data); }
};

struct Transmission {
  kernel::Time driver_on;
  kernel::Time driver_off;
  std::vector<DrivenCharacter> characters;

  std::vector<std::uint8_t> octets() const;
  // The longest silence between two characters; zero with fewer.
  kernel::Duration longest_gap() const;
};

// "05 00 FF 00 FA, write FF 00 to node 5"; "05! 00", "no character".
std::string characters_text(const Transmission& transmission, const valve_bus::Rules& rules);
// The same of octets: a command or a response whose check fits is said in words, others are not.
std::string octets_in_words(std::span<const std::uint8_t> octets, const valve_bus::Rules& rules);

class DrivenLine final : public segment::Tap {
 public:
  DrivenLine(const line::CharacterFormat& format, std::int64_t bit_rate)
      : receiver_(format, bit_rate), bit_rate_(bit_rate) {}

  void on_wave(const line::Waveform& wave) override {
    waves_.push_back(wave);
    if (waves_.size() < 2 * most_) return;
    waves_.erase(waves_.begin(), waves_.end() - static_cast<std::ptrdiff_t>(most_));
  }
  // Keeps the last so many waves at least, and at most twice as many; before that it keeps all.
  void keep_last(std::size_t most) { most_ = most; }
  void clear() { waves_.clear(); }
  bool empty() const { return waves_.empty(); }
  std::size_t waves() const { return waves_.size(); }
  // The end of the last wave; the start of time where there is none.
  kernel::Time until() const { return waves_.empty() ? kernel::kStart : waves_.back().end(); }
  // What was driven since the last clear, and clears.
  std::vector<line::Waveform> take() { return std::exchange(waves_, {}); }
  // From now on it expects characters of another kind.
  void listen(const line::CharacterFormat& format, std::int64_t bit_rate) {
    receiver_ = line::CharacterReceiver(format, bit_rate);
    bit_rate_ = bit_rate;
  }

  // The longest silence within a transmission: idle levels are driven in pieces.
  kernel::Duration pause() const;
  // Since the last clear. Waves that follow each other without a gap are one transmission; idle levels are
  // driven in pieces, of which the last one may end a little before the start bit.
  std::vector<Transmission> transmissions();

 private:
  void add(const line::Waveform& wave, Transmission& transmission);

  line::CharacterReceiver receiver_;
  std::int64_t bit_rate_;
  std::vector<line::CharacterReceiver::Received> received_;
  std::vector<line::Waveform> waves_;
  std::size_t most_ = std::size_t{1} << 40U;
};

}  // namespace fieldproof::conformance
