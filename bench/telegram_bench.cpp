// Decoding a stream of telegrams, beside a receiver that goes bit by bit: with the gaps of a cycle, and
// without any. Both count the telegrams and sum their octets, which is checked at set-up.
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "bench/rows.hpp"
#include "harness/kernel/random.hpp"
#include "harness/line/telegram.hpp"

namespace fieldproof::bench {
namespace {

constexpr unsigned kTelegrams = 4096;

line::Levels stream(bool has_gaps) {
  const line::TelegramCode code{line::TelegramLayout{}};
  kernel::Random random(1);
  line::Levels levels;
  for (unsigned n = 0; n < kTelegrams; ++n) {
    code.append(levels, line::kDataTelegram, static_cast<std::uint8_t>(random.below(256)));
    if (has_gaps) levels.append_idle(n % 20 == 0 ? 1 : 2);
  }
  return levels;
}

std::uint64_t sum_bit_by_bit(const line::Levels& levels) {
  std::uint64_t sum = 0;
  unsigned position = 0;  // 0: waits for a start bit
  unsigned data = 0;
  bool is_data = false;
  for (std::size_t n = 0; n < levels.size(); ++n) {
    const bool level = levels[n];
    if (position == 0) {
      if (!level) position = 1;
    } else if (position < 4) {
      if (position == 3) is_data = level;
      ++position;
    } else if (is_data && position < 12) {
      data = data << 1 | (level ? 1U : 0U);
      ++position;
    } else {
      if (level) sum += data & 0xFF;
      position = 0;
    }
  }
  return sum;
}

std::uint64_t sum_decoded(const line::TelegramCode& code, const line::Levels& levels) {
  std::uint64_t sum = 0;
  code.decode(levels, 0, [&](const line::Telegram& telegram) {
    if (!telegram.is_stop_missing()) sum += telegram.data;
  });
  return sum;
}

Row row(bool has_gaps, bool is_ours) {
  const auto make = [=]() -> Batch {
    auto levels = std::make_shared<line::Levels>(stream(has_gaps));
    auto code = std::make_shared<line::TelegramCode>(line::TelegramLayout{});
    if (sum_bit_by_bit(*levels) != sum_decoded(*code, *levels)) {
      throw std::logic_error("the two receivers of telegrams read different octets");
    }
    // The sums are compared, so that no compiler leaves the work out.
    auto expected = std::make_shared<std::uint64_t>(sum_bit_by_bit(*levels));
    return [=] {
      const std::uint64_t sum = is_ours ? sum_decoded(*code, *levels) : sum_bit_by_bit(*levels);
      if (sum != *expected) throw std::logic_error("a receiver of telegrams changed its mind");
      return std::uint64_t{kTelegrams};
    };
  };
  return {std::string("telegram decode, ") + (has_gaps ? "gaps of a cycle" : "no gaps"),
          is_ours ? "fieldproof" : "bit by bit",
          "telegrams",
          is_ours ? "bit by bit" : "",
          is_ours ? 15.0 : 0.0,
          make};
}

const Rows kRows({row(false, false), row(false, true), row(true, false), row(true, true)});

}  // namespace
}  // namespace fieldproof::bench
