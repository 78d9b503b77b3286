// What `--iut` says: who plays which role.
//
//   ref                          the reference, in the role of each case
//   deviant:crc_preset_zero      the reference with one deviation; its role is the only one that has it
//   slave=deviant:late           the role is said
//   slave@3=deviant:late         and the position: 1 is next to the master
#pragma once

#include <span>
#include <string>
#include <vector>

#include "conformance/catalogue.hpp"

namespace fieldproof::cli {

// Throws kernel::Error(usage) for an unknown kind, role, position or deviation, with the nearest one. `among`
// are the selected cases: a bare deviation is looked for in their roles.
conformance::Assignment parse_implementation(const std::string& text, const conformance::Catalogue& catalogue,
                                             std::span<const conformance::Entry> among);

}  // namespace fieldproof::cli
