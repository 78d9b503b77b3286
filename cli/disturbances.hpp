#pragma once

#include "conformance/suite_given.hpp"

namespace fieldproof::cli {

// Those of IEC 61000-4-4, and the channels of the textbooks.
conformance::Disturbances all_disturbances();

}  // namespace fieldproof::cli
