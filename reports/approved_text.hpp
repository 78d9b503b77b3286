// For tests: holds a text to the approved one in reports/approved/. With FIELDPROOF_APPROVE=1 in the
// environment the text at hand becomes the approved one; the change is then seen in review.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::reports {

// A schema that this folder ships.
inline std::filesystem::path schema_path(const std::string& name) {
  return std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "reports" / "schema" / (name + ".schema.json");
}

inline std::filesystem::path approved_path(const std::string& name) {
  return std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "reports" / "approved" / name;
}

inline void expect_approved(const std::string& name, const std::string& text) {
  if (std::getenv("FIELDPROOF_APPROVE") != nullptr) write_text_file(approved_path(name), text);
  EXPECT_EQ(text, read_text_file(approved_path(name))) << name;
}

// What a refusal of a stored file says, or with another exit code of a file that cannot be written.
template <typename Action>
std::string refusal_of(Action action, int exit_code = 65) {
  try {
    action();
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.exit_code(), exit_code);
    return error.what();
  }
  return "no error";
}

// A directory that is gone with its test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "fieldproof-reports-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace fieldproof::reports
