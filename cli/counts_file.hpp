// Counts of a laboratory's burst test as a CSV file, for `fieldproof emc PROTOCOL --fit`.
//
//   level_v,repetition,polarity,time_s,frames,frames_bad,undetected
//   500,5kHz,+,60,73640,446,0
//
// The first line that is no comment ("# ...") is this head. No quotes, no blanks around values, no empty line
// but the last; lines may end with CR LF. Reading is strict: kernel::Error(configuration) names file, line
// and column, and what would be right. At most kMostCountRows rows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "emc/burst_fit.hpp"

namespace fieldproof::cli {

inline constexpr std::size_t kMostCountRows = 10'000;

// `name` is what errors call the text.
std::vector<emc::CountedFrames> read_counts(std::string_view text, const std::string& name);
std::vector<emc::CountedFrames> load_counts(const std::filesystem::path& file);

}  // namespace fieldproof::cli
