#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

// Which edges of instrumented code a run has passed, and how often: of a plug-in (or of the program itself)
// that was compiled with -fsanitize-coverage=trace-pc-guard, inline-8bit-counters (clang) or trace-pc (gcc,
// clang). The program answers the calls that such code makes; there is one record for all of it, because the
// code knows of no other.
//
// A plug-in is loaded anew for each run, elsewhere each time: an edge is known by its library and its place
// in that. Counters that lie in a library are read while it is there: it stays loaded from where it reports
// them, or from `begin_coverage`, until `take_coverage`.
//
// Limit: what another process passes is not seen.
namespace fieldproof::fuzz {

// Some code that was loaded has reported where it passes.
bool has_coverage();
// Of the run that begins now, nothing is known.
void begin_coverage();
// Where a run has been. A feature is an edge with a class of how often it was passed: 1, 2, 3, 4.. 8.. 16..
// 32.. 128.. times. Its number is the same in each run of this process.
struct RunCoverage {
  std::size_t new_edges = 0;              // that no run before has passed
  std::size_t new_features = 0;           // the same of features
  std::vector<std::uint64_t> features{};  // all of the run, rising; left out where none is new
};

// Of the run that ends here; what is new is known from now on, and nothing is kept loaded.
RunCoverage take_coverage();

}  // namespace fieldproof::fuzz
