#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/copies.hpp"
#include "cli/exit_code.hpp"
#include "cli/page_catalogue.hpp"
#include "cli/shards.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"
#include "reports/history.hpp"
#include "reports/html_writer.hpp"
#include "reports/joined_verdict.hpp"
#include "reports/text_summary.hpp"

// `fieldproof report`: stored runs and documents as one page, and a stored run in the other formats.
namespace fieldproof::cli {
namespace {

bool is_directory(const std::string& operand) {
  return std::filesystem::is_directory(operand);
}

// The file to show, also of the folder of a campaign; empty: it is the directory of a run.
std::string document_of(const std::string& operand) {
  if (!is_directory(operand)) return operand;
  const std::filesystem::path campaign = std::filesystem::path(operand) / "campaign.json";
  return std::filesystem::is_regular_file(campaign) ? campaign.string() : "";
}

// The run of `--json`, `--junit` and the others: one, or joined from its parts.
JoinedRun one_run(const Session& session) {
  std::vector<std::string> directories;
  for (const std::string& operand : session.operands) {
    // A document goes to the page; what is nothing at all is refused.
    if (session.settings.is_set("html") && std::filesystem::exists(operand) && !document_of(operand).empty())
      continue;
    directories.push_back(operand);
  }
  if (directories.empty()) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        "--json, --junit, --sarif, --ctrf and --github are of a run; name its directory");
  }
  return joined(session, directories);
}

// With the one run that the other formats are of, or with each directory as a run of its own.
void write_page(const Session& session, const std::optional<JoinedRun>& only,
                std::shared_ptr<const reports::History> history) {
  const std::string page = session.settings.text("html");
  reports::PageContent content;
  content.catalogue = page_catalogue(session.catalogue());
  if (only) content.runs.push_back(only->run);
  for (const std::string& operand : session.operands) {
    if (const std::string file = document_of(operand); !file.empty()) {
      content.documents.push_back(reports::page_document(file, document_kinds()));
    } else if (!only) {
      content.runs.push_back(reports::page_run(reports::RunDirectory::open(operand)));
      say_that_it_is_a_part(operand, content.runs.back().stored.run.identity);
    }
  }
  content.history = std::move(history);
  content.is_comparison = session.settings.is_set("compare");
  if (content.is_comparison && content.runs.size() != 2) {
    session.settings.refuse("compare",
                            fmt::format("it is of two runs, and {} are named; write for example report "
                                        "runs/before runs/after --compare --html report.html",
                                        content.runs.size()));
  }
  content.cover = {session.settings.text("title"), session.settings.text("device"),
                   session.settings.text("customer"), session.settings.text("note")};
  reports::write_text_file(page, reports::html_page(content));
  session.terminal.print(reports::joined_text(reports::joined_verdict(content)));
  session.terminal.print("the report is in " + reports::escaped_line(page) + "\n");
}

std::shared_ptr<const reports::History> history_of(const Session& session) {
  if (!session.settings.is_set("history")) return nullptr;
  constexpr std::uint64_t kMostRuns = 10'000;
  return std::make_shared<reports::History>(reports::history_of(
      session.settings.text("history"),
      static_cast<std::size_t>(session.settings.number("last", 1, kMostRuns)), document_kinds()));
}

void check_operands(const Session& session) {
  if (session.settings.is_set("history")) return;
  if (session.operands.empty()) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        "report needs directories of runs or documents, or --history DIR; write for example "
                        "report runs/latest --html report.html");
  }
  if (session.settings.origin("last") == Origin::command_line)
    session.settings.refuse("last", "it is of --history DIR; leave it out");
}

}  // namespace

int report(Session& session) {
  check_operands(session);
  const bool has_page = session.settings.is_set("html");
  const bool has_copies = asks_for_copies(session.settings);
  const std::shared_ptr<const reports::History> history = history_of(session);
  if (history) session.terminal.print(reports::history_text(*history));
  if (!has_page && !has_copies && !history) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        "report needs the file to write: --html, --json, --junit, --sarif or --ctrf, or "
                        "--github; write for example --html report.html");
  }
  check_copies(session.settings);
  std::optional<JoinedRun> run;
  if (has_copies) run = one_run(session);
  if (session.settings.is_set("compare") && (!has_page || has_copies))
    session.settings.refuse("compare",
                            "it is of a page, with --html alone; 'fieldproof diff' prints the same as text");
  if (has_page) write_page(session, run, history);
  if (run) write_copies(session, run->run, run->rules);
  return kAllAsExpected;
}

}  // namespace fieldproof::cli
