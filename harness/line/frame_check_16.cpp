#include "harness/line/frame_check_16.hpp"

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "harness/kernel/error.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace fieldproof::line {

FrameCheck16::State FrameCheck16::update_by_table(State state, std::span<const std::uint8_t> octets) const {
  for (const std::uint8_t octet : octets) state = update_octet(state, octet);
  return state;
}

#if defined(__x86_64__)

namespace {

// Blocks are held with the first bit of the line as the highest power: octets reversed for checks that send
// the most significant bit first, as they come for the reflected ones (the multipliers are reflected then).
__attribute__((target("pclmul,ssse3"), always_inline)) inline __m128i load_block(const std::uint8_t* octets,
                                                                                 __m128i order) {
  return _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(octets)), order);
}

__attribute__((target("pclmul,ssse3"), always_inline)) inline __m128i ahead(__m128i block,
                                                                            __m128i multipliers) {
  return _mm_xor_si128(_mm_clmulepi64_si128(block, multipliers, 0x00),
                       _mm_clmulepi64_si128(block, multipliers, 0x11));
}

const bool kProcessorCanFold = __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("ssse3");

}  // namespace

bool FrameCheck16::can_fold() {
  return kProcessorCanFold;
}

// Four blocks run side by side to hide the latency of the multiplier; they are then brought to the place of
// the last one, which is equal to the whole message so far as the check is concerned, and goes through the
// tables like any 16 octets.
__attribute__((target("pclmul,ssse3"))) FrameCheck16::State FrameCheck16::update_by_folding(
    State state, std::span<const std::uint8_t> octets) const {
  const __m128i as_is = _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m128i reversed = _mm_setr_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
  const __m128i order = is_reflected_ ? as_is : reversed;
  const auto fold = [this](std::size_t blocks) __attribute__((always_inline)) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(&folds_[blocks - 1]));
  };
  const std::uint8_t* at = octets.data();
  std::size_t left = octets.size() - 64;
  const __m128i entering = _mm_shuffle_epi8(_mm_cvtsi32_si128(state), order);
  __m128i a = _mm_xor_si128(load_block(at, order), entering);
  __m128i b = load_block(at + 16, order);
  __m128i c = load_block(at + 32, order);
  __m128i d = load_block(at + 48, order);
  const __m128i by_four = fold(4);
  for (at += 64; left >= 64; left -= 64, at += 64) {
    a = _mm_xor_si128(ahead(a, by_four), load_block(at, order));
    b = _mm_xor_si128(ahead(b, by_four), load_block(at + 16, order));
    c = _mm_xor_si128(ahead(c, by_four), load_block(at + 32, order));
    d = _mm_xor_si128(ahead(d, by_four), load_block(at + 48, order));
  }
  d = _mm_xor_si128(_mm_xor_si128(d, ahead(a, fold(3))), _mm_xor_si128(ahead(b, fold(2)), ahead(c, fold(1))));
  for (; left >= 16; left -= 16, at += 16) d = _mm_xor_si128(ahead(d, fold(1)), load_block(at, order));
  std::array<std::uint8_t, 16> rest;
  _mm_storeu_si128(reinterpret_cast<__m128i*>(rest.data()), _mm_shuffle_epi8(d, order));
  return update_short(update_short(0, rest.data(), rest.size()), at, left);
}

#else

bool FrameCheck16::can_fold() {
  return false;
}

FrameCheck16::State FrameCheck16::update_by_folding(State state, std::span<const std::uint8_t> octets) const {
  return update_by_slices(state, octets);
}

#endif

const FrameCheck16& shared_frame_check_16(std::string_view name) {
  const FrameCheckParameters* const parameters = find_frame_check(name);
  if (parameters == nullptr || parameters->width != 16) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        "\"" + std::string(name) +
                            "\" is no 16-bit frame check of the catalogue; CRC-16/IBM-3740 would be one.");
  }
  static std::mutex mutex;
  static std::vector<std::unique_ptr<const FrameCheck16>> built(frame_check_catalogue().size());
  const auto row = static_cast<std::size_t>(parameters - frame_check_catalogue().data());
  const std::lock_guard lock(mutex);
  if (!built[row]) built[row] = std::make_unique<const FrameCheck16>(*parameters);
  return *built[row];
}

}  // namespace fieldproof::line
