// Whose items a PICS answers: of the roles that are judged, or of others.
#pragma once

#include <string>
#include <vector>

#include "conformance/catalogue.hpp"
#include "harness/judge/pics.hpp"

namespace fieldproof::cli {

// Throws kernel::Error(configuration) for an answer to what only roles have that are not among these: nobody
// would ask for it. `roles` are paths, PROTOCOL/ROLE; one without items of its own, a network, has those
// of its protocol.
void expect_items_of(const std::vector<std::string>& roles, const judge::Pics& pics,
                     const std::string& pics_file, const conformance::Catalogue& catalogue);

}  // namespace fieldproof::cli
