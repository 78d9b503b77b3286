// For tests: holds documents in formats of others to the schemas that these publish, as npm has them.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "reports/approved_text.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::reports {

// `schema` is a path below reports/schema/node_modules. Skips the test where it or ajv is not installed.
inline void expect_valid_by_published_schema(const std::string& schema, const std::string& document) {
  const auto source = std::filesystem::path(FIELDPROOF_SOURCE_DIR);
  const auto file = source / "reports" / "schema" / "node_modules" / schema;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << schema << " is not installed; run script/setup";
  const TemporaryFolder folder;
  write_text_file(folder.path() / "document.json", document);
  const AjvJudgement judgement = judge_with_ajv(source, file, {folder.path() / "document.json"});
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 0) << judgement.output.substr(0, 2000);
}

}  // namespace fieldproof::reports
