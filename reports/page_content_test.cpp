#include "reports/page_content.hpp"

#include <gtest/gtest.h>

#include <array>

#include "harness/kernel/error.hpp"
#include "reports/approved_text.hpp"
#include "reports/embedded_schemas.hpp"
#include "reports/sample_page.hpp"

namespace fieldproof::reports {
namespace {

namespace fs = std::filesystem;

RunDirectory stored_run(const fs::path& path) {
  const RunDirectory directory = RunDirectory::create_at(path, sample_manifest(), sample_run().identity);
  directory.store(sample_manifest(), sample_run());
  return directory;
}

constexpr const char* kFailed = "interbus/slave/data_cycle/outputs_are_kept";

TEST(PageContent, ReadsARunWithItsTimeLinesAndFiles) {
  const TemporaryFolder folder;
  const RunDirectory directory = stored_run(folder.path() / "run");
  directory.write_case(kFailed, "trace.txt", "");
  directory.write_case(kFailed, "case.json", "{}");
  directory.write_case(kFailed, "timeline.json", sample_timeline(kFailed));
  const PageRun run = page_run(directory);
  EXPECT_EQ(run.name, "run");
  EXPECT_EQ(run.stored.run.cases.size(), sample_run().cases.size());
  ASSERT_EQ(run.timelines.size(), 1U);
  EXPECT_EQ(run.timelines.at(kFailed), sample_timeline(kFailed));
  EXPECT_EQ(run.files.at(kFailed), (std::vector<std::string>{"case.json", "timeline.json", "trace.txt"}));
}

// The page of a run is the same, whichever way leads to it.
TEST(PageContent, ThePathLeavesNoTrace) {
  const TemporaryFolder folder;
  stored_run(folder.path() / "run");
  fs::create_directory_symlink("run", folder.path() / "latest");
  const auto page_at = [](const fs::path& path) {
    PageContent content;
    content.runs = {page_run(RunDirectory::open(path))};
    return html_page(content);
  };
  const std::string page = page_at(folder.path() / "run");
  EXPECT_EQ(page_at(folder.path() / "latest"), page);
  EXPECT_EQ(page_at(folder.path()), page);
  EXPECT_EQ(page_at(fs::relative(folder.path() / "run")), page);
}

TEST(PageContent, RefusesATimeLineThatIsNone) {
  const TemporaryFolder folder;
  const RunDirectory directory = stored_run(folder.path() / "run");
  for (const char* text : {"", "{}", "[]", R"({"schema": "fieldproof/timeline/2"})"}) {
    directory.write_case(kFailed, "timeline.json", text);
    EXPECT_NE(refusal_of([&] { page_run(directory); }).find("timeline.json"), std::string::npos) << text;
  }
}

TEST(PageContent, KnowsADocumentByItsSchema) {
  const TemporaryFolder folder;
  const std::array kinds = {DocumentKind{"fieldproof/emc/1", emc_schema}};
  const fs::path file = folder.path() / "emc.json";
  write_text_file(file, sample_emc().dump());
  EXPECT_EQ(page_document(file, kinds).name, "emc.json");
  const auto refusal = [&](const std::string& text) {
    write_text_file(file, text);
    return refusal_of([&] { page_document(file, kinds); });
  };
  EXPECT_NE(refusal(sample_matrix().dump()).find("fieldproof/matrix/1"), std::string::npos);
  EXPECT_NE(refusal("{}").find("schema"), std::string::npos);
  EXPECT_NE(refusal("[]").find("emc.json:1"), std::string::npos);
  EXPECT_NE(refusal("no JSON").find("emc.json:1"), std::string::npos);
  auto part = sample_emc();
  part["tests"][3].erase("ledger");
  EXPECT_NE(refusal(part.dump()).find("/tests/3"), std::string::npos);
  EXPECT_NE(refusal_of([&] { page_document(folder.path() / "none.json", kinds); }).find("none.json"),
            std::string::npos);
}

}  // namespace
}  // namespace fieldproof::reports
