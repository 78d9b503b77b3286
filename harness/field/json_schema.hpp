// JSON Schemas (draft 7) made of tables: of members in a file, of the settings of a role, of a PICS.
//
// A schema knows no range of a duration and of a bit rate: the reader refuses more than it does.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

#include "harness/field/field.hpp"
#include "harness/judge/pics.hpp"

namespace fieldproof::field {

// "properties" of the object that read_members reads.
nlohmann::ordered_json properties_of(const AnyTable& table);
// The settings of a case as an object from names to whole numbers.
nlohmann::ordered_json settings_schema_of(const AnyTable& table, std::string_view role);
// "properties" of the items of a PICS.
nlohmann::ordered_json properties_of(std::span<const judge::PicsItem> items);

}  // namespace fieldproof::field
