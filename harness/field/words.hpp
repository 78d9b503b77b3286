// Values and ranges of rows as a person reads them.
#pragma once

#include <string>

#include "harness/field/field.hpp"

namespace fieldproof::field {

// "A0h", "001Fh": as many digits as a number of this range has, of an octet or a word.
std::string hexadecimal_text(const Range& range, std::int64_t number);
// "1.5 bit", "500 kbit/s", "A55Ah", "2 ms", "P0", "yes", or the word that stands for this value.
std::string text_of(const Row& row, std::int64_t number);
// "256 octets, 128 octets, 64 octets"; "none".
std::string text_of_list(const Row& row, const void* items);
// "1200 bit/s to 1 Mbit/s", "P0, P1 or P2", "yes or no".
std::string range_text(const Row& row);
// The same as numbers of a setting: "1200 to 1000000", "0: P0, 1: P1, 2: P2", "0 or 1"; of a
// duration "0 s to 1.000 s", which nobody reads in picoseconds.
std::string setting_range_text(const Row& row);
// Of a setting: "bit/s", "ps", "half bits" ...
std::string setting_unit_text(const Row& row);

}  // namespace fieldproof::field
