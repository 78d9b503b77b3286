#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "house/rules.hpp"

namespace fieldproof::house {
namespace {

// A name that a line declares, within its namespace.
struct Declaration {
  std::string name_space;
  std::string name;
  int line;
  bool is_unnamed;  // in an unnamed namespace
};

// The name that a line of a namespace declares, or nothing. It knows types, aliases, functions and constants
// by their first line.
std::string declared_name(const std::string& line) {
  static const std::regex not_ours(
      R"(^(TEST|RC_|INSTANTIATE|FIELDPROOF_|BENCHMARK|return\b|using (namespace|enum)\b).*)");
  static const std::regex type(
      R"(^(?:(?:struct|class|union|enum class|enum struct|enum|concept) (?:alignas\([^)]*\) )?(\w+).*)"
      R"(|using (\w+) =.*))");
  static const std::regex value(R"(^(?:[\w:]+(?:<.*>)?[&*]* )+[&*]*(\w+)(?:\(.*| =.*|\{.*|\[.*|;)$)");
  static const std::regex in_front(R"(^(?:\[\[[^\]]*\]\] ?|template <.*> ?|extern "[^"]*" )*)");
  const std::string declaration = std::regex_replace(line, in_front, "");
  if (declaration.empty() || std::isalpha(static_cast<unsigned char>(declaration.front())) == 0) return {};
  std::smatch match;
  if (std::regex_match(declaration, not_ours)) return {};
  if (std::regex_match(declaration, match, type)) return match[1].matched ? match[1].str() : match[2].str();
  return std::regex_match(declaration, match, value) ? match[1].str() : std::string();
}

// Which namespaces are open where a file is read line by line.
class OpenNamespaces {
 public:
  // True when the line opens one; else the line stands in those that are open.
  bool opens(const std::string& line) {
    static const std::regex opening(R"(^(?:inline )?namespace (?:([\w:]+) )?\{.*)");
    std::smatch match;
    if (!std::regex_match(line, match, opening)) return false;
    open_.push_back({match[1].str(), depth_});
    return true;
  }
  void pass(const std::string& line) {
    depth_ += std::count(line.begin(), line.end(), '{') - std::count(line.begin(), line.end(), '}');
    while (!open_.empty() && depth_ <= open_.back().depth) open_.pop_back();
  }

  // Not in a type or function that one of them contains.
  bool are_innermost() const { return depth_ == static_cast<std::ptrdiff_t>(open_.size()); }
  bool is_unnamed() const {
    return std::any_of(open_.begin(), open_.end(), [](const Open& one) { return one.name.empty(); });
  }
  std::string name() const {
    std::string name;
    for (const Open& one : open_) name += one.name.empty() ? "" : "::" + one.name;
    return name;
  }

 private:
  struct Open {
    std::string name;  // empty: it has none
    std::ptrdiff_t depth;
  };
  std::vector<Open> open_;
  std::ptrdiff_t depth_ = 0;
};

std::vector<Declaration> declarations_of(const File& file) {
  std::vector<Declaration> declarations;
  OpenNamespaces namespaces;
  int number = 0;
  for (const std::string& line : lines_of(code_of(file.text))) {
    ++number;
    if (!namespaces.opens(line) && namespaces.are_innermost()) {
      std::string name = declared_name(line);
      if (!name.empty())
        declarations.push_back({namespaces.name(), std::move(name), number, namespaces.is_unnamed()});
    }
    namespaces.pass(line);
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
