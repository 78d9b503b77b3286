#include "cli/input_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "cli/sequence_corpus.hpp"
#include "harness/iut/process.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

// Of an implementation: its program or library, and what stands on its command line.
std::vector<std::string> files_of_implementation(std::string_view uri) {
  constexpr std::string_view kProcess = "exec:";
  constexpr std::string_view kLibrary = "plugin:";
  if (const auto at = uri.find(kProcess); at != std::string_view::npos)
    return iut::words_of(std::string(uri.substr(at + kProcess.size())));
  if (const auto at = uri.find(kLibrary); at != std::string_view::npos) {
    const std::string_view path = uri.substr(at + kLibrary.size());
    return {std::string(path.substr(0, path.find('?')))};
  }
  return {};
}

// The file that a word of the command line would name.
std::optional<std::string> file_named_by(std::string_view word, const Option* option) {
  if (option != nullptr) {
    if (option->value_name.find("FILE") == std::string_view::npos) return std::nullopt;
    word.remove_prefix(option->name.size() + 3);  // "--", "="
  } else if (word.starts_with('@')) {
    word.remove_prefix(1);
  } else if (!word.ends_with(".json")) {
    return std::nullopt;
  }
  return std::string(word);
}

bool is_file(const std::string& path) {
  std::error_code failure;
  return std::filesystem::is_regular_file(path, failure);
}

std::string hash_or_nothing(const std::string& file) {
  try {
    return judge::hash_of_file(file);
  } catch (const kernel::Error&) {
    return {};
  }
}

}  // namespace

std::vector<std::string> input_files_of(std::string_view word, const Option* option) {
  std::vector<std::string> files;
  if (option != nullptr && option->name == "corpus") {
    const std::filesystem::path folder = word.substr(option->name.size() + 3);
    for (const auto& file : corpus_files(folder)) files.push_back(file.string());
  } else if (option != nullptr && option->name == "iut") {
    files = files_of_implementation(word);
  } else if (const auto file = file_named_by(word, option)) {
    files.push_back(*file);
  }
  std::erase_if(files, [](const std::string& file) { return !is_file(file); });
  return files;
}

std::vector<judge::InputFile> input_files_of(const Session& session) {
  std::vector<judge::InputFile> inputs;
  const auto note = [&](std::string_view word, const Option* option) {
    for (std::string& file : input_files_of(word, option)) {
      if (std::ranges::find(inputs, file, &judge::InputFile::path) != inputs.end()) continue;
      std::string hash = hash_or_nothing(file);
      inputs.push_back({std::move(file), std::move(hash)});
    }
  };
  for (const std::string& operand : session.operands) note(operand, nullptr);
  for (const auto& [option, values] : session.settings.deciding()) {
    for (const std::string& value : *values) note(fmt::format("--{}={}", option->name, value), option);
  }
  return inputs;
}

}  // namespace fieldproof::cli
