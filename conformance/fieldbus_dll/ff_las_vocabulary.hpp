#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "conformance/sequence.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// What sequences for a link master of Foundation Fieldbus are made of: its link, words, their numbers, what
// leads into its states, and the settings that they may begin with.
namespace fieldproof::conformance {

inline constexpr std::array<fieldbus_dll::FfAddress, 3> kItemsOfLas{0x1120, 0x1220, 0xF520};
inline constexpr std::array<fieldbus_dll::FfAddress, 2> kOwnBuffersOfLas{0x1020, 0x1021};
// Live from the beginning are the first two; the others are polled.
inline constexpr std::array<std::uint8_t, 5> kNodesOfLas{0x11, 0x12, 0x13, 0x14, 0xF5};
inline constexpr std::uint32_t kMacrocycleOfLas = 6'400;  // 200 ms

enum class LasWord : std::uint8_t {
  obey,
  silent,
  join,
  ignore,
  refuse,
  publish,
  use,
  spend,
  ask_time,
  submit,
  write,
  overstay,
  usurp,
  order,
  second,
  told,
  noise,
  hand,
  flood,
  ask_late,
  entity,
  supply
};

// What another scheduler says: an IDLE by an entity, or by nobody that is one; a PT with a duration of 0,
// which is none.
enum class OtherScheduler : std::uint8_t {
  claims,
  passes,
  probes,
  probes_this,
  tells_time,
  compels,
  idles,
  passes_none,
  compels_this
};

// Who is ordered to be the heir sends nothing, something of a scheduler, something of a device; or the order
// is not waited for.
enum class HeirSends : std::uint8_t { nothing, probe, probe_of_this, token_back, not_awaited };

// When it is said in standby: so many 32nds of the silence that claims the link, or an octet before its end.
inline constexpr std::int64_t kPartsOfClaim = 32;

void network_of_las(fieldbus_dll::FfConfiguration& configuration);
SequenceVocabulary ff_las_vocabulary();
std::vector<std::vector<NamedCommand>> states_of_a_master();

}  // namespace fieldproof::conformance
