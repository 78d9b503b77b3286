// What an implementation declares about itself, as a file: {"items": {"safe_state": "zero", "bus_stop":
// true}}.
#pragma once

#include <filesystem>

#include "harness/config/document.hpp"
#include "harness/judge/pics.hpp"

namespace fieldproof::cli {

// Throws kernel::Error(configuration) with line and pointer.
judge::Pics load_pics(const std::filesystem::path& file);

// An object of item names and answers: true, false, a whole number or a text.
judge::Pics pics_from(const config::Value& items);

}  // namespace fieldproof::cli
