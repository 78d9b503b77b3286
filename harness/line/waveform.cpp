#include "harness/line/waveform.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::line {

void Levels::grow(std::size_t levels) {
  const std::size_t wanted = std::max(levels + 64, capacity_ * 2);
  words_.resize(wanted / 64 + 2, ~std::uint64_t{0});
  capacity_ = (words_.size() - 1) * 64;
}

void Levels::append_fill(bool level, std::size_t count) {
  if (level) return append_idle(count);
  reserve(size_ + count);
  const std::size_t until = size_ + count;
  // The rest of the word that is begun, whole words, and the beginning of the last one.
  const std::size_t in_word = size_ % 64;
  const auto head = static_cast<unsigned>(in_word == 0 ? 0 : std::min<std::size_t>(64 - in_word, count));
  append(0, head);
  const std::size_t whole = (until - size_) / 64;
  std::fill_n(words_.begin() + static_cast<std::ptrdiff_t>(size_ / 64), whole, std::uint64_t{0});
  size_ += whole * 64;
  append(0, static_cast<unsigned>(until - size_));
}

void Levels::append(const Levels& other) {
  append(other, 0, other.size());
}

void Levels::append(const Levels& other, std::size_t first, std::size_t count) {
  for (std::size_t n = 0; n < count; n += 64) {
    const auto take = static_cast<unsigned>(std::min<std::size_t>(64, count - n));
    append(first + n <= other.size() ? other.window(first + n) : ~std::uint64_t{0}, take);
  }
}

void Levels::flip(std::size_t n) {
  FIELDPROOF_CHECK(n < size_, "a level that is flipped lies in the waveform");
  words_[n / 64] ^= std::uint64_t{1} << (n % 64);
}

void Levels::set(std::size_t n, bool level) {
  if ((*this)[n] != level || n >= size_) flip(n);
}

void Levels::clear() {
  std::fill_n(words_.begin(), word_count(), ~std::uint64_t{0});
  size_ = 0;
}

void Levels::resize(std::size_t size) {
  if (size < size_) {
    *this = slice(0, size);
  } else {
    append_idle(size - size_);
  }
}

Levels Levels::slice(std::size_t first, std::size_t count) const {
  Levels part;
  part.append(*this, first, count);
  return part;
}

std::string Levels::text() const {
  std::string text;
  text.reserve(size_);
  for (std::size_t n = 0; n < size_; ++n) text.push_back((*this)[n] ? '1' : '0');
  return text;
}

bool operator==(const Levels& a, const Levels& b) {
  return a.size_ == b.size_ && std::equal(a.words(), a.words() + a.word_count(), b.words());
}

bool Waveform::at(kernel::Time time) const {
  const std::size_t next = first_level_at(time);
  if (next < levels.size() && time_of(next) == time) return levels[next];
  return next == 0 || time >= end() || levels[next - 1];
}

std::size_t Waveform::first_level_at(kernel::Time time) const {
  if (time <= start) return 0;
  if (time >= end()) return levels.size();
  auto n = static_cast<std::size_t>(kernel::levels_within(time - start, rate));
  while (n > 0 && time_of(n - 1) >= time) --n;
  while (n < levels.size() && time_of(n) < time) ++n;
  return n;
}

}  // namespace fieldproof::line
