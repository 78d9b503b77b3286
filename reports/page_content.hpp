// What a page shows, read from where it is stored: runs with the time lines of their cases, and the documents
// of other verbs.
//
// Contract: equal stored files give equal contents, whichever path leads to them. Everything is read through
// the bounded readers and held to its schema; what is no such file, or of a newer schema, is a
// kernel::Error(configuration) with file, line and pointer.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reports/run_directory.hpp"

namespace fieldproof::reports {
struct History;
}  // namespace fieldproof::reports

namespace fieldproof::reports {

// What the catalogue of the program says of a case; a stored result does not repeat it.
struct CaseStory {
  std::string stimulus;
  std::string expected;
  std::vector<std::string> steps;    // of a case that is a sequence
  std::vector<std::string> catches;  // mutants, with the finding that shows each

  friend bool operator==(const CaseStory&, const CaseStory&) = default;
};

struct PageCatalogue {
  std::string suite_version;  // stories are shown beside results of this suite only
  std::map<std::string, CaseStory> stories;
};

struct PageRun {
  std::string name;  // of the directory
  StoredRun stored;
  std::map<std::string, std::string> timelines;           // JSON by case id
  std::map<std::string, std::vector<std::string>> files;  // stored beside the case, in alphabetical order
};

PageRun page_run(const RunDirectory& directory);

struct PageDocument {
  std::string name;  // of the file
  std::string json;
};

// The schemas by which documents are known: "fieldproof/emc/1" and its JSON Schema.
struct DocumentKind {
  std::string_view schema_id;
  std::string_view schema;
};

PageDocument page_document(const std::filesystem::path& file, std::span<const DocumentKind> kinds);

// What a page that is handed over says of the occasion; all empty: it has no cover.
struct PageCover {
  std::string title;
  std::string device;
  std::string customer;
  std::string note;

  friend bool operator==(const PageCover&, const PageCover&) = default;
};

struct PageContent {
  PageCatalogue catalogue;
  std::vector<PageRun> runs;
  std::vector<PageDocument> documents;
  bool is_comparison = false;              // of the first of its two runs with the second
  std::shared_ptr<const History> history;  // none: it shows none
  PageCover cover;
};

}  // namespace fieldproof::reports
