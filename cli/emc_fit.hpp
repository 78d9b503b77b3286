// `fieldproof emc PROTOCOL --fit FILE`: a laboratory's counts against the burst model.
#pragma once

#include "cli/verbs.hpp"

namespace fieldproof::cli {

// Gives the exit code: consistent 0, contradicts 1, too few counts to tell 2.
int fit_emc(Session& session);

}  // namespace fieldproof::cli
