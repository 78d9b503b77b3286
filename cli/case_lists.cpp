#include "cli/case_lists.hpp"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/exit_code.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

std::string need_id(const std::string& case_id, std::set<std::string>& used) {
  std::string id;
  for (const char c : case_id) {
    const auto octet = static_cast<unsigned char>(c);
    id += std::isalnum(octet) != 0 ? static_cast<char>(std::toupper(octet)) : '_';
  }
  const std::string first = id;
  for (int n = 2; !used.insert(id).second; ++n) id = fmt::format("{}_{}", first, n);
  return id;
}

ordered_json need_of(const conformance::TestCase& test_case, const std::string& id) {
  const judge::Reference reference = test_case.rests_on();
  std::string source = reference.source;
  if (!reference.clause.empty()) source += ", " + reference.clause;
  const std::string title =
      test_case.purpose.empty() ? test_case.id : fmt::format("{}: {}", test_case.purpose, test_case.id);
  return {{"id", id},
          {"type", "req"},
          {"title", kernel::escaped_line(title)},
          {"content", kernel::as_utf8(test_case.requirement)},
          {"description", kernel::as_utf8(test_case.requirement)},
          {"status", judge::is_verified(reference.standing) ? "verified" : "unverified"},
          {"tags", test_case.tags},
          {"links", ordered_json::array()},
          {"case", kernel::as_utf8(test_case.id)},
          {"source", kernel::as_utf8(source)}};
}

}  // namespace

std::string needs_json(std::span<const conformance::Entry> entries, const std::string& version) {
  ordered_json needs = ordered_json::object();
  std::set<std::string> used;
  for (const conformance::Entry& entry : entries) {
    const std::string id = need_id(entry.test_case->id, used);
    needs[id] = need_of(*entry.test_case, id);
  }
  ordered_json of_version = {{"needs_amount", needs.size()}, {"needs", std::move(needs)}};
  const ordered_json document = {{"project", "fieldproof"},
                                 {"current_version", version},
                                 {"versions", {{version, std::move(of_version)}}}};
  return document.dump(1) + "\n";
}

std::string cmake_quoted(const std::string& text) {
  std::string level;
  while (text.find("]" + level + "]") != std::string::npos || text.ends_with("]" + level)) level += '=';
  // A line feed that stands first would be dropped.
  const char* const first = text.starts_with('\n') ? "\n" : "";
  return fmt::format("[{}[{}{}]{}]", level, first, text, level);
}

std::string ctest_script(std::span<const conformance::Entry> entries, const std::string& program,
                         const std::vector<std::string>& options, const std::string& folder) {
  std::string script;
  std::string words;
  for (const std::string& option : options) words += " " + cmake_quoted(option);
  for (const conformance::Entry& entry : entries) {
    const std::string id = cmake_quoted(entry.test_case->id);
    script += fmt::format("add_test({} {} run {} --quiet{})\n", id, cmake_quoted(program), id, words);
    script += fmt::format("set_tests_properties({} PROPERTIES SKIP_RETURN_CODE {} WORKING_DIRECTORY {})\n",
                          id, kNothingJudged, cmake_quoted(folder));
  }
  return script;
}

}  // namespace fieldproof::cli
