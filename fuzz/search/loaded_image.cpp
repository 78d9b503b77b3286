#include "fuzz/search/loaded_image.hpp"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>

namespace fieldproof::fuzz {
namespace {

struct Search {
  std::uintptr_t address;
  std::optional<LoadedImage> found;
};

LoadedImage image_told(const dl_phdr_info& info) {
  LoadedImage image{.path = info.dlpi_name, .base = info.dlpi_addr, .begin = UINTPTR_MAX};
  for (ElfW(Half) n = 0; n < info.dlpi_phnum; ++n) {
    const ElfW(Phdr)& part = info.dlpi_phdr[n];
    if (part.p_type != PT_LOAD) continue;
    image.begin = std::min(image.begin, image.base + part.p_vaddr);
    image.end = std::max(image.end, image.base + part.p_vaddr + part.p_memsz);
  }
  // The dynamic linker gives this program no name.
  image.is_program = image.path.empty();
  return image;
}

int look_at(dl_phdr_info* info, std::size_t, void* context) {
  auto& search = *static_cast<Search*>(context);
  LoadedImage image = image_told(*info);
  if (!image.holds(search.address)) return 0;
  search.found = std::move(image);
  return 1;
}

}  // namespace

std::optional<LoadedImage> loaded_image_of(std::uintptr_t address) {
  Search search{address, std::nullopt};
  ::dl_iterate_phdr(&look_at, &search);
  return search.found;
}

KeptImage keep_loaded(const LoadedImage& image) {
  void* const handle = ::dlopen(image.is_program ? nullptr : image.path.c_str(), RTLD_NOW | RTLD_NOLOAD);
  if (handle == nullptr) return nullptr;
  return {handle, [](void* opened) { ::dlclose(opened); }};
}

}  // namespace fieldproof::fuzz
