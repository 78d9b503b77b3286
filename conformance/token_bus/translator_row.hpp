#pragma once

#include "conformance/suite.hpp"

// The role of a physical layer service translator in the suite of the token bus.
namespace fieldproof::conformance {

RoleRow translator_row();

}  // namespace fieldproof::conformance
