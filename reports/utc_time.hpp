// The instants of a manifest, "2026-11-21T05:18:28Z", as numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fieldproof::reports {

// Milliseconds since 1970; nothing for what is no such text: a manifest may have been written by anybody.
std::optional<std::int64_t> utc_milliseconds(const std::string& utc);

}  // namespace fieldproof::reports
