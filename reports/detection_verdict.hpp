// What a document of `matrix --sequences` comes to: of the mutants, each under each seed, how many were
// found.
//
// Contract: the document has the shape of its schema. Fewer found than the verb wants, and an accused
// reference, are failures as its exit code says; a table that is incomplete is no pass.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "reports/document_verdict.hpp"

namespace fieldproof::reports {

Said said_by_detection(const nlohmann::json& document);

}  // namespace fieldproof::reports
