#include "conformance/token_bus/translator_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::conformance {
namespace {

constexpr std::string_view kAnswers = "iane";

bool is_answer(char letter) {
  return kAnswers.find(letter) != std::string_view::npos;
}

// When an answer comes within its command is the translator's choice; idle before it says that it is still
// to come.
TimedText symbols_and_answers(const BegunBench& one, bool is_each_answer_once) {
  const SideLog& log = one.bench->indicated();
  TimedText all;
  const std::string& text = log.text();
  for (std::size_t n = 0; n < text.size(); ++n) {
    const char letter = text[n];
    const bool is_again = is_answer(letter) && (letter == 'i' || all.text.ends_with(letter));
    if (letter == 'S' || (is_each_answer_once && is_again)) continue;
    all.add(letter, log.time_of(n) - one.begin);
  }
  return all;
}

// Idle that stands for as long as the first command says nothing.
void keep_from_the_first_answer(TimedText& all) {
  const std::size_t first = all.text.find_first_not_of('i');
  if (first != std::string::npos) all.keep(first);
}

void keep_ends(TimedText& all) {
  constexpr std::size_t kFirst = 12;
  constexpr std::size_t kLast = 40;
  if (all.text.size() <= kFirst + kLast) return;
  TimedText last = all;
  last.keep(all.text.size() - kLast);
  all.keep(0, kFirst);
  all.text += last.text;
  all.times.insert(all.times.end(), last.times.begin(), last.times.end());
}

}  // namespace

void TimedText::keep(std::size_t first, std::size_t count) {
  first = std::min(first, text.size());
  count = std::min(count, text.size() - first);
  text = text.substr(first, count);
  times = std::vector<kernel::Duration>(times.begin() + static_cast<std::ptrdiff_t>(first),
                                        times.begin() + static_cast<std::ptrdiff_t>(first + count));
}

// Whether the symbol that makes a jabber still goes out is left open.
TimedText sent_of(const BegunBench& one, TranslatorLook look) {
  const TranslatorBench& bench = *one.bench;
  TimedText all;
  const std::string& text = bench.sent().text();
  const std::size_t first = text.find_first_not_of('I');
  const std::size_t last = text.find_last_not_of('I');
  for (std::size_t n = first; first != std::string::npos && n <= last; ++n)
    all.add(text[n], bench.sent().time_of(n) - one.begin);
  if (look != TranslatorLook::sent_nearly) return all;
  const std::size_t limit = 2 * std::size_t{bench.configuration().jabber_symbols};
  if (all.text.size() == limit + 2) all.keep(0, limit);
  return all;
}

TimedText indicated_of(const BegunBench& one, TranslatorLook look, std::size_t sure) {
  TimedText all = symbols_and_answers(one, look != TranslatorLook::answers);
  switch (look) {
    case TranslatorLook::content:
      // What a single bit before the silence is the page says in two ways.
      if (all.text.ends_with('B')) all.keep(0, all.text.size() - 1);
      all.keep(all.text.find('N'), sure);
      break;
    case TranslatorLook::ends:
      all.keep(all.text.find('N'));
      keep_ends(all);
      break;
    case TranslatorLook::last:
      all.keep(all.text.rfind(start_delimiter_text()));
      break;
    case TranslatorLook::answers:
      keep_from_the_first_answer(all);
      break;
    default:
      break;
  }
  return all;
}

void expect_same(std::string_view side, const TimedText& seen, const TimedText& right,
                 const SideReasons& reasons, const LaterTimes& later, CaseJudge& judge) {
  judge.expect(seen.text == right.text, reasons.different, [&] {
    Mismatch made = difference(right.text, seen.text);
    made.actual = fmt::format("{}, {}", side, made.actual);
    return made;
  });
  constexpr kernel::Duration kRounding = 2 * kernel::kNanosecond;
  char last = 'S';
  for (std::size_t n = 0; n < std::min(seen.times.size(), right.times.size()); ++n) {
    const bool goes_on = std::exchange(last, right.text[n]) == right.text[n] && is_answer(last);
    if (goes_on || right.text[n] == 'I') continue;
    const kernel::Duration latest = right.times[n] + (is_answer(last) ? later.answers : later.symbols);
    judge.expect(seen.times[n] <= latest + kRounding, reasons.too_late, [&] {
      return Mismatch{
          {fmt::format("{}: {} at {} at the latest", side, right.text[n], kernel::describe(latest))},
          kernel::describe(seen.times[n])};
    });
  }
}

}  // namespace fieldproof::conformance
