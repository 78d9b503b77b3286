#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

// How a fuzz target reads its input as a script: octet by octet from the front, so that a change at one place
// of the input changes one place of the script. After the end every octet is 0.
namespace fieldproof::fuzz {

class OctetReader {
 public:
  OctetReader(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

  bool is_empty() const { return left_.empty(); }
  std::size_t size() const { return left_.size(); }

  std::uint8_t octet() {
    if (left_.empty()) return 0;
    const std::uint8_t first = left_.front();
    left_ = left_.subspan(1);
    return first;
  }
  std::uint16_t word() {
    const unsigned high = octet();
    return static_cast<std::uint16_t>(high << 8 | octet());
  }
  // The next octets, fewer than `count` at the end.
  std::span<const std::uint8_t> take(std::size_t count) {
    const auto taken = left_.first(std::min(count, left_.size()));
    left_ = left_.subspan(taken.size());
    return taken;
  }

 private:
  std::span<const std::uint8_t> left_;
};

}  // namespace fieldproof::fuzz
