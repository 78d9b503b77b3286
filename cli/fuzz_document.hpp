// What a search of `fuzz` writes as JSON: {"schema": "fieldproof/fuzz/1", ...}, see fuzz.schema.json.
#pragma once

#include <string>

#include "cli/sequence_corpus.hpp"
#include "cli/sequence_file.hpp"
#include "fuzz/search/sequence_search.hpp"

namespace fieldproof::cli {

// How a search ended, in words.
struct FuzzEnd {
  std::string found_in{};   // "sequence 7"; of a finding only
  std::string reproduce{};  // the command that runs it again, likewise
  std::string because{};    // what ended it before its last sequence; may be empty
  bool is_interrupted = false;
};

// `implementations` is what implementations_json gives.
std::string fuzz_json(const fuzz::SequenceFuzzResult& result, const SequenceFile& target,
                      const std::string& implementations, const SequenceCorpus& corpus, const FuzzEnd& end);

}  // namespace fieldproof::cli
