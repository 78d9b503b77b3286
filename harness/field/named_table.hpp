#pragma once

#include <string_view>

// A table with the name under which a user asks for it: "node", "rules".
namespace fieldproof::field {

struct AnyTable;

struct NamedTable {
  std::string_view name;
  const AnyTable* table = nullptr;
};

// The JSON Schema of a file: "network".
struct NamedSchema {
  std::string_view name;
  std::string_view text;
};

}  // namespace fieldproof::field
