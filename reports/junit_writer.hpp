// The results as JUnit XML, as CI servers read it.
//
// Contract: one <testsuite> per folder of the case id, one <testcase> per case; classname (the id's folder
// with dots) and name (its last part) are unique together when ids are. fail is a <failure>, error an
// <error>, not-applicable a <skipped> with the reason, warn passes and tells its finding in <system-out>;
// inconclusive and none never pass. A run that is incomplete has one testcase more, `is_complete` of
// fieldproof.run, which counts like an inconclusive case: without it the cases that were never judged would
// look like cases that were never asked for. A failure that the baseline expects is a <skipped>; a baseline
// that is not current is a failure of its own, `baseline_is_current`. Valid against reports/schema/junit.xsd,
// well-formed for any octets in any text: what XML 1.0 cannot hold is written as \xNN, the end of a CDATA
// section is split. Properties: purpose, requirement, standing, verdict, seed, repro, virtual_time,
// wall_time, fingerprint.
#pragma once

#include <cstdint>
#include <string>

#include "reports/results.hpp"

namespace fieldproof::reports {

enum class InconclusiveAs : std::uint8_t { error, failure, skipped };

struct JunitOptions {
  InconclusiveAs inconclusive = InconclusiveAs::error;
  bool is_strict = false;  // a warn is a failure
};

std::string junit_xml(const Run& run, const Manifest& manifest, const JunitOptions& options = {});

}  // namespace fieldproof::reports
