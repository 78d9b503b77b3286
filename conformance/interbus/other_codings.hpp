#pragma once

#include "protocols/interbus/rules.hpp"

namespace fieldproof::conformance {

// Each coding of a telegram, a status word, a control word and a message is another one than usual.
void change_each_coding(interbus::Rules& rules);

}  // namespace fieldproof::conformance
