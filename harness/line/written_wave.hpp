// For tests: transmissions as they are written down.
#pragma once

#include <cstdint>
#include <string_view>

#include "harness/line/waveform.hpp"

namespace fieldproof::line {

// One microsecond per level unless said otherwise.
inline Waveform wave_of(std::string_view levels, kernel::Duration start = {}, std::int64_t rate = 1'000'000) {
  return {kernel::kStart + start, rate, Levels::of_text(levels)};
}

}  // namespace fieldproof::line
