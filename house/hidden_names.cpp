#include <cctype>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "house/rules.hpp"

namespace fieldproof::house {
namespace {

// A name that a line at the left margin declares, within its namespace.
struct Declaration {
  std::string name_space;
  std::string name;
  int line;
  bool is_unnamed;  // in an unnamed namespace
};

// The name that the line declares, or nothing. It knows types, aliases, functions and constants.
std::string declared_name(const std::string& line) {
  static const std::regex not_ours(
      R"(^(TEST|RC_|INSTANTIATE|FIELDPROOF_|BENCHMARK|return\b|using (namespace|enum)\b).*)");
  static const std::regex type(
      R"(^(?:template <.*> ?)?(?:struct|class|enum class|enum|concept) (\w+).*|^using (\w+) = .*)");
  static const std::regex value(
      R"(^(?:template <.*> ?)?(?:[\w:]+(?:<.*>)?[&*]* )+[&*]*(\w+)(?:\(.*| = .*|\{.*|\[.*|;)$)");
  if (line.empty() || std::isalpha(static_cast<unsigned char>(line.front())) == 0) return {};
  std::smatch match;
  if (std::regex_match(line, not_ours)) return {};
  if (std::regex_match(line, match, type)) return match[1].matched ? match[1].str() : match[2].str();
  return std::regex_match(line, match, value) ? match[1].str() : std::string();
}

std::vector<Declaration> declarations_of(const File& file) {
  static const std::regex opening(R"(^namespace ([\w:]+) \{.*)");
  std::vector<Declaration> declarations;
  std::string name_space;
  bool is_unnamed = false;
  int number = 0;
  // The comment behind a brace tells which namespace ends; code_of would blank it.
  const std::vector<std::string> written = lines_of(file.text);
  for (const std::string& line : lines_of(code_of(file.text))) {
    const std::string& with_comments = written.at(static_cast<std::size_t>(number++));
    std::smatch match;
    if (std::regex_match(line, match, opening)) {
      name_space = match[1].str();
    } else if (line.starts_with("namespace {")) {
      is_unnamed = true;
    } else if (with_comments == "}  // namespace") {
      is_unnamed = false;
    } else if (std::string name = declared_name(line); !name.empty()) {
      declarations.push_back({name_space, std::move(name), number, is_unnamed});
    }
  }
  return declarations;
}

}  // namespace

Complaints check_hidden_names(const std::vector<File>& files) {
  std::map<std::pair<std::string, std::string>, std::string> of_headers;
  for (const File& file : files) {
    if (!is_header(file)) continue;
    for (const Declaration& one : declarations_of(file))
      of_headers.try_emplace({one.name_space, one.name}, file.path);
  }
  Complaints complaints;
  for (const File& file : files) {
    if (!is_source(file) || is_header(file)) continue;
    for (const Declaration& one : declarations_of(file)) {
      const auto hidden = one.is_unnamed ? of_headers.find({one.name_space, one.name}) : of_headers.end();
      if (hidden == of_headers.end()) continue;
      complaints.push_back({file.path, one.line,
                            "\"" + one.name + "\" hides the one of " + hidden->second +
                                " from every source that is compiled with this one; name it apart."});
    }
  }
  return complaints;
}

}  // namespace fieldproof::house
