// The results as JUnit XML, as CI servers read it.
//
// Contract: one <testsuite> per folder of the case id, one <testcase> per case; classname (the id's folder
// with dots) and name (its last part) are unique together. fail is a <failure>, error an <error>,
// not-applicable a <skipped> with the reason, warn passes and tells its finding in <system-out>; inconclusive
// and none never pass, and a complaint about the run is one testcase more (outcome.hpp). Valid against
// reports/schema/junit.xsd, well-formed for any octets in any text: what XML 1.0 cannot hold is written as
// \xNN, the end of a CDATA section is split. Properties: purpose, requirement, standing, verdict, seed,
// repro, virtual_time, wall_time, fingerprint. Of a text that is too long the first and the last half of what
// is allowed stay.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "reports/outcome.hpp"
#include "reports/results.hpp"

namespace fieldproof::reports {

// Within what servers read. GitLab reads files of up to 30 MB and 250,000 objects, of which a case here has
// some 80, and 100 MB in all; Jenkins keeps 100,000 characters of the output of a test that fails.
struct JunitLimits {
  std::size_t octets = 10'000'000;  // of the cases of one file
  std::size_t cases = 2'000;        // of one file
  std::size_t text_octets = 100'000;
};

// All in one document, whatever its size.
std::string junit_xml(const Run& run, const Manifest& manifest, const OutcomeRules& rules = {});

// As many documents as the limits want, each complete in itself; a run without cases is one, too.
std::vector<std::string> junit_files(const Run& run, const Manifest& manifest, const OutcomeRules& rules = {},
                                     const JunitLimits& limits = {});

}  // namespace fieldproof::reports
