#include "reports/page_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "harness/config/document.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/embedded_schemas.hpp"
#include "reports/schema_check.hpp"

namespace fieldproof::reports {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTimeline = "timeline.json";
constexpr const char* kCampaign = "campaign.json";

std::string timeline_from(const fs::path& file) {
  const config::Document document = config::Document::load(file);
  check_against_schema(document.root(), timeline_schema);
  return document.text();
}

std::vector<std::string> file_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
    names.push_back(at->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

std::string name_of(const fs::path& path) {
  std::error_code failure;
  const fs::path whole = fs::weakly_canonical(path, failure);
  return (failure ? path : whole).filename().string();
}

}  // namespace

PageRun page_run(const RunDirectory& directory) {
  PageRun run;
  run.name = name_of(directory.path());
  run.stored = directory.load();
  for (const judge::CaseResult& result : run.stored.run.cases) {
    std::vector<std::string> files = file_names(directory.case_directory(result.id));
    if (files.empty()) continue;
    if (std::ranges::find(files, kTimeline) != files.end()) {
      run.timelines.emplace(result.id, timeline_from(directory.case_directory(result.id) / kTimeline));
    }
    run.files.emplace(result.id, std::move(files));
  }
  return run;
}

PageDocument page_document(const fs::path& file, std::span<const DocumentKind> kinds) {
  const config::Document document = config::Document::load(file);
  const std::string id = config::read_open_object(document.root(), [](config::ObjectReader& object) {
    return std::string(object.required("schema").as_string());
  });
  const auto kind = std::ranges::find(kinds, id, &DocumentKind::schema_id);
  if (kind == kinds.end()) {
    std::string known;
    for (const DocumentKind& one : kinds)
      known += fmt::format("{}{}", known.empty() ? "" : ", ", one.schema_id);
    config::fail(document.root(),
                 fmt::format("a report shows directories of runs and documents of {}, not of \"{}\"", known,
                             kernel::escaped_line(id)));
  }
  check_against_schema(document.root(), kind->schema);
  // All campaigns call it the same; the folder tells which.
  const std::string name = file.filename().string();
  return {name == kCampaign ? fmt::format("{}/{}", name_of(fs::absolute(file).parent_path()), name) : name,
          document.text()};
}

}  // namespace fieldproof::reports
