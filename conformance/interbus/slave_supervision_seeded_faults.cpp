#include "conformance/interbus/slave_supervision_seeded_faults.hpp"

namespace fieldproof::conformance::slave_seeded_faults {

void WithoutStopNoSignOfLife::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (port == interbus::kFromUpstream) {
    line::shared_telegram_code(rules().telegram)
        .decode(reception.levels, 0,
                [&](const line::Telegram& telegram) { is_stop_missing_ = telegram.is_stop_missing(); });
  }
  Slave::receive(port, reception);
}

void InterfaceSwitchesInsideCycle::on_control_octet(kernel::Time when) {
  const auto octets = register_octets();
  const auto word = static_cast<std::uint16_t>(octets[0] << 8 | octets[1]);
  // As soon as the register holds what can be a control word.
  if ((word & ~unsigned{heeded_control_bits()}) == 0) apply_control(word, when);
}

void OutgoingResetClearsOutputs::on_id_read(std::uint16_t messages_read) {
  Slave::on_id_read(messages_read);
  const auto octets = register_octets();
  const auto control = static_cast<std::uint16_t>(octets[0] << 8 | octets[1]);
  if ((control & rules().control_reset) != 0) clear_outputs(last_octet_);
}

void SwitchesWithTheBridge::set_next_present(bool on_branch, bool present) {
  Slave::set_next_present(on_branch, present);
  apply_control(present ? rules().control_local_off : rules().control_remote_off, kernel::kStart);
}

}  // namespace fieldproof::conformance::slave_seeded_faults
