#pragma once

#include <string>

// What models of stations of the data link find.
namespace fieldproof::conformance {

// What does not follow from what was heard.
struct LinkObjection {
  std::string reason;
  std::string expected;  // in words
};

}  // namespace fieldproof::conformance
