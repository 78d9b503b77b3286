#pragma once

#include <cstddef>

// Which edges of instrumented code a run has passed, and how often: of a plug-in (or of the program itself)
// that was compiled with -fsanitize-coverage=trace-pc-guard, inline-8bit-counters (clang) or trace-pc (gcc,
// clang). The program answers the calls that such code makes; there is one record for all of it, because the
// code knows of no other.
//
// A plug-in is loaded anew for each run, elsewhere each time: an edge is known by its library and its place
// in that. Counters that lie in a library are read while it is there: it stays loaded from where it reports
// them, or from `begin_coverage`, until `take_new_coverage`.
//
// Limit: what another process passes is not seen.
namespace fieldproof::fuzz {

// Some code that was loaded has reported where it passes.
bool has_coverage();
// Of the run that begins now, nothing is known.
void begin_coverage();
// How many edges the run has passed that no run before has, or more often by a power of two; they are known
// from now on. Ends the run: nothing is kept loaded.
std::size_t take_new_coverage();

}  // namespace fieldproof::fuzz
