#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/judging.hpp"
#include "conformance/token_bus/translator_bench.hpp"
#include "conformance/token_bus/translator_words.hpp"

// What a translator has sent and indicated after a command of a sequence, as far as it can be said, and when.
namespace fieldproof::conformance {

struct TimedText {
  std::string text;
  std::vector<kernel::Duration> times;  // of each letter, since the command

  void add(char letter, kernel::Duration time) {
    text += letter;
    times.push_back(time);
  }
  void keep(std::size_t first, std::size_t count = std::string::npos);
};

// Benches are at other times.
struct BegunBench {
  TranslatorBench* bench;
  kernel::Time begin{};  // of the command
};

TimedText sent_of(const BegunBench& one, TranslatorLook look);
// `sure`: symbols from the first non_data on that are looked at.
TimedText indicated_of(const BegunBench& one, TranslatorLook look, std::size_t sure);

struct LaterTimes {
  kernel::Duration symbols;
  kernel::Duration answers;
};
struct SideReasons {
  std::string_view different;
  std::string_view too_late;
};
void expect_same(std::string_view side, const TimedText& seen, const TimedText& right,
                 const SideReasons& reasons, const LaterTimes& later, CaseJudge& judge);

}  // namespace fieldproof::conformance
