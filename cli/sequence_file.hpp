// A sequence that failed, as a file that `replay` runs anywhere: role, seed, implementation, commands with
// their faults, and what came of them. It stands alone: what a PICS declared is in it.
//
// Reading is strict: kernel::Error(configuration) names line and pointer. 64-bit numbers are texts.
#pragma once

#include <filesystem>
#include <string>

#include "cli/stored_end.hpp"
#include "conformance/catalogue.hpp"
#include "conformance/sequence_check.hpp"

namespace fieldproof::cli {

inline constexpr std::string_view kSequenceSchema = "fieldproof/sequence/1";

struct SequenceFile {
  const conformance::Suite* suite = nullptr;
  const conformance::SequenceRole* role = nullptr;
  conformance::Setup setup;  // with the seed of the run
  conformance::Sequence sequence;
  StoredEnd end;
};

// "PROTOCOL/ROLE" of "PROTOCOL/ROLE/check/follows_the_model".
std::string role_path(const conformance::SequenceRole& role);

// The suite and the role of "PROTOCOL/ROLE". Throws kernel::Error(usage) that names the roles that there
// are.
std::pair<const conformance::Suite*, const conformance::SequenceRole*> sequence_role_at(
    const std::string& path, const conformance::Catalogue& catalogue);

std::string sequence_file_text(const SequenceFile& file);

// The file is of this kind: its schema says so. A file that cannot be read is of none.
bool is_sequence_file(const std::filesystem::path& file);
SequenceFile load_sequence_file(const std::filesystem::path& file, const conformance::Catalogue& catalogue);

}  // namespace fieldproof::cli
