// The files of the project as text, and the few things that every rule of the house asks of a file: its
// includes, its code without comments and literals. It knows no C++ grammar; it knows what a comment, a
// literal and a line are.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fieldproof::house {

struct File {
  std::string path;  // from the root of the project, with '/'
  std::string text;
};

struct Include {
  std::string target;
  int line;  // from 1
  bool is_quoted;
};

// All text files below the root in the order of their paths. Left out: what git, the builds, the runs and npm
// put there, and stored fuzz inputs, which are octets.
std::vector<File> read_tree(const std::string& root);

std::vector<Include> includes_of(const File& file);

// The text with comments and the content of string and character literals blanked; line breaks and columns
// stay.
std::string code_of(std::string_view text);

std::vector<std::string> lines_of(std::string_view text);

bool is_header(const File& file);
bool is_source(const File& file);  // .hpp, .cpp or .h

std::string folder_of(std::string_view path);  // "harness/line/crc.hpp" gives "harness/line"
std::string stem_of(std::string_view path);    // "harness/line/crc.hpp" gives "crc"

}  // namespace fieldproof::house
