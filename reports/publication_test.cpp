#include "reports/publication.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "reports/approved_text.hpp"
#include "reports/sample_page.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::reports {
namespace {

TEST(PublicationTest, WritesTheApprovedDocuments) {
  expect_approved("publication.json", publication_json(sample_publication()));
  expect_approved("publication.txt", publication_text(sample_publication()));
}

TEST(PublicationTest, IsValidForASchemaValidator) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "publication.json";
  write_text_file(file, publication_json(sample_publication()));
  const AjvJudgement judgement = judge_with_ajv(FIELDPROOF_SOURCE_DIR, schema_path("publication"), {file});
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
}

TEST(PublicationTest, APictureIsNoNumber) {
  const auto json = nlohmann::json::parse(publication_json(sample_publication()));
  EXPECT_TRUE(json["sections"][0]["rows"][1]["published"].is_null());
  EXPECT_TRUE(json["sections"][0]["rows"][1]["agrees"].is_null());
  EXPECT_NE(publication_text(sample_publication()).find("(no number)"), std::string::npos);
}

TEST(PublicationTest, OneRowThatDiffersIsNoReproduction) {
  Publication publication = sample_publication();
  EXPECT_TRUE(is_reproduced(publication));
  publication.sections[0].rows[0].agrees = false;
  EXPECT_FALSE(is_reproduced(publication));
  EXPECT_NE(publication_text(publication).find("DIFFERS"), std::string::npos);
  EXPECT_NE(publication_text(publication).find("not all that is published"), std::string::npos);
}

}  // namespace
}  // namespace fieldproof::reports
