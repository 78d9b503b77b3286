#pragma once

#include "conformance/suite.hpp"

// The role of a dual channel manager in the suite of the token bus.
namespace fieldproof::conformance {

RoleRow channel_manager_row();

}  // namespace fieldproof::conformance
