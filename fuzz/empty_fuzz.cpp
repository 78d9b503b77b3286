// The measuring stick: an input that is looked at and nothing else. The rates of the other targets are told
// as parts of the rate of this one in the same build.

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return size > 0 && data[0] == 0 ? 0 : 0;
}
