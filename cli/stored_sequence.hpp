// What `check`, `replay` and `shrink` have in common: a sequence that is run, told and stored.
#pragma once

#include <string>

#include "cli/sequence_file.hpp"
#include "cli/verbs.hpp"
#include "conformance/sequence_check.hpp"

namespace fieldproof::cli {

// What `--iut` says, for the role of the sequence.
void assign_implementations(const Session& session, SequenceFile& file);

// Everything about a sequence that failed: its finding, its commands in words.
std::string sequence_text(const Session& session, const SequenceFile& file, const judge::CaseResult& result,
                          const std::string& reproduce);

// Stores what came of the commands beside them, and tells it. `drawn` is what they were shrunk from.
void keep_sequence(Session& session, SequenceFile file, const judge::CaseResult& result,
                   const std::string& path);

// "from 14 commands, 5 faults (7 bits) to 2 commands, 1 fault (1 bit), in 312 runs"
std::string shrunk_text(const conformance::Sequence& before, const conformance::Sequence& after,
                        std::uint64_t runs);

std::string replay_command(const std::string& file);

// `fuzz --input`: one input of a fuzz target, or one sequence of a corpus, run once and stored as a case.
int case_of_input(Session& session, SequenceFile& target, const std::string& path);

// `replay` of a stored sequence.
int replay_sequence(Session& session);

}  // namespace fieldproof::cli
