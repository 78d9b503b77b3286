#include "harness/judge/input_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/judge/checked_lines.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::judge {

std::string hash_of(std::string_view content) {
  return fmt::format("{:016x}", check_of(content));
}

std::string hash_of_file(const std::string& path) {
  std::uint64_t check = kCheckOfNothing;
  config::read_blocks(path, [&](std::string_view block) { check = check_of(block, check); });
  return fmt::format("{:016x}", check);
}

nlohmann::ordered_json json_of(std::span<const InputFile> files) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const InputFile& file : files)
    list.push_back({{"path", kernel::as_utf8(file.path)}, {"hash", file.hash}});
  return list;
}

std::vector<InputFile> input_files_from(const config::Value& list) {
  std::vector<InputFile> files;
  for (const config::Value& one : list.as_array()) {
    files.push_back(config::read_open_object(one, [](config::ObjectReader& object) {
      return InputFile{std::string(object.required("path").as_string()),
                       std::string(object.required("hash").as_string())};
    }));
  }
  return files;
}

}  // namespace fieldproof::judge
