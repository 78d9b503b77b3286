#pragma once

#include <cstdint>
#include <span>

#include "protocols/valve_bus/codec.hpp"

// Stations of either role, host or node, that look at a character in another way than the reference.
namespace fieldproof::conformance {

template <typename Station>
class StopBitIgnored : public Station {
  using Station::Station;
  line::UartCharacter judged(const line::UartCharacter& character) const override {
    line::UartCharacter taken = character;
    taken.is_stop_missing = false;
    return taken;
  }
};

template <typename Station>
class ParityIgnored : public Station {
  using Station::Station;
  line::UartCharacter judged(const line::UartCharacter& character) const override {
    line::UartCharacter taken = character;
    taken.is_parity_wrong = false;
    return taken;
  }
};

// A character whose ninth bit is 0 spoils its frame.
template <typename Station>
class NinthBitRequired : public Station {
  using Station::Station;
  line::UartCharacter judged(const line::UartCharacter& character) const override {
    line::UartCharacter taken = character;
    const bool has_ninth_bit = valve_bus::character_format(this->rules()).data_bits == 9;
    if (has_ninth_bit && (character.data & 0x100U) == 0) taken.is_stop_missing = true;
    return taken;
  }
};

// Sends the ninth bit as 0.
template <typename Station>
class SendsNinthBit0 : public Station {
  using Station::Station;
  void transmit(std::span<const std::uint8_t> octets, kernel::Time start) override {
    const auto& rules = this->rules();
    const line::CharacterCode code(valve_bus::character_format(rules));
    line::Waveform wave;
    wave.rate = rules.bit_rate;
    wave.start = start - valve_bus::bits(rules, rules.driver_on_bits);
    wave.levels.append_idle(rules.driver_on_bits);
    for (const std::uint8_t octet : octets) code.append(wave.levels, octet);
    this->line().drive(wave);
  }
};

}  // namespace fieldproof::conformance
