#include "harness/judge/journal.hpp"

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "harness/config/document.hpp"
#include "harness/judge/result_json.hpp"

namespace fieldproof::judge {
namespace {

namespace fs = std::filesystem;

CaseResult result_in(std::string_view text, const std::string& place) {
  const config::Document document = config::Document::parse(std::string(text), place);
  return case_result_from(document.root());
}

// Keeps one result per case: the last one, at the place of the first.
class LatestResults {
 public:
  explicit LatestResults(std::vector<CaseResult>& results) : results_(results) {}

  void add(CaseResult result) {
    const auto [place, is_new] = places_.try_emplace(result.id, results_.size());
    if (is_new) {
      results_.push_back(std::move(result));
    } else {
      results_.at(place->second) = std::move(result);
    }
  }

 private:
  std::vector<CaseResult>& results_;
  std::map<std::string, std::size_t> places_;
};

}  // namespace

// What is there is read once more by whoever takes it; here it must only be such results.
Journal::Journal(fs::path path, Durability durability)
    : lines_(std::move(path), durability,
             [](std::string_view text, const std::string& place) { result_in(text, place); }) {}

void Journal::append(const CaseResult& result) {
  lines_.append(to_json(result, WallTime::included).dump());
}

JournalContent read_journal(const fs::path& path) {
  JournalContent content;
  LatestResults latest(content.results);
  const LinesRead read = read_checked_lines(
      path, [&](std::string_view text, const std::string& place) { latest.add(result_in(text, place)); });
  content.is_torn = read.is_torn;
  content.intact_size = read.intact_size;
  return content;
}

}  // namespace fieldproof::judge
