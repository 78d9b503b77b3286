#include "conformance/interbus/other_codings.hpp"

namespace fieldproof::conformance {

void change_each_coding(interbus::Rules& rules) {
  rules.telegram = {
      .header = {line::HeaderLevel::control, line::HeaderLevel::flag, line::HeaderLevel::select},
      .select_level = false,
      .control_level = false,
      .data_flag_level = false,
      .most_significant_first = false};
  rules.frame_check = "CRC-16/MAXIM-DOW";
  rules.status_clean = 0x0A50;
  rules.status_marked = 0x8100;
  rules.control_remote_off = 0x8000;
  rules.control_local_off = 0x0100;
  rules.control_reset = 0x0080;
  rules.control_acknowledge = 0x4000;
  rules.message_reconfiguration = 0x8000;
  rules.message_check_error = 0x2000;
  rules.message_peripheral_fault = 0x4000;
}

}  // namespace fieldproof::conformance
