// The rules of the house, each a function from the files to its complaints. They hold what a compiler cannot
// see: who may include whom, what a file is called, which sources of chance and time may not occur where
// simulated time runs, what a README answers.
#pragma once

#include <string>
#include <vector>

#include "house/source_tree.hpp"

namespace fieldproof::house {

struct Complaint {
  std::string path;
  int line;  // from 1; 0 when the file as a whole is meant
  std::string sentence;
};

using Complaints = std::vector<Complaint>;

Complaints check_include_directions(const std::vector<File>& files);
Complaints check_include_paths(const std::vector<File>& files);
Complaints check_headers_open_once(const std::vector<File>& files);
Complaints check_names(const std::vector<File>& files);
Complaints check_umbrella_headers(const std::vector<File>& files);
Complaints check_namespaces(const std::vector<File>& files);
// A name of an unnamed namespace that a header of the same namespace has, too: within a unit of several
// sources the others would get it instead of the header's, without a word of the compiler.
Complaints check_hidden_names(const std::vector<File>& files);
Complaints check_determinism(const std::vector<File>& files);
// An exception to check_determinism that nothing needs any more. It is about the whole tree, not a part of
// it.
Complaints check_determinism_exceptions(const std::vector<File>& files);
Complaints check_line_lengths(const std::vector<File>& files);
Complaints check_test_subjects(const std::vector<File>& files);
Complaints check_readme_headings(const std::vector<File>& files);
Complaints check_forbidden_words(const std::vector<File>& files);

// "path:line: sentence", one per line.
std::string to_text(const Complaints& complaints);

}  // namespace fieldproof::house
