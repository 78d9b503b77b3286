// The documents that verbs store with --json, and by which schema a report knows them again.
#pragma once

#include <span>
#include <string>

#include "cli/verbs.hpp"
#include "reports/page_content.hpp"

namespace fieldproof::cli {

// Of what is written now; SOURCE_DATE_EPOCH, seconds since 1970, decides it where it is set. Throws
// kernel::Error for one that is no number: asked before a verb begins, so that nothing is lost by it at the
// end.
std::string date_of_document();

// Writes the JSON of a verb's result to the file of `--json`, with the command that makes it again as its
// last member; nothing when the option is not given. `more` are options of the moment that it needs, too.
void write_document(const Session& session, const std::string& verb, const std::string& json,
                    const std::string& more = "");

std::span<const reports::DocumentKind> document_kinds();

}  // namespace fieldproof::cli
