// What an object has otherwise than one as it is made, for people: "bit_rate 500 kbit/s in place of 31.25
// kbit/s". One line for each row of the table, a list as a whole, of a long one its begin and its length.
#pragma once

#include <string>
#include <vector>

#include "harness/field/field.hpp"

namespace fieldproof::field {

std::vector<std::string> differences_of_any(const AnyTable& table, const void* object);

}  // namespace fieldproof::field
