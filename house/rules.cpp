#include "house/rules.hpp"

#include <algorithm>
#include <array>
#include <regex>
#include <set>

namespace fieldproof::house {
namespace {

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    if (c == '_' || c == '-' || c == '/' || c == '.') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

bool contains(const std::vector<File>& files, const std::string& path) {
  return std::any_of(files.begin(), files.end(), [&](const File& file) { return file.path == path; });
}

// Headers that the build writes: one per folder with a JSON Schema, one for the page of the reports.
bool is_generated(const std::vector<File>& files, const std::string& target) {
  if (target == "reports/embedded_page.hpp") return contains(files, "reports/page/page.js");
  if (!target.ends_with("/embedded_schemas.hpp")) return false;
  const std::string folder = folder_of(target) + "/";
  return std::any_of(files.begin(), files.end(), [&](const File& file) {
    return file.path.starts_with(folder) && file.path.ends_with(".schema.json");
  });
}

bool is_test(const File& file) {
  return file.path.ends_with("_test.cpp");
}

struct ForbiddenWord {
  std::regex pattern;
  std::string sentence;
};

// The first letters stand in brackets, so that this file may be searched for the words too.
const std::vector<ForbiddenWord>& forbidden_words() {
  static const std::vector<ForbiddenWord> words{
      {std::regex(R"(\b([T]ODO|[F]IXME|[X]XX|[H]ACK)\b)"), "finish the work, or tell it under Known limits."},
      {std::regex(R"(\b([f]or now|[p]laceholder|[s]implified|[n]ot implemented)\b)"),
       "say what it is and what not."},
      {std::regex(R"((^|[^a-z0-9_.])/(work|home|root|tmp)/)"),
       "a path of one machine means nothing elsewhere."},
      {std::regex(R"([r]egistry\.npmjs|[d]eb\.debian\.org|"[r]esolved":)"),
       "where packages come from is the machine's choice."},
      {std::regex(R"(\b[Ii]ssue #?[0-9])"), "a reader of the code does not know the number."},
  };
  return words;
}

void check_words(const File& file, int number, const std::string& line, Complaints& complaints) {
  for (const ForbiddenWord& word : forbidden_words()) {
    std::smatch match;
    if (std::regex_search(line, match, word.pattern)) {
      complaints.push_back({file.path, number, "\"" + match.str() + "\": " + word.sentence});
    }
  }
}

}  // namespace

Complaints check_include_paths(const std::vector<File>& files) {
  static const std::regex own(R"((harness|protocols|conformance|emc|fuzz|reports|cli|bench|house)/.*)");
  Complaints complaints;
  for (const File& file : files) {
    if (!is_source(file)) continue;
    for (const Include& include : includes_of(file)) {
      if (include.is_quoted && !contains(files, include.target) && !is_generated(files, include.target)) {
        complaints.push_back(
            {file.path, include.line,
             "\"" + include.target + "\" is no path from the root of the project; write one."});
      }
      if (!include.is_quoted && std::regex_match(include.target, own)) {
        complaints.push_back(
            {file.path, include.line, "<" + include.target + "> is our own header; write it in quotes."});
      }
    }
  }
  return complaints;
}

Complaints check_headers_open_once(const std::vector<File>& files) {
  Complaints complaints;
  for (const File& file : files) {
    if (!is_header(file)) continue;
    const std::string code = code_of(file.text);
    const std::size_t first = code.find_first_not_of(" \n");
    if (first == std::string::npos || code.compare(first, 12, "#pragma once") != 0) {
      complaints.push_back({file.path, 0, "the first line of code of a header is \"#pragma once\"."});
    }
  }
  return complaints;
}

Complaints check_names(const std::vector<File>& files) {
  static const std::set<std::string, std::less<>> banned{"util",    "utils",  "utility", "common", "misc",
                                                         "helpers", "helper", "base",    "manager"};
  static const std::regex snake(R"([a-z0-9_]+)");
  Complaints complaints;
  for (const File& file : files) {
    for (const std::string& word : words_of(file.path)) {
      if (banned.contains(word)) {
        complaints.push_back({file.path, 0, "\"" + word + "\" names nothing; name the noun."});
      }
    }
    if (is_source(file) && !std::regex_match(stem_of(file.path), snake)) {
      complaints.push_back({file.path, 0, "a source file is called in snake_case."});
    }
  }
  return complaints;
}

Complaints check_umbrella_headers(const std::vector<File>& files) {
  Complaints complaints;
  for (const File& file : files) {
    if (!is_header(file)) continue;
    const std::vector<std::string> lines = lines_of(code_of(file.text));
    const bool declares = std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
      const std::size_t first = line.find_first_not_of(' ');
      if (first == std::string::npos) return false;
      return line[first] != '#' || line.compare(first, 7, "#define") == 0;
    });
    if (!declares) {
      complaints.push_back({file.path, 0, "it declares nothing; include what is used where it is used."});
    }
  }
  return complaints;
}

