// A folder of sequences that a search of `fuzz` begins with, and what it leaves for the next one.
//
// Contract: a file is one sequence, in the words of its role, and is called by a hash of its content: equal
// sequences are one file, whoever found them. A file that is damaged, or of another role, is left out with
// the reason, and is never written or removed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "conformance/sequence_check.hpp"

namespace fieldproof::cli {

inline constexpr std::string_view kCorpusSchema = "fieldproof/corpus_sequence/1";

struct StoredSequence {
  std::filesystem::path file;
  conformance::Sequence sequence;
};

struct LeftOutFile {
  std::filesystem::path file;
  std::string because;
};

struct SequenceCorpus {
  std::vector<StoredSequence> read;  // by the names of their files
  std::vector<LeftOutFile> left_out;

  std::vector<conformance::Sequence> sequences() const;
};

// The files "*.json" of a folder, by name.
std::vector<std::filesystem::path> corpus_files(const std::filesystem::path& folder);

SequenceCorpus read_corpus(const std::filesystem::path& folder, const conformance::SequenceRole& role,
                           const conformance::SequenceVocabulary& vocabulary);

// One that is stored, with the errors of config::Document.
conformance::Sequence read_corpus_file(const std::filesystem::path& file,
                                       const conformance::SequenceRole& role,
                                       const conformance::SequenceVocabulary& vocabulary);

// Afterwards the folder has these, and nothing of what was `before` besides them.
void write_corpus(const std::filesystem::path& folder, const std::vector<conformance::Sequence>& sequences,
                  const SequenceCorpus& before, const conformance::SequenceRole& role,
                  const conformance::SequenceVocabulary& vocabulary);

}  // namespace fieldproof::cli
