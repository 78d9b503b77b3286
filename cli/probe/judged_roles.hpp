// For tests: every role, with a short case of it.
#pragma once

#include <fmt/format.h>

#include <array>
#include <ostream>
#include <string>

namespace fieldproof::cli {

struct JudgedRole {
  const char* protocol;
  const char* name;
  const char* test_case;  // a short one, that the reference passes

  std::string path() const { return fmt::format("{}/{}", protocol, name); }
  friend void PrintTo(const JudgedRole& role, std::ostream* out) { *out << role.path(); }
};

inline constexpr std::array kJudgedRoles = {
    JudgedRole{"interbus", "slave", "frame_check/flipped_data_bit_is_rejected_marked_and_told"},
    JudgedRole{"interbus", "master", "rejection/marked_status_names_the_segment"},
    JudgedRole{"valve_bus", "node", "read/is_answered"},
    JudgedRole{"valve_bus", "host", "request/write_is_sent_with_its_check"},
    JudgedRole{"fieldbus_dll", "isa_dle", "single_token/one_frame_is_sent"},
    JudgedRole{"fieldbus_dll", "isa_las", "schedule/each_item_has_its_time"},
    JudgedRole{"fieldbus_dll", "ff_device", "probe/is_answered"},
    JudgedRole{"fieldbus_dll", "ff_las", "schedule/each_item_has_its_time"},
    JudgedRole{"token_bus", "station", "passing/token_goes_to_its_successor"},
    JudgedRole{"token_bus", "translator", "encoding/a_frame_goes_out_whole"},
    JudgedRole{"token_bus", "channel_manager", "selection/stays_with_who_served"},
};

}  // namespace fieldproof::cli
