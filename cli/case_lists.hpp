// The cases of a selection as other programs read them: requirements for sphinx-needs, tests for CTest.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "conformance/catalogue.hpp"

namespace fieldproof::cli {

// A needs.json, as the directive `needimport` reads it: of each case a need of type "req" with the
// requirement as its text. Its id is the id of the case in capitals, with '_' for what is no letter or digit;
// where two would be one, the later gets a number. Equal cases give equal octets: there is no time in it.
std::string needs_json(std::span<const conformance::Entry> entries, const std::string& version);

// A script as CTest runs it: one test per case, that calls `program run CASE` with the implementations, in
// `folder`. A case that does not apply is skipped; an inconclusive one fails. As CTestTestfile.cmake of a
// folder it stands alone; in a project it is one of TEST_INCLUDE_FILES.
std::string ctest_script(std::span<const conformance::Entry> entries, const std::string& program,
                         const std::vector<std::string>& options, const std::string& folder);

// `text` as one argument of CMake, whatever is in it.
std::string cmake_quoted(const std::string& text);

}  // namespace fieldproof::cli
