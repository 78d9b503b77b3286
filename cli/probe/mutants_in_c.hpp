#pragma once

#include <array>
#include <ostream>

// For tests: what can be wrong with the valve node in C of the examples, and the case that says so.
namespace fieldproof::cli {

struct MutantInC {
  const char* name;
  const char* test_case;
  const char* reason;

  friend void PrintTo(const MutantInC& one, std::ostream* out) { *out << one.name; }
};

inline constexpr std::array kMutantsInC{
    MutantInC{"check_without_command", "read/is_answered", "no_answer"},
    MutantInC{"answers_writes", "write/drives_the_valves", "write_answered"},
    MutantInC{"address_low_nibble", "address/only_its_own_id_acts", "acts_on_foreign_id"},
    MutantInC{"any_command_reads", "command/undefined_commands_are_ignored", "acts_on_undefined_command"},
    MutantInC{"read_drives_valves", "read/data_is_not_looked_at", "valves_moved_by_read"},
    MutantInC{"data_swapped", "write/drives_the_valves", "valves_wrong"},
    MutantInC{"response_check_with_id", "read/is_answered", "answer_check_wrong"},
    MutantInC{"turns_round_late", "timing/turn_round_is_within_its_span", "answer_too_late"},
    MutantInC{"driver_not_released", "timing/driver_is_on_for_the_answer_only", "driver_not_released"},
    MutantInC{"takes_long_frames", "framing/long_frames_are_discarded", "acts_on_long_frame"},
};

}  // namespace fieldproof::cli
