// The results for a person at a terminal.
//
// Contract: text of an implementation never reaches the terminal as a control sequence: control characters,
// bidirectional overrides and invalid UTF-8 are written as \xNN or \u{NNNN}. The only escape sequences are
// our own colours, and only when `colour` asks (the caller looks at the terminal and NO_COLOR). A requirement
// whose source is not verified says "unverified". Every text ends with a newline and has no wall time in it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "reports/results.hpp"

namespace fieldproof::reports {

struct TextOptions {
  bool colour = false;
  std::size_t findings = 10;  // how many full finding texts the summary shows at most
  // The command that repeats what no catalogue has; empty: that of the case.
  std::string reproduce{};
};

// The first line of every run: seed, suite version, build, plan and network hash.
std::string run_header(const RunIdentity& identity, const Manifest& manifest);

// One line: verdict, id, reason.
std::string case_line(const judge::CaseResult& result, const TextOptions& options = {});

// What the case measured, a line each with its limits; empty when it measured nothing.
std::string measurement_lines(const judge::CaseResult& result);

// Every finding of a case in full: requirement and its source, expected set, actual, time, first difference,
// layered decode, and the command that reproduces it.
std::string finding_text(const RunIdentity& identity, const judge::CaseResult& result,
                         const TextOptions& options = {});

// Counts with denominators, the cases that are not pass, their findings, and as the last line after a failure
// the command that reproduces it.
std::string summary_text(const Run& run, const TextOptions& options = {});

// How many of `judged` verdicts rest on an unverified source; empty: none does.
std::string unverified_text(std::size_t unverified, std::size_t judged);

// One line of valid UTF-8 without control characters; `escaped_block` keeps line feeds and tabs.
std::string escaped_line(std::string_view text);
std::string escaped_block(std::string_view text);

}  // namespace fieldproof::reports
