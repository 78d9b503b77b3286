#pragma once

#include <cstdint>
#include <vector>

#include "conformance/sequence.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// What sequences for a link master of the profile ISA-D are made of: its schedule, words, their numbers, what
// leads into its states, and the settings that they may begin with.
namespace fieldproof::conformance {

inline constexpr int kPeriodOfIsaLas = 600;  // octet durations at 31.25 kbit/s

enum class IsaLasWord : std::uint8_t {
  obey,
  silent,
  use,
  keep,
  compel,
  third,
  spoilt,
  submit,
  transfer,
  second,
  resume,
  late,
  overstay,
  ask,
  prepare,
  request,
  again,
  end,
  pause,
  supply
};

// Who gets what a holder sends.
enum class HolderData : std::uint8_t { for_scheduler, for_another, for_everybody, reply_to_scheduler };
// What comes after a CD of the scheduler.
enum class PeerAnswer : std::uint8_t {
  replies,
  is_silent,
  sends_data,
  another_replies,
  is_none,
  replies_late,
  replies_urgently,
  hands_over,
  higher_scheduler,
  lower_scheduler
};

fieldbus_dll::IsaSchedule schedule_of_isa_las();
SequenceVocabulary isa_las_vocabulary();
std::vector<std::vector<NamedCommand>> states_of_an_isa_las();

}  // namespace fieldproof::conformance
