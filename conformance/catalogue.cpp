#include "conformance/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "conformance/selector.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kNeighbours = 3;

// "; the nearest are 'a', 'b'" or nothing when there is nothing to name.
std::string neighbours(std::string_view word, const std::vector<std::string>& candidates) {
  const auto near = config::nearest(word, std::span<const std::string>(candidates), kNeighbours);
  if (near.empty()) return {};
  return fmt::format("; the nearest are '{}'", fmt::join(near, "', '"));
}

[[noreturn]] void refuse(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage, sentence);
}

// Ids and, for a person who names a folder or forgets the glob, the folders as globs.
std::vector<std::string> path_candidates(const std::vector<Entry>& entries, std::string_view text) {
  std::vector<std::string> candidates;
  std::set<std::string> folders;
  for (const Entry& entry : entries) {
    const std::string& id = entry.test_case->id;
    candidates.push_back(id);
    for (std::size_t at = id.find('/'); at != std::string::npos; at = id.find('/', at + 1)) {
      folders.insert(id.substr(0, at) + "/**");
    }
  }
  const bool is_short = std::count(text.begin(), text.end(), '/') < 3;
  if (is_short) candidates.insert(candidates.end(), folders.begin(), folders.end());
  return candidates;
}

std::vector<std::string> tag_candidates(const std::vector<Entry>& entries) {
  std::set<std::string> tags;
  for (const Entry& entry : entries) tags.insert(entry.test_case->tags.begin(), entry.test_case->tags.end());
  return {tags.begin(), tags.end()};
}

[[noreturn]] void refuse_unmatched(const Selector& selector, const std::vector<Entry>& entries) {
  std::string near;
  if (selector.kind == Selector::Kind::tag) {
    std::vector<std::string> tags = tag_candidates(entries);
    for (std::string& tag : tags) tag.insert(0, "+");
    near = neighbours("+" + selector.text, tags);
  } else {
    near = neighbours(selector.text, path_candidates(entries, selector.text));
  }
  const std::string place = selector.place.empty() ? "" : selector.place + ": ";
  refuse(fmt::format("{}the selector '{}' matches no test case{}", place, selector.written(), near));
}

bool is_path_end(std::string_view path, std::string_view name) {
  return path == name ||
         (path.size() > name.size() && path.ends_with(name) && path[path.size() - name.size() - 1] == '/');
}

// The protocols and roles of the entries: which mutants a bare name can mean there.
std::set<std::pair<const Suite*, std::string>> roles_of(std::span<const Entry> entries) {
  std::set<std::pair<const Suite*, std::string>> roles;
  for (const Entry& entry : entries) {
    roles.insert({entry.suite, entry.test_case->role()});
    for (const std::string& part : entry.test_case->parts) roles.insert({entry.suite, part});
  }
  return roles;
}

}  // namespace

std::string MutantEntry::path() const {
  return fmt::format("{}/{}/{}", suite->protocol(), mutant->role, mutant->name);
}

Catalogue::Catalogue(std::vector<std::unique_ptr<Suite>> suites) : suites_(std::move(suites)) {
  for (const auto& suite : suites_) add(*suite);
  std::set<std::string> ids;
  for (const Entry& entry : entries_) {
    FIELDPROOF_CHECK(ids.insert(entry.test_case->id).second,
                     fmt::format("the case id '{}' is used twice", entry.test_case->id));
  }
}

void Catalogue::add(const Suite& suite) {
  std::set<std::string> paths;
  for (const Mutant& mutant : suite.mutants()) {
    mutants_.push_back({&suite, &mutant});
    const std::string path = mutants_.back().path();
    FIELDPROOF_CHECK(paths.insert(path).second, fmt::format("the mutant '{}' is declared twice", path));
  }
  for (const TestCase& test_case : suite.cases()) {
    check_case(suite, test_case);
    entries_.push_back({&suite, &test_case});
  }
}

