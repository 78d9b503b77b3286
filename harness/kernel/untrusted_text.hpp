// Text of an implementation under test is any octets. Before it is stored it becomes valid UTF-8: an octet
// that belongs to no well-formed sequence (RFC 3629: shortest form, no surrogates, at most U+10FFFF) is
// written as the four characters \xNN, so that it stays readable and no JSON or XML parser refuses the
// document.
//
// Contract: valid text comes back unchanged, so doing it twice is doing it once. Control characters stay:
// whoever writes a format escapes what that format forbids. For a terminal and for the sentence of an error
// that is `escaped_line`, which leaves no character that steers what stands around it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fieldproof::kernel {

// Takes the first well-formed UTF-8 sequence off `rest` and returns its code point, or takes one octet off
// and returns nothing when no well-formed sequence begins there. `rest` is not empty.
std::optional<char32_t> take_code_point(std::string_view& rest);

// "\xNN" with two upper-case hexadecimal digits.
std::string escaped_octet(char octet);

std::string as_utf8(std::string_view text);

// One line of valid UTF-8 without control characters, bidirectional overrides and invisible separators: they
// are written as \xNN or \u{NNNN}.
std::string escaped_line(std::string_view text);

}  // namespace fieldproof::kernel
