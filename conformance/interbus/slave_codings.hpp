#pragma once

#include <vector>

#include "conformance/sequence.hpp"
#include "harness/field/settings.hpp"
#include "protocols/interbus/device.hpp"

// The codings of telegrams, status words, control words and messages as settings that a sequence begins with:
// each alone may be another one than usual.
namespace fieldproof::conformance {

std::vector<SequenceSetting> settings_of_codings(const interbus::SlaveConfiguration& as_made);

// Levels of a header have a place each, and so have the bits of a word: who is given the place of another one
// changes places with it. The same as given besides; of two that are given one place, the later has it.
field::Settings with_changed_places(const field::Settings& given,
                                    const interbus::SlaveConfiguration& as_made);

}  // namespace fieldproof::conformance
