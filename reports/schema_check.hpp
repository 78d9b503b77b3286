// Holds a stored document to its shipped JSON Schema, so that what shows documents may trust their shape.
//
// Contract: throws kernel::Error(configuration) with file, line, pointer and what would be right at the first
// value that the schema does not allow. It knows the keywords that the shipped schemas use: type, required,
// properties, additionalProperties, items, enum, const, $ref into the same schema, anyOf, maxItems, minimum,
// maximum, exclusiveMinimum. `pattern` is not held: nothing that is shown depends on it. Any other keyword is
// a broken invariant, so a schema cannot grow beyond this check unseen. Tests ask ajv about all of them.
#pragma once

#include <string_view>

#include "harness/config/document.hpp"

namespace fieldproof::reports {

void check_against_schema(const config::Value& value, std::string_view schema);

}  // namespace fieldproof::reports
