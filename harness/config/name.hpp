#pragma once

#include <string>

#include "harness/config/document.hpp"

// What a person calls a network or one of its parts; the minLength of its schema.
namespace fieldproof::config {

// Throws kernel::Error for what is no string, and for an empty one.
inline std::string read_name(const Value& value) {
  std::string name(value.as_string());
  if (name.empty()) fail(value, "a name has at least one character; write one");
  return name;
}

}  // namespace fieldproof::config
