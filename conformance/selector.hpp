// What a person writes to choose test cases.
//
//   PROTOCOL/ROLE/**      path glob over ids: `*` any text within a part, `?` one character, `**` any number
//   of
//                         parts (also none); a text without these characters names one case
//   +must                 every case with the tag
//   @smoke.txt            the selectors of a file, one per line; `#` starts a comment
//   !PROTOCOL/ROLE/long*  takes away what the selector after it matches
//
// Contract: cases tagged `canary` must fail, so they are selected only when they are named exactly or by
// `+canary`, never by a glob. A selector file that cannot be read, that includes itself, is very long or has
// no selector throws kernel::Error(configuration).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/test_case.hpp"

namespace fieldproof::conformance {

struct Selector {
  enum class Kind { exact, glob, tag };
  Kind kind = Kind::exact;
  bool is_exclusion = false;
  std::string text;   // without the leading `!` and `+`
  std::string place;  // "selectors.txt:3", empty for one of the command line

  std::string written() const;  // as a person writes it
};

// Reads the files that `@file` names; the result has no `@` any more.
std::vector<Selector> parse_selectors(std::span<const std::string> texts);

bool matches_path(std::string_view glob, std::string_view path);
bool matches(const Selector& selector, const TestCase& test_case);

}  // namespace fieldproof::conformance
