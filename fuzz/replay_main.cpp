// Runs a fuzz target over stored inputs, under any compiler: `x_replay FOLDER_OR_FILE...`. Folders are walked
// in the order of their sorted paths, so that two runs do the same work in the same order. A target that
// finds something ends the program by itself (abort, sanitizer, exception), after the name of its input has
// been printed. Exit 1 when there was nothing to run: an empty corpus proves nothing.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

// Custom mutators call into libFuzzer, which a replay does not link. Nothing mutates here: the size stays.
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerMutate(std::uint8_t* /*data*/, std::size_t size,
                                                              std::size_t /*max_size*/) {
  return size;
}

namespace {

std::vector<std::filesystem::path> files_below(const std::filesystem::path& start) {
  if (!std::filesystem::is_directory(start)) return {start};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(start)) {
    if (entry.is_regular_file() && entry.path().filename().string().front() != '.')
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_passed(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    std::fprintf(stderr, "%s: cannot be read\n", file.c_str());
    return false;
  }
  const std::string octets((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  // A copy of exact size lets the address sanitizer see a read past the end.
  const std::vector<std::uint8_t> input(octets.begin(), octets.end());
  try {
    LLVMFuzzerTestOneInput(input.data(), input.size());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), error.what());
    return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t passed = 0;
  std::size_t failed = 0;
  for (int i = 1; i < argc; ++i) {
    const std::filesystem::path start(argv[i]);
    if (!std::filesystem::exists(start)) {
      std::fprintf(stderr, "%s: there is no such file or folder\n", argv[i]);
      ++failed;
      continue;
    }
    for (const auto& file : files_below(start)) {
      std::printf("%s\n", file.c_str());
      std::fflush(stdout);  // the name must be out before the input is tried
      ++(is_passed(file) ? passed : failed);
    }
  }
  std::printf("%zu passed, %zu failed\n", passed, failed);
  return failed == 0 && passed != 0 ? 0 : 1;
}
