#pragma once

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

}  // namespace fieldproof::conformance
