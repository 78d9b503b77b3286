#include "cli/copies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/formats.hpp"
#include "reports/github_writer.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::cli {
namespace {

// Other steps of a job write to it, too.
void add_to(const char* file, const std::string& text) {
  std::ofstream stream(file, std::ios::app | std::ios::binary);
  stream << text << std::flush;
  if (stream) return;
  throw kernel::Error(
      kernel::ErrorKind::output,
      fmt::format("GITHUB_STEP_SUMMARY: nothing can be added to '{}'", kernel::escaped_line(file)));
}

}  // namespace

void check_copies(const Settings& settings) {
  std::map<std::string, std::string> options;  // by the file that they name
  const auto check = [&](const std::string& option) {
    if (!settings.is_set(option)) return;
    const std::string file = settings.text(option);
    reports::check_writable(file);
    const auto [other, is_first] = options.emplace(file, option);
    std::error_code failure;
    const std::filesystem::file_status found = std::filesystem::status(file, failure);
    // What is no file, as /dev/stdout, takes several one after the other.
    const bool is_stream = std::filesystem::exists(found) && !std::filesystem::is_regular_file(found);
    if (!is_first && !is_stream)
      throw kernel::Error(
          kernel::ErrorKind::usage,
          fmt::format("--{} and --{} name one file, {}; each needs its own", other->second, option, file));
  };
  for (const reports::Format& format : reports::formats()) check(std::string(format.name));
  check("html");
}

bool asks_for_copies(const Settings& settings) {
  if (settings.is_set("github")) return true;
  return std::ranges::any_of(reports::formats(),
                             [&](const reports::Format& format) { return settings.is_set(format.name); });
}

reports::OutcomeRules outcome_rules(const Settings& settings) {
  reports::OutcomeRules rules;
  rules.is_strict = settings.is_set("strict");
  if (settings.is_set("allow-inconclusive")) rules.inconclusive = reports::InconclusiveAs::skipped;
  if (rules.is_strict) rules.inconclusive = reports::InconclusiveAs::failure;
  return rules;
}

void write_copies(const Session& session, const reports::PageRun& run, const reports::OutcomeRules& rules) {
  for (const reports::Format& format : reports::formats()) {
    if (!session.settings.is_set(format.name)) continue;
    reports::write_files(session.settings.text(format.name), format.write(run, rules));
  }
  if (!session.settings.is_set("github")) return;
  session.terminal.print(reports::github_annotations(run.stored.run, rules));
  const char* const file = std::getenv("GITHUB_STEP_SUMMARY");
  if (file != nullptr && *file != '\0') add_to(file, reports::github_summary(run.stored.run, rules));
}

}  // namespace fieldproof::cli
