#include "reports/publication.hpp"

#include <gtest/gtest.h>

#include <cmath>
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
  EXPECT_TRUE(json["sections"][0]["rows"][1]["compared"].is_null());
  EXPECT_NE(publication_text(sample_publication()).find("(no number)"), std::string::npos);
}

TEST(PublicationTest, ARowIsWhatItsNumbersSay) {
  EXPECT_EQ(reproduction_of(std::nullopt), Reproduction::not_checked);
  EXPECT_EQ(reproduction_of(within(614, 0.5, 614.5)), Reproduction::agrees);
  EXPECT_EQ(reproduction_of(within(614, 0.5, 614.51)), Reproduction::differs);
  EXPECT_EQ(reproduction_of(at_most(4, 4)), Reproduction::agrees);
  EXPECT_EQ(reproduction_of(at_most(4, 5)), Reproduction::differs);
  EXPECT_EQ(reproduction_of(more_than(0, 0)), Reproduction::differs);
  EXPECT_EQ(reproduction_of(more_than(0, 1)), Reproduction::agrees);
  EXPECT_EQ(reproduction_of(own(within(2, 1, 3))), Reproduction::own);
  EXPECT_EQ(reproduction_of(own(within(2, 1, 4))), Reproduction::differs);
  EXPECT_EQ(reproduction_of(within(1, 1, std::nan(""))), Reproduction::inconclusive);
  EXPECT_EQ(reproduction_of(of_samples(within(2, 1, 9), 9, 10)), Reproduction::inconclusive);
  EXPECT_EQ(reproduction_of(of_samples(within(2, 1, 9), 10, 10)), Reproduction::differs);
}

TEST(PublicationTest, OneRowThatDiffersIsCounted) {
  Publication publication = sample_publication();
  EXPECT_EQ(rows_that(publication, Reproduction::differs), 0U);
  publication.sections[0].rows[0].compared->ours = 0.814;
  EXPECT_EQ(rows_that(publication, Reproduction::differs), 1U);
  EXPECT_NE(publication_text(publication).find("DIFFERS: 0.814 ms of 0.755 ms +- 0.0005"), std::string::npos);
  EXPECT_NE(publication_text(publication).find("0 agrees, 1 DIFFERS, 0 own, 1 not checked"),
            std::string::npos);
}

}  // namespace
}  // namespace fieldproof::reports
