#include <filesystem>

#include "cli/exit_code.hpp"
#include "cli/page_catalogue.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"
#include "reports/html_writer.hpp"
#include "reports/text_summary.hpp"

// `fieldproof report`: stored runs and documents as one page.
namespace fieldproof::cli {

int report(Session& session) {
  if (!session.settings.is_set("html")) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        "report needs --html, the file to write; write for example --html report.html");
  }
  const std::string file = session.settings.text("html");
  reports::check_writable(file);
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
  return kAllAsExpected;
}

}  // namespace fieldproof::cli
