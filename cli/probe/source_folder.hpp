// For tests: where the examples, schemas and documents of this tree are.
#pragma once

#include <filesystem>

namespace fieldproof::cli {

inline const std::filesystem::path kSourceFolder = FIELDPROOF_SOURCE_DIR;

}  // namespace fieldproof::cli
