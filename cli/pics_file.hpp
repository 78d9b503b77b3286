// What an implementation declares about itself, as a file: {"items": {"inputs": true, "words": 2}}.
//
// The items are those that the suites publish (`fieldproof list pics`); an unknown name and an answer of
// another kind are refused with line, pointer and the nearest name. What is not answered is as the suite
// says.
#pragma once

#include <filesystem>

#include <span>
#include <string>

#include "harness/config/document.hpp"
#include "harness/judge/pics.hpp"

namespace fieldproof::cli {

// Throws kernel::Error(configuration) with line and pointer.
judge::Pics load_pics(const std::filesystem::path& file, std::span<const judge::PicsItem> known);

// An object of item names and answers.
judge::Pics pics_from(const config::Value& items, std::span<const judge::PicsItem> known);

// The file that gives these answers again; equal answers give equal text.
std::string pics_text(const judge::Pics& pics);

}  // namespace fieldproof::cli
