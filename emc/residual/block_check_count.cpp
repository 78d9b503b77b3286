#include "emc/residual/block_check_count.hpp"

#include <fmt/format.h>

#include <bit>

#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

constexpr unsigned kMostFrameBits = 63;

[[noreturn]] void refuse(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage, sentence);
}

// The bits of a frame, first bit lowest, and the rule by which its receiver takes it.
class BlockFrame {
 public:
  BlockFrame(const BlockCheck& check, std::span<const std::uint8_t> message)
      : octets_(check.octets), has_parity_(check.has_parity), width_(check.bits_per_octet()) {
    if (octets_ < 1 || check.bits() > kMostFrameBits) {
      refuse(fmt::format("patterns are tried on frames of 1 to {} bits, and these are {}.", kMostFrameBits,
                         check.bits()));
    }
    if (!message.empty() && message.size() + 1 != octets_) {
      refuse(fmt::format("a frame of {} octets takes a message of {}, and this one has {}.", octets_,
                         octets_ - 1, message.size()));
    }
    std::uint8_t sum = 0;
    for (unsigned n = 0; n < message.size(); ++n) {
      sum ^= message[n];
      append(message[n], n);
    }
    append(sum, check.octets - 1);
  }

  std::uint64_t sent() const { return sent_; }

  bool is_taken(std::uint64_t received) const {
    std::uint64_t sum = 0;
    for (std::uint64_t rest = received, n = 0; n < octets_; ++n, rest >>= width_) sum ^= rest;
    // Most patterns end here.
    if ((sum & 0xFF) != 0) return false;
    if (!has_parity_) return true;
    for (std::uint64_t rest = received, n = 0; n < octets_; ++n, rest >>= width_) {
      const bool is_odd = std::popcount(rest & 0xFF) % 2 != 0;
      if (((rest >> 8) & 1) != (is_odd ? 1U : 0U)) return false;
    }
    return true;
  }

 private:
  void append(std::uint8_t octet, unsigned place) {
    std::uint64_t bits = octet;
    if (has_parity_ && std::popcount(octet) % 2 != 0) bits |= 0x100;
    sent_ |= bits << (place * width_);
  }

  std::uint64_t octets_;
  bool has_parity_;
  unsigned width_;
  std::uint64_t sent_ = 0;
};

// Of `bits` bits, with up to `most_flips` flips.
void require_few_patterns(unsigned bits, unsigned most_flips) {
  BigCount patterns = 0;
  BigCount of_weight = 1;
  for (unsigned k = 0; k <= most_flips && k <= bits; ++k) {
    patterns += of_weight;
    of_weight = of_weight * (bits - k) / (k + 1);
  }
  if (patterns > kMostPatterns) {
    refuse(fmt::format("{} patterns of up to {} flips are too many to try; {} is the limit.", patterns.str(),
                       most_flips, kMostPatterns));
  }
}

}  // namespace

std::vector<std::uint64_t> count_block_check_patterns(const BlockCheck& check, unsigned most_flips,
                                                      std::span<const std::uint8_t> message) {
  const BlockFrame frame(check, message);
  const unsigned bits = check.bits();
  require_few_patterns(bits, most_flips);
  std::vector<std::uint64_t> passed(most_flips + 1);
  passed[0] = frame.is_taken(frame.sent()) ? 1U : 0U;
  for (unsigned flips = 1; flips <= most_flips && flips <= bits; ++flips) {
    std::uint64_t taken = 0;
    std::uint64_t pattern = (std::uint64_t{1} << flips) - 1;
    while (pattern >> bits == 0) {
      taken += frame.is_taken(frame.sent() ^ pattern) ? 1U : 0U;
      // The next larger number with as many ones.
      const std::uint64_t lowest = pattern & (0 - pattern);
      const std::uint64_t carried = pattern + lowest;
      pattern = (((carried ^ pattern) >> 2) >> std::countr_zero(pattern)) | carried;
    }
    passed[flips] = taken;
  }
  return passed;
}

CountedBursts count_block_check_bursts(const BlockCheck& check, unsigned length,
                                       std::span<const std::uint8_t> message) {
  const BlockFrame frame(check, message);
  const unsigned bits = check.bits();
  if (length < 1 || length > bits) {
    refuse(fmt::format("a burst in a frame of {} bits has 1 to {} bits, and not {}.", bits, bits, length));
  }
  const std::uint64_t inner = length < 3 ? 1 : std::uint64_t{1} << (length - 2);
  const std::uint64_t places = bits - length + 1;
  if (inner > kMostPatterns / places) {
    refuse(fmt::format("there are too many bursts of {} bits to try; {} patterns are the limit.", length,
                       kMostPatterns));
  }
  const std::uint64_t ends = std::uint64_t{1} | std::uint64_t{1} << (length - 1);
  CountedBursts counted;
  for (std::uint64_t place = 0; place < places; ++place) {
    for (std::uint64_t between = 0; between < inner; ++between) {
      ++counted.patterns;
      counted.undetected += frame.is_taken(frame.sent() ^ ((ends | between << 1) << place)) ? 1U : 0U;
    }
  }
  return counted;
}

}  // namespace fieldproof::emc
