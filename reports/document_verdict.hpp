// What a stored document of another verb comes to, in the verdicts of cases, and in words.
//
// Contract: the document has the shape of its schema. As the exit code of its verb says, only stricter where
// a reader would be misled: a bus that stopped and criterion C are failures here whatever --worst allowed,
// and criterion B is a warning.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "harness/judge/verdict.hpp"

namespace fieldproof::reports {

struct Said {
  judge::Verdict verdict = judge::Verdict::none;
  std::string sentence;  // no capital, no full stop
};

// None: it holds no verdict.
Said said_by_document(const nlohmann::json& document);

// "1 case", "2 cases".
std::string several(std::size_t count, std::string_view one);

void add_words(std::string& sentence, const std::string& words, std::string_view between = ", ");

}  // namespace fieldproof::reports
