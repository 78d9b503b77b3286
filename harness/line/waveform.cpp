#include "harness/line/waveform.hpp"

#include <algorithm>
#include <array>

#include "harness/kernel/check.hpp"

namespace fieldproof::line {
namespace {

// change(word, mask) for the words that hold levels [first, end), the mask telling which of its levels.
template <typename Change>
void change_words(std::uint64_t* words, std::size_t first, std::size_t end, Change change) {
  if (first >= end) return;
  std::uint64_t* word = words + first / 64;
  std::uint64_t* const last = words + (end - 1) / 64;
  std::uint64_t mask = ~std::uint64_t{0} << (first % 64);
  for (; word != last; ++word) {
    change(*word, mask);
    mask = ~std::uint64_t{0};
  }
  change(*last, mask & (~std::uint64_t{0} >> (63 - (end - 1) % 64)));
}

// Four levels as a word each: taken from a table four words are copied at once, where one by one each of
// them waits for its shift.
constexpr std::size_t kLevelsAtOnce = 4;
using WordsAtOnce = std::array<std::uint64_t, kLevelsAtOnce>;

constexpr auto kWordsOfLevels = [] {
  std::array<WordsAtOnce, 1U << kLevelsAtOnce> table{};
  for (std::size_t levels = 0; levels < table.size(); ++levels) {
    for (std::size_t n = 0; n < kLevelsAtOnce; ++n) table[levels][n] = (levels >> n & 1) != 0 ? ~0ULL : 0;
  }
  return table;
}();

// Each of `count` packed levels as a word of equal levels.
void write_as_words(const std::uint64_t* levels, std::size_t count, std::uint64_t* words) {
  std::size_t n = 0;
  for (; n + kLevelsAtOnce <= count; n += kLevelsAtOnce) {
    const WordsAtOnce& at_once = kWordsOfLevels[levels[n / 64] >> (n % 64) & (kWordsOfLevels.size() - 1)];
    std::copy(at_once.begin(), at_once.end(), words + n);
  }
  for (; n < count; ++n) words[n] = 0 - (levels[n / 64] >> (n % 64) & 1);
}

}  // namespace

void Levels::grow(std::size_t levels) {
  const std::size_t wanted = std::max(levels + 64, capacity_ * 2);
  words_.resize(wanted / 64 + 2, ~std::uint64_t{0});
  capacity_ = (words_.size() - 1) * 64;
}

void Levels::append_fill(bool level, std::size_t count) {
  const std::size_t first = size_;
  append_idle(count);
  if (!level) fill(first, size_, false);
}

void Levels::fill(std::size_t first, std::size_t end, bool level) {
  FIELDPROOF_CHECK(end <= size_, "levels that are filled lie in the waveform");
  if (level) {
    change_words(words_.data(), first, end, [](std::uint64_t& word, std::uint64_t mask) { word |= mask; });
  } else {
    change_words(words_.data(), first, end, [](std::uint64_t& word, std::uint64_t mask) { word &= ~mask; });
  }
}

void Levels::invert(std::size_t first, std::size_t end) {
  FIELDPROOF_CHECK(end <= size_, "levels that are inverted lie in the waveform");
  change_words(words_.data(), first, end, [](std::uint64_t& word, std::uint64_t mask) { word ^= mask; });
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

void Levels::append_stretched(const Levels& other, std::size_t times) {
  FIELDPROOF_CHECK(times > 0 && &other != this, "levels are stretched once at least, and into others");
  const std::size_t begin = size_;
  append_idle(other.size() * times);
  if (times == kWordLevels && begin % kWordLevels == 0) {
    write_as_words(other.words(), other.size(), words_.data() + begin / kWordLevels);
    return;
  }
  for (std::size_t first = 0; first < other.size();) {
    const std::size_t end = other.end_of_run(first);
    if (!other[first]) fill(begin + first * times, begin + end * times, false);
    first = end;
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
  if (capacity_ == 0) grow(0);  // they were moved away
  std::fill_n(words_.begin(), word_count(), ~std::uint64_t{0});
  size_ = 0;
}

void Levels::resize(std::size_t size) {
  if (size < size_) {
    fill(size, size_, true);
    size_ = size;
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

Levels Levels::of_text(std::string_view text) {
  Levels levels;
  for (const char level : text) levels.append(level == '1' ? 1 : 0, 1);
  return levels;
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
