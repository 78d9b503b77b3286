#include "conformance/interbus/slave_register_seeded_faults.hpp"

namespace fieldproof::conformance::slave_seeded_faults {

void TearsInputs::sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) {
  const kernel::Duration telegram = kernel::levels_duration(line::kDataTelegramLevels, rules().bit_rate);
  for (unsigned word = 0; word < octets.size() / 2; ++word) {
    octets[2 * word] = static_cast<std::uint8_t>(terminals().input(word, when) >> 8);
    octets[2 * word + 1] = static_cast<std::uint8_t>(terminals().input(word, when + telegram) & 0xFF);
  }
}

void TearsBetweenInputWords::sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) {
  const kernel::Duration telegram = kernel::levels_duration(line::kDataTelegramLevels, rules().bit_rate);
  for (unsigned word = 0; word < octets.size() / 2; ++word, when += telegram) {
    const std::uint16_t input = terminals().input(word, when);
    octets[2 * word] = static_cast<std::uint8_t>(input >> 8);
    octets[2 * word + 1] = static_cast<std::uint8_t>(input & 0xFF);
  }
}

void IdRegisterInDataCycle::sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) {
  const std::uint16_t id = configuration().id_code;
  octets[0] = static_cast<std::uint8_t>(id >> 8);
  octets[1] = static_cast<std::uint8_t>(id & 0xFF);
  Slave::sample_inputs(when, octets.subspan(2));
}

void GlitchesOutputsOnRejectedCycle::on_cycle_rejected(kernel::Time when, bool own_error) {
  Slave::on_cycle_rejected(when, own_error);
  if (configuration().words == 0) return;
  const std::uint16_t held = remembering_.first;
  terminals().output(0, 0, when);
  terminals().output(0, held, when + 2 * kernel::kMicrosecond);
}

}  // namespace fieldproof::conformance::slave_seeded_faults
