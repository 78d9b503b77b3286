#include "house/source_tree.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace fieldproof::house {
namespace {

// The own project is a tree of its own: what holds there is asked about it alone.
bool is_left_out(const std::string& path) {
  static constexpr std::array folders{".git",        "build",  "runs",
                                      "fuzz/corpus", ".cache", "examples/own_project"};
  const bool is_listed = std::any_of(folders.begin(), folders.end(), [&](const char* folder) {
    return path == folder || path.starts_with(std::string(folder) + "/");
  });
  return is_listed || path.ends_with("node_modules");
}

bool is_text(const std::string& path) {
  static const std::regex endings(R"(.*\.(cpp|hpp|h|md|txt|cmake|json|tsv|dict|js|mjs|sh|xsd))");
  static const std::regex names(R"((script|\.ci)/[a-z_]+|\.clang-[a-z]+|\.gitignore)");
  return std::regex_match(path, endings) || std::regex_match(path, names);
}

std::string read(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// Blanks [begin, end) except line breaks.
void blank(std::string& text, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < std::min(end, text.size()); ++i) {
    if (text[i] != '\n') text[i] = ' ';
  }
}

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::size_t end_of_literal(const std::string& text, std::size_t quote) {
  std::size_t i = quote + 1;
  while (i < text.size() && text[i] != text[quote] && text[i] != '\n') i += text[i] == '\\' ? 2U : 1U;
  return i;
}

std::size_t end_of_raw_string(const std::string& text, std::size_t quote) {
  const std::size_t open = text.find('(', quote);
  if (open == std::string::npos) return text.size();
  const std::string close = ")" + text.substr(quote + 1, open - quote - 1) + "\"";
  const std::size_t end = text.find(close, open);
  return end == std::string::npos ? text.size() : end + close.size() - 1;
}

// Where the comment or literal that begins at `i` ends; `i` itself when none begins there.
std::size_t end_of_non_code(const std::string& text, std::size_t i) {
  if (text.compare(i, 2, "//") == 0) return std::min(text.find('\n', i), text.size());
  if (text.compare(i, 2, "/*") == 0) {
    const std::size_t end = text.find("*/", i + 2);
    return end == std::string::npos ? text.size() : end + 2;
  }
  if (text[i] == '"') {
    const bool is_raw = i > 0 && text[i - 1] == 'R';
    return (is_raw ? end_of_raw_string(text, i) : end_of_literal(text, i)) + 1;
  }
  // Between two digits it separates thousands.
  if (text[i] == '\'' && (i == 0 || !is_word(text[i - 1]))) return end_of_literal(text, i) + 1;
  return i;
}

}  // namespace

std::vector<File> read_tree(const std::string& root) {
  std::vector<File> files;
  const std::filesystem::path start(root);
  for (auto entry = std::filesystem::recursive_directory_iterator(start);
       entry != std::filesystem::recursive_directory_iterator(); ++entry) {
    const std::string path = entry->path().lexically_relative(start).generic_string();
    if (entry->is_directory()) {
      if (is_left_out(path)) entry.disable_recursion_pending();
    } else if (is_text(path)) {
      files.push_back({path, read(entry->path())});
    }
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.path < b.path; });
  return files;
}

std::vector<Include> includes_of(const File& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]*)[>"].*)");
  std::vector<Include> includes;
  int number = 0;
  for (const std::string& line : lines_of(file.text)) {
    ++number;
    std::smatch match;
    if (line.find("include") != std::string::npos && std::regex_match(line, match, pattern)) {
      includes.push_back({match[2].str(), number, match[1].str() == "\""});
    }
  }
  return includes;
}

std::string code_of(std::string_view text) {
  std::string code(text);
  for (std::size_t i = 0; i < code.size();) {
    const std::size_t end = end_of_non_code(code, i);
    blank(code, i, end);
    i = std::max(end, i + 1);
  }
  return code;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

bool is_header(const File& file) {
  return file.path.ends_with(".hpp");
}

bool is_source(const File& file) {
  return is_header(file) || file.path.ends_with(".cpp") || file.path.ends_with(".h");
}

std::string folder_of(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string() : std::string(path.substr(0, slash));
}

std::string stem_of(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  const std::string_view name = slash == std::string_view::npos ? path : path.substr(slash + 1);
  return std::string(name.substr(0, name.find('.', 1)));
}

}  // namespace fieldproof::house
