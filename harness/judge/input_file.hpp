// A file that decides an outcome, and what is in it: whoever reads the outcome later can tell whether theirs
// is the same.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/config/document.hpp"

namespace fieldproof::judge {

struct InputFile {
  std::string path;
  std::string hash;  // of its content; empty: it could not be read

  friend bool operator==(const InputFile&, const InputFile&) = default;
};

// 16 hexadecimal digits over a content.
std::string hash_of(std::string_view content);
// Of a file of any size. Throws kernel::Error(configuration) for one that cannot be read.
std::string hash_of_file(const std::string& path);

// [{"path": "node.json", "hash": "77148d8a4f1248d3"}], and read again.
nlohmann::ordered_json json_of(std::span<const InputFile> files);
std::vector<InputFile> input_files_from(const config::Value& list);

}  // namespace fieldproof::judge
