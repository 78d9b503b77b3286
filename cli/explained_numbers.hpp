// What `explain` says about the settings of a role and about one number of a protocol.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "conformance/catalogue.hpp"

namespace fieldproof::cli {

// "PROTOCOL/ROLE", "PROTOCOL/rules": the table. "loss_limit": its row, in each table that has one. Nothing
// for what has the form of a case id. Throws kernel::Error for a word that no table has.
std::optional<std::string> explained_numbers(const conformance::Catalogue& catalogue, std::string_view word);

}  // namespace fieldproof::cli