void Catalogue::check_case(const Suite& suite, const TestCase& test_case) const {
  const std::vector<std::string> roles = suite.roles();
  const std::string role = test_case.role();
  FIELDPROOF_CHECK(
      test_case.id.starts_with(fmt::format("{}/{}/", suite.protocol(), role)) &&
          std::find(roles.begin(), roles.end(), role) != roles.end(),
      fmt::format("the case id '{}' does not begin with its protocol and one of its roles", test_case.id));
  for (const MustCatch& caught : test_case.catches) {
    const bool exists = std::any_of(
        suite.mutants().begin(), suite.mutants().end(),
        [&](const Mutant& mutant) { return mutant.role == role && mutant.name == caught.mutant; });
    FIELDPROOF_CHECK(exists, fmt::format("case '{}' declares to catch '{}', which is no mutant of a {}",
                                         test_case.id, caught.mutant, role));
  }
}

std::vector<Entry> Catalogue::select(std::span<const std::string> selectors) const {
  const std::vector<Selector> parsed = parse_selectors(selectors);
  const bool takes_all =
      std::all_of(parsed.begin(), parsed.end(), [](const Selector& s) { return s.is_exclusion; });
  std::vector<bool> included(entries_.size());
  std::vector<bool> excluded(entries_.size());
  for (std::size_t i = 0; i < entries_.size(); ++i)
    included[i] = takes_all && !is_canary(*entries_[i].test_case);
  for (const Selector& selector : parsed) {
    bool is_matched = false;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (!matches(selector, *entries_[i].test_case)) continue;
      is_matched = true;
      (selector.is_exclusion ? excluded : included)[i] = true;
    }
    if (!is_matched) refuse_unmatched(selector, entries_);
  }
  std::vector<Entry> selected;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (included[i] && !excluded[i]) selected.push_back(entries_[i]);
  }
  return selected;
}

std::vector<judge::PicsItem> Catalogue::pics_items() const {
  std::vector<judge::PicsItem> items;
  for (const auto& suite : suites_) {
    for (judge::PicsItem& item : suite->pics_items()) {
      const auto known = std::find_if(items.begin(), items.end(),
                                      [&](const judge::PicsItem& other) { return other.name == item.name; });
      if (known == items.end()) {
        items.push_back(std::move(item));
      } else {
        FIELDPROOF_CHECK(known->kind == item.kind,
                         fmt::format("two suites differ about the PICS item '{}'", item.name));
      }
    }
  }
  return items;
}

const Entry& Catalogue::at(std::string_view id) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.test_case->id == id; });
  if (found != entries_.end()) return *found;
  std::vector<std::string> ids;
  for (const Entry& entry : entries_) ids.push_back(entry.test_case->id);
  refuse(fmt::format("there is no test case '{}'{}", id, neighbours(id, ids)));
}

const Suite& Catalogue::suite(std::string_view protocol) const {
  std::vector<std::string> protocols;
  for (const auto& suite : suites_) {
    if (suite->protocol() == protocol) return *suite;
    protocols.emplace_back(suite->protocol());
  }
  refuse(fmt::format("there are no cases of a protocol '{}'; there are those of '{}'", protocol,
                     fmt::join(protocols, "', '")));
}

const MutantEntry& Catalogue::mutant(std::string_view name, std::span<const Entry> among) const {
  const auto roles = roles_of(among);
  std::vector<const MutantEntry*> found;
  std::vector<std::string> candidates;
  for (const MutantEntry& entry : mutants_) {
    if (!among.empty() && !roles.contains({entry.suite, entry.mutant->role})) continue;
    const std::string path = entry.path();
    if (is_path_end(path, name)) found.push_back(&entry);
    candidates.push_back(name.find('/') == std::string_view::npos ? entry.mutant->name : path);
  }
  if (found.size() == 1) return *found.front();
  if (found.empty()) refuse(fmt::format("there is no mutant '{}'{}", name, neighbours(name, candidates)));
  std::vector<std::string> paths;
  for (const MutantEntry* entry : found) paths.push_back(entry->path());
  refuse(
      fmt::format("the mutant '{}' is not unique; say which role is meant, as in --iut '{}=mutant:{}'; "
                  "it is one of '{}'",
                  name, found.front()->mutant->role, name, fmt::join(paths, "', '")));
}

}  // namespace fieldproof::conformance
