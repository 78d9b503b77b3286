// What a search of `fuzz` writes as JSON: {"schema": "fieldproof/fuzz/1", ...}, see fuzz.schema.json.
#pragma once

#include <string>

#include "cli/sequence_corpus.hpp"
#include "cli/sequence_file.hpp"
#include "fuzz/search/sequence_search.hpp"

namespace fieldproof::cli {

// `implementations` is what implementations_json gives.
std::string fuzz_json(const fuzz::SequenceFuzzResult& result, const SequenceFile& target,
                      const std::string& implementations, const SequenceCorpus& corpus);

}  // namespace fieldproof::cli
