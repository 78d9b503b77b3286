#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

// The program or shared library that an address lies in, and how it is kept where it is.
namespace fieldproof::fuzz {

struct LoadedImage {
  std::string path;  // as the dynamic linker has it
  std::uintptr_t base = 0;
  std::uintptr_t begin = 0;  // of the part of it that is loaded
  std::uintptr_t end = 0;
  bool is_program = false;  // this program itself, which is never unloaded

  bool holds(std::uintptr_t address) const { return begin <= address && address < end; }
  friend bool operator==(const LoadedImage&, const LoadedImage&) = default;
};

// Nothing for an address of no loaded image.
std::optional<LoadedImage> loaded_image_of(std::uintptr_t address);

// As long as it lives the library is not unloaded. Null for one that is not loaded.
using KeptImage = std::shared_ptr<void>;
KeptImage keep_loaded(const LoadedImage& image);

}  // namespace fieldproof::fuzz