// A folder of suites, conformance/P, may keep the mutants of its roles apart one level below
// fieldproof::conformance, and have emulated stations of the protocol in fieldproof::P.
bool is_suite_namespace(const std::string& folder, const std::string& name) {
  const std::string suites = "conformance/";
  if (!folder.starts_with(suites)) return false;
  const std::string below = "::conformance::";
  return name == "::" + folder.substr(suites.size()) ||
         (name.starts_with(below) && name.find("::", below.size()) == std::string::npos);
}

Complaints check_namespaces(const std::vector<File>& files) {
  static const std::regex pattern(R"(^\s*(inline\s+)?namespace\s+fieldproof((::\w+)*).*)");
  Complaints complaints;
  for (const File& file : files) {
    if (!is_source(file) || file.path.ends_with(".h")) continue;
    const std::string folder = folder_of(file.path);
    const std::size_t slash = folder.find('/');
    std::string expected = folder.substr(0, slash);
    if ((expected == "harness" || expected == "protocols") && slash != std::string::npos) {
      expected = folder.substr(slash + 1, folder.find('/', slash + 1) - slash - 1);
    }
    bool is_opened = false;
    int number = 0;
    for (const std::string& line : lines_of(code_of(file.text))) {
      ++number;
      std::smatch match;
      if (line.find("namespace") == std::string::npos || !std::regex_match(line, match, pattern)) continue;
      if (line.find('=') != std::string::npos) continue;  // an alias
      is_opened = true;
      if (match[2].str() != "::" + expected && !is_suite_namespace(folder, match[2].str())) {
        complaints.push_back(
            {file.path, number, "the namespace of this folder is fieldproof::" + expected + "."});
      }
    }
    if (is_header(file) && !is_opened) {
      complaints.push_back({file.path, 0, "it declares nothing in fieldproof::" + expected + "."});
    }
  }
  return complaints;
}

Complaints check_line_lengths(const std::vector<File>& files) {
  constexpr auto limit = 110;
  Complaints complaints;
  for (const File& file : files) {
    if (!is_source(file)) continue;
    int number = 0;
    bool is_table = false;  // one row per line, as the author laid it out
    for (const std::string& line : lines_of(file.text)) {
      ++number;
      if (line.find("// clang-format o") != std::string::npos) is_table = line.ends_with("off");
      if (is_table) continue;
      // UTF-8: every octet but the continuation ones begins a character.
      const auto columns = std::count_if(
          line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
      if (columns > limit) {
        complaints.push_back(
            {file.path, number, "the line has " + std::to_string(columns) + " columns; 110 fit."});
      }
    }
  }
  return complaints;
}

Complaints check_test_subjects(const std::vector<File>& files) {
  Complaints complaints;
  for (const File& file : files) {
    if (!is_test(file)) continue;
    const std::string subject = file.path.substr(0, file.path.size() - std::string_view("_test.cpp").size());
    const bool is_beside = contains(files, subject + ".hpp") || contains(files, subject + ".cpp");
    if (!is_beside && !file.text.starts_with("// Subject: ")) {
      complaints.push_back(
          {file.path, 0,
           "there is no " + subject +
               ".hpp or .cpp; a test of more than one file opens with \"// Subject: ...\"."});
    }
  }
  return complaints;
}

Complaints check_readme_headings(const std::vector<File>& files) {
  static constexpr std::array headings{"What it is",        "What it is not",    "How it works",
                                       "Rules and sources", "How it is checked", "Known limits"};
  Complaints complaints;
  for (const File& file : files) {
    if (!file.path.ends_with("/README.md")) continue;
    std::size_t from = 0;
    for (const char* heading : headings) {
      const std::string line = "\n## " + std::string(heading) + "\n";
      const std::size_t at = file.text.find(line, from);
      if (at == std::string::npos) {
        complaints.push_back(
            {file.path, 0, "the heading \"## " + std::string(heading) + "\" is missing or out of order."});
      } else {
        from = at + 1;
      }
    }
  }
  return complaints;
}

Complaints check_forbidden_words(const std::vector<File>& files) {
  Complaints complaints;
  for (const File& file : files) {
    int number = 0;
    for (const std::string& line : lines_of(file.text)) check_words(file, ++number, line, complaints);
  }
  return complaints;
}

std::string to_text(const Complaints& complaints) {
  std::string text;
  for (const Complaint& complaint : complaints) {
    text += complaint.path + ":" + std::to_string(complaint.line) + ": " + complaint.sentence + "\n";
  }
  return text;
}

}  // namespace fieldproof::house
