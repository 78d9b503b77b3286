#include "conformance/interbus/other_codings.hpp"

#include <array>
#include <utility>

namespace fieldproof::conformance {
namespace {

using interbus::Rules;

// Where two have one place, they change places.
constexpr auto kOtherCodings = std::to_array<OtherCoding>({
    {.id = "another_place_of_select",
     .setting = "select_place 1, control_place 0",
     .change = [](Rules& rules) { std::swap(rules.telegram.header[0], rules.telegram.header[1]); },
     .mutant = "header_places_hard_coded",
     .does = "has the header levels at their usual places whatever the settings say",
     .keep = [](Rules& rules) { rules.telegram.header = Rules{}.telegram.header; },
     .reason = "octet_wrong"},
    {.id = "another_place_of_the_flag",
     .setting = "control_place 2, flag_place 1",
     .change = [](Rules& rules) { std::swap(rules.telegram.header[1], rules.telegram.header[2]); },
     .mutant = "header_places_hard_coded",
     .does = "has the header levels at their usual places whatever the settings say",
     .keep = [](Rules& rules) { rules.telegram.header = Rules{}.telegram.header; },
     .reason = "octet_wrong"},
    {.id = "another_select_level",
     .setting = "select_level 0",
     .change = [](Rules& rules) { rules.telegram.select_level = false; },
     .mutant = "select_level_hard_coded",
     .does = "takes the usual level of SL for set whatever the setting says",
     .keep = [](Rules& rules) { rules.telegram.select_level = true; },
     .reason = "octet_wrong"},
    {.id = "another_control_level",
     .setting = "control_level 0",
     .change = [](Rules& rules) { rules.telegram.control_level = false; },
     .mutant = "control_level_hard_coded",
     .does = "takes the usual level of CR for set whatever the setting says",
     .keep = [](Rules& rules) { rules.telegram.control_level = true; },
     .reason = "octet_wrong"},
    {.id = "another_data_flag_level",
     .setting = "data_flag_level 0",
     .change = [](Rules& rules) { rules.telegram.data_flag_level = false; },
     .mutant = "data_flag_level_hard_coded",
     .does = "takes the usual level of FL for that of a data telegram whatever the setting says",
     .keep = [](Rules& rules) { rules.telegram.data_flag_level = true; },
     .reason = "octet_wrong"},
    {.id = "another_order_of_data_bits",
     .setting = "most_significant_first 0",
     .change = [](Rules& rules) { rules.telegram.most_significant_first = false; },
     .mutant = "most_significant_first_hard_coded",
     .does = "has the most significant data bit first whatever the setting says",
     .keep = [](Rules& rules) { rules.telegram.most_significant_first = true; },
     .reason = "octet_wrong"},
    {.id = "another_check_polynomial",
     .setting = "check_polynomial 32773",
     .change = [](Rules& rules) { rules.frame_check = "CRC-16/CMS"; },
     .mutant = "final_xor_hard_coded",
     .does = "",
     .keep = [](Rules& rules) { rules.frame_check = Rules{}.frame_check; },
     .reason = "octet_wrong"},
    {.id = "another_check_preset",
     .setting = "check_preset 0",
     .change = [](Rules& rules) { rules.frame_check = "CRC-16/XMODEM"; },
     .mutant = "final_xor_hard_coded",
     .does = "",
     .keep = [](Rules& rules) { rules.frame_check = Rules{}.frame_check; },
     .reason = "octet_wrong"},
    {.id = "another_check_final_xor",
     .setting = "check_final_xor 65535",
     .change = [](Rules& rules) { rules.frame_check = "CRC-16/GENIBUS"; },
     .mutant = "final_xor_hard_coded",
     .does = "",
     .keep = [](Rules& rules) { rules.frame_check = Rules{}.frame_check; },
     .reason = "octet_wrong"},
    {.id = "another_order_of_check_bits",
     .setting = "check_is_reflected 1",
     .change = [](Rules& rules) { rules.frame_check = "CRC-16/MCRF4XX"; },
     .mutant = "final_xor_hard_coded",
     .does = "",
     .keep = [](Rules& rules) { rules.frame_check = Rules{}.frame_check; },
     .reason = "octet_wrong"},
    {.id = "another_status_clean",
     .setting = "status_clean 0A50h",
     .change = [](Rules& rules) { rules.status_clean = 0x0A50; },
     .mutant = "status_clean_hard_coded",
     .does = "takes the usual status word for that of a cycle without an error whatever the setting says",
     .keep = [](Rules& rules) { rules.status_clean = Rules{}.status_clean; },
     .reason = "outputs_wrong"},
    {.id = "another_status_marked",
     .setting = "status_marked 8100h",
     .change = [](Rules& rules) { rules.status_marked = 0x8100; },
     .mutant = "status_marked_hard_coded",
     .does = "marks a status word with all bits whatever the setting says",
     .keep = [](Rules& rules) { rules.status_marked = Rules{}.status_marked; },
     .reason = "octet_wrong"},
    {.id = "another_control_remote_off",
     .setting = "control_remote_off 8000h",
     .change = [](Rules& rules) { rules.control_remote_off = 0x8000; },
     .mutant = "control_remote_off_hard_coded",
     .does = "takes the usual bit of the control word for OUT1 off whatever the setting says",
     .keep = [](Rules& rules) { rules.control_remote_off = Rules{}.control_remote_off; },
     .reason = "octet_wrong"},
    {.id = "another_control_local_off",
     .setting = "control_local_off 0100h",
     .change = [](Rules& rules) { rules.control_local_off = 0x0100; },
     .mutant = "control_local_off_hard_coded",
     .does = "takes the usual bit of the control word for OUT2 off whatever the setting says",
     .keep = [](Rules& rules) { rules.control_local_off = Rules{}.control_local_off; },
     .reason = "octet_wrong"},
    {.id = "another_control_reset",
     .setting = "control_reset 0080h",
     .change = [](Rules& rules) { rules.control_reset = 0x0080; },
     .mutant = "control_reset_hard_coded",
     .does = "takes the usual bit of the control word for a reset of the outgoing bus whatever the setting "
             "says",
     .keep = [](Rules& rules) { rules.control_reset = Rules{}.control_reset; },
     .reason = "octet_wrong"},
    {.id = "another_message_reconfiguration",
     .setting = "message_reconfiguration 8000h, message_peripheral_fault 2000h",
     .change = [](Rules& rules) { std::swap(rules.message_reconfiguration, rules.message_peripheral_fault); },
     .mutant = "message_reconfiguration_hard_coded",
     .does = "asks for a reconfiguration by the usual bit whatever the setting says",
     .keep = [](Rules& rules) { rules.message_reconfiguration = Rules{}.message_reconfiguration; },
     .reason = "octet_wrong"},
    {.id = "another_message_check_error",
     .setting = "message_check_error 2000h, message_reconfiguration 4000h",
     .change = [](Rules& rules) { std::swap(rules.message_check_error, rules.message_reconfiguration); },
     .mutant = "message_check_error_hard_coded",
     .does = "reports check errors by the usual bit whatever the setting says",
     .keep = [](Rules& rules) { rules.message_check_error = Rules{}.message_check_error; },
     .reason = "octet_wrong"},
    {.id = "another_message_peripheral_fault",
     .setting = "message_peripheral_fault 4000h, message_check_error 8000h",
     .change = [](Rules& rules) { std::swap(rules.message_peripheral_fault, rules.message_check_error); },
     .mutant = "message_peripheral_fault_hard_coded",
     .does = "reports peripheral faults by the usual bit whatever the setting says",
     .keep = [](Rules& rules) { rules.message_peripheral_fault = Rules{}.message_peripheral_fault; },
     .reason = "octet_wrong"},
});

}  // namespace

std::span<const OtherCoding> other_codings() {
  return kOtherCodings;
}

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
