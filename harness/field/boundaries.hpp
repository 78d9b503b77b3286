// The values of a row that a test tries first: nothing, both ends of the range and their neighbours, the
// reference's value.
#pragma once

#include <vector>

#include "harness/field/field.hpp"

namespace fieldproof::field {

struct Boundaries {
  std::vector<std::int64_t> inside;   // rising, each once
  std::vector<std::int64_t> outside;  // one beyond each end
};
// `object` is as it is made. Of a truth and a choice nothing is outside: there is no such value.
Boundaries boundaries_of(const Row& row, const void* object);

}  // namespace fieldproof::field
