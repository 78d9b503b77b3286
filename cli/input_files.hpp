// The files that decide what a call gives: what its options and operands name, and the programs and libraries
// of its implementations.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/options.hpp"
#include "cli/verbs.hpp"
#include "harness/judge/input_file.hpp"

namespace fieldproof::cli {

// All files that are there and that a word of the command line names: "--name=value" of an option, else an
// operand (`option` is null).
std::vector<std::string> input_files_of(std::string_view word, const Option* option);

// Of what decides the outcome of the call, each once, in the order of the options, operands first. A file
// that cannot be read has no hash.
std::vector<judge::InputFile> input_files_of(const Session& session);

}  // namespace fieldproof::cli
