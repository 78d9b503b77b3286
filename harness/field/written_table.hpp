// Tables for people: the settings of a role in its page, and what `explain` prints of a role or of one rule.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/field/field.hpp"

namespace fieldproof::field {

// One line for each setting.
struct WrittenRow {
  std::string name;
  std::string unit{};
  std::string range{};
  std::string reference{};  // of an object as it is made
  std::string meaning{};
  std::string source{};
  judge::Standing standing = judge::Standing::own;
};
std::vector<WrittenRow> written_rows(const AnyTable& table);

// "| setting | unit | range | reference | meaning | standing |" and below.
std::string markdown_of(const AnyTable& table);
// Columns for a terminal.
std::string columns_of(const AnyTable& table);
// One row in full; nothing when the table has no such row.
std::optional<std::string> explained(const AnyTable& table, std::string_view name);

}  // namespace fieldproof::field
