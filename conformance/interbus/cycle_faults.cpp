// What a cycle suffers, in words.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <string_view>

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
  const auto say_at = [&](int telegram, std::string_view what) {
    if (telegram >= 0) said.push_back(fmt::format("{} {}", what, telegram));
  };
  say_at(faults.dropped, "without telegram");
  say_at(faults.duplicated, "twice telegram");
  say_at(faults.inserted, "one more in front of telegram");
  say_at(faults.stop_missing, "no stop bit of telegram");
  say_at(faults.flag_flipped, "the flag changed of telegram");
  say_at(faults.header_flipped, "the header changed of telegram");
  say_at(faults.marked_by, "the status word marked by station");
  say_at(faults.also_marked_by, "and by station");
  if (faults.status_flag_flipped) said.emplace_back("the flag changed of the status telegram behind it");
  if (faults.trailing_telegram) said.emplace_back("one more telegram behind the last");
  if (faults.stuck) said.push_back(fmt::format("the return line held at {}", *faults.stuck ? 1 : 0));
  return fmt::format("{}", fmt::join(said, "; "));
}

}  // namespace fieldproof::interbus
