// What a cycle suffers, in words.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "conformance/interbus/ring_emulator.hpp"

namespace fieldproof::interbus {

std::string text_of(const CycleFaults& faults) {
  std::vector<std::string> said;
  for (const auto& [telegram, mask, check_fits] : faults.flips)
    if (mask != 0)
      said.push_back(fmt::format("octet {} changed by {:02X}h{}", telegram, mask,
                                 check_fits ? ", with a check that fits" : ""));
  for (const auto& [telegram, level] : faults.level_flips)
    said.push_back(fmt::format("level {} of telegram {} flipped", level, telegram));
  if (faults.longer_bits != 0)
    said.push_back(fmt::format("the register {} bits {}", std::abs(faults.longer_bits),
                               faults.longer_bits > 0 ? "longer" : "shorter"));
  const std::array<std::pair<int, std::string_view>, 8> places{{
      {faults.dropped, "telegram {} left out"},
      {faults.duplicated, "telegram {} twice"},
      {faults.inserted, "one more telegram in front of telegram {}"},
      {faults.stop_missing, "telegram {} without its stop bit"},
      {faults.flag_flipped, "telegram {} with its flag bit changed"},
      {faults.header_flipped, "telegram {} with its header changed"},
      {faults.marked_by, "the status word marked by station {}"},
      {faults.also_marked_by, "the status word marked by station {}"},
  }};
  for (const auto& [place, text] : places)
    if (place >= 0) said.push_back(fmt::format(fmt::runtime(text), place));
  if (faults.status_flag_flipped) said.emplace_back("the flag changed of the status telegram behind it");
  if (faults.trailing_telegram)
    said.push_back(fmt::format("one more telegram {} bits after the last", faults.trailing_gap_bits));
  if (faults.stuck) said.push_back(fmt::format("the return line held at {}", *faults.stuck ? 1 : 0));
  return fmt::format("{}", fmt::join(said, "; "));
}

}  // namespace fieldproof::interbus
