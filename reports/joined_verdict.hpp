// What a page says as a whole: the worst of its runs and documents, in one sentence.
//
// Contract: pass means that every run judged all of its cases and none of them failed unexpectedly, and that
// no document says otherwise. What is incomplete, or judged nothing, is inconclusive at best. A document that
// holds no verdict (residual) counts for nothing; a page of nothing else has the verdict none. Sentences hold
// text of implementations as it came; whoever shows them escapes it.
#pragma once

#include <string>
#include <vector>

#include "reports/page_content.hpp"

namespace fieldproof::reports {

// One run or document.
struct JudgedPart {
  std::string name;  // of the directory or file
  judge::Verdict verdict = judge::Verdict::none;
  std::string sentence;  // "the bus stopped in 4 of 16 burst tests": no capital, no full stop

  friend bool operator==(const JudgedPart&, const JudgedPart&) = default;
};

// What must be said about results, and of which runs and documents.
struct JoinedCaveat {
  std::string text;
  std::vector<std::string> names;

  friend bool operator==(const JoinedCaveat&, const JoinedCaveat&) = default;
};

struct JoinedVerdict {
  judge::Verdict verdict = judge::Verdict::none;
  std::string sentence;               // "4 runs: 2 failed (12 of 170 judged cases failed)"
  std::vector<JudgedPart> runs;       // in the order of the page
  std::vector<JudgedPart> documents;  // likewise
  std::vector<JudgedPart> histories;  // none or one
  std::vector<JoinedCaveat> caveats;  // each text once
};

// What one run says by itself.
JudgedPart judged_run(const std::string& name, const Run& run);

JoinedVerdict joined_verdict(const PageContent& content);

// For a terminal: the verdict with its sentence, and when there are several parts a line for each.
std::string joined_text(const JoinedVerdict& joined);

}  // namespace fieldproof::reports
