#include <filesystem>

#include "cli/copies.hpp"
#include "cli/exit_code.hpp"
#include "cli/page_catalogue.hpp"
#include "cli/shards.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"
#include "reports/html_writer.hpp"
#include "reports/text_summary.hpp"

// `fieldproof report`: stored runs and documents as one page, and a stored run in the other formats.
namespace fieldproof::cli {
namespace {

// The parts of a run that was cut stand on it one after another.
void write_page_of(const Session& session, const std::string& file) {
  reports::PageContent content;
  content.catalogue = page_catalogue(session.catalogue);
  for (const std::string& operand : session.operands) {
    if (std::filesystem::is_directory(operand)) {
      content.runs.push_back(reports::page_run(reports::RunDirectory::open(operand)));
    } else {
      content.documents.push_back(reports::page_document(operand, document_kinds()));
    }
  }
  reports::write_text_file(file, reports::html_page(content));
  session.terminal.print("the report is in " + reports::escaped_line(file) + "\n");
}

}  // namespace

int report(Session& session) {
  const bool has_page = session.settings.is_set("html");
  if (!has_page && !asks_for_copies(session.settings)) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        "report needs the file to write: --html, --json, --junit, --sarif or --ctrf, or --github; "
        "write for example --html report.html");
  }
  check_copies(session.settings);
  if (has_page) write_page_of(session, session.settings.text("html"));
  if (!asks_for_copies(session.settings)) return kAllAsExpected;
  std::vector<std::string> directories;
  for (const std::string& operand : session.operands) {
    // A document goes to the page only; what is nothing at all is refused.
    if (has_page && std::filesystem::is_regular_file(operand)) continue;
    directories.push_back(operand);
  }
  if (directories.empty()) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        "--json, --junit, --sarif, --ctrf and --github are of a run; name its directory");
  }
  const JoinedRun run = joined(session, directories);
  write_copies(session, run.run, run.rules);
  return kAllAsExpected;
}

}  // namespace fieldproof::cli
