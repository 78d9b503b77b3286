#include "conformance/interbus/slave_twins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace fieldproof::conformance {
namespace {

using Change = interbus::TerminalBlock::Change;

// A change that is taken back, or followed by another one, within this is not seen by anything connected.
constexpr kernel::Duration kUnseen = 1 * kernel::kMicrosecond;

// Word by word, each in order of time.
std::vector<Change> changes_by_word(SlaveBench& bench) {
  std::vector<Change> sorted = bench.changes();
  std::ranges::stable_sort(sorted, {}, &Change::word);
  std::vector<Change> seen;
  for (const Change& change : sorted) {
    const bool continues =
        !seen.empty() && seen.back().word == change.word && change.when - seen.back().when <= kUnseen;
    if (!continues) {
      seen.push_back(change);
    } else if (seen.back().before == change.after) {
      seen.pop_back();
    } else {
      seen.back().after = change.after;
    }
  }
  return seen;
}

bool is_same(const Change& left, const Change& right) {
  return left.word == right.word && left.after == right.after;
}

std::string text_of_change(std::span<const Change> changes, std::size_t n) {
  if (n >= changes.size()) return "nothing more changes";
  return fmt::format("output word {} becomes {:04X}h at {}", changes[n].word, changes[n].after,
                     kernel::describe(changes[n].when));
}

bool is_same(const SeenTelegram& left, const SeenTelegram& right) {
  return left.header == right.header && left.data == right.data;
}

std::string text_of_telegram(const LineView& view, std::span<const SeenTelegram> telegrams, std::size_t n,
                             kernel::Time from) {
  return n < telegrams.size() ? describe(view, telegrams[n], from) : "no telegram";
}

// Of telegram n, which differs.
std::string_view reason_of(std::span<const SeenTelegram> right, std::span<const SeenTelegram> seen,
                           std::size_t n) {
  if (n >= seen.size()) return "telegram_not_passed";
  if (n >= right.size()) return "telegram_added";
  if (right[n].header != seen[n].header) return "header_wrong";
  return right[n].data != seen[n].data ? "octet_wrong" : "passed_at_another_time";
}

}  // namespace

SlaveTwins::SlaveTwins(SlaveBench& bench) : bench_(bench), early_(bench.twin(-1)), late_(bench.twin(1)) {}

bool SlaveTwins::agree(CaseJudge& judge, const std::string& after) {
  constexpr std::array<std::pair<std::string_view, View>, 3> kLines{{{"towards the master", &SlaveBench::out},
                                                                     {"OUT1", &SlaveBench::remote},
                                                                     {"OUT2", &SlaveBench::branch}}};
  for (const auto& [name, view] : kLines) {
    if (!is_line_certain(view)) return false;
  }
  if (!std::ranges::equal(changes_by_word(*early_), changes_by_word(*late_),
                          [](const Change& left, const Change& right) { return is_same(left, right); }))
    return false;
  compare_outputs(judge, after);
  for (const auto& [name, view] : kLines) compare_line(judge, name, view, after);
  each([](SlaveBench& one) { one.terminals().forget_changes(); });
  return true;
}

bool SlaveTwins::is_line_certain(View view) {
  LineView& early = (*early_.*view)();
  LineView& late = (*late_.*view)();
  // Instants in transmissions that are divided differently are rounded differently.
  const kernel::Duration most = bench_.bits(1) / 64;
  return std::ranges::equal(early.telegrams(), late.telegrams(),
                            [&](const SeenTelegram& left, const SeenTelegram& right) {
                              const kernel::Duration apart = early.start_of(left) - late.start_of(right);
                              return is_same(left, right) && -most <= apart && apart <= most;
                            });
}

void SlaveTwins::compare_line(CaseJudge& judge, std::string_view name, View view, const std::string& after) {
  LineView& right_view = (*early_.*view)();
  LineView& seen_view = (bench_.*view)();
  const std::span<const SeenTelegram> right = right_view.telegrams();
  const std::span<const SeenTelegram> seen = seen_view.telegrams();
  const kernel::Duration tolerance = bench_.bits(1) / 4;
  const auto fits = [&](std::size_t n) {
    if (!is_same(right[n], seen[n])) return false;
    const kernel::Duration late = seen_view.start_of(seen[n]) - right_view.start_of(right[n]);
    return -tolerance <= late && late <= tolerance;
  };
  std::size_t n = 0;
  while (n < std::min(right.size(), seen.size()) && fits(n)) ++n;
  const bool is_over = n == right.size() && n == seen.size();
  judge.expect(is_over, is_over ? std::string_view{} : reason_of(right, seen, n), [&] {
    const bool has_begun = !bench_.in().telegrams().empty();
    const kernel::Time from = has_begun ? bench_.in().start_of(bench_.in().telegrams()[0]) : kernel::kStart;
    return Mismatch{.expected = {text_of_telegram(right_view, right, n, from)},
                    .actual = text_of_telegram(seen_view, seen, n, from),
                    .first_difference = fmt::format("{}, telegram {}, after: {}", name, n, after)};
  });
}

void SlaveTwins::compare_outputs(CaseJudge& judge, const std::string& after) {
  if (!bench_.pics().supports("outputs")) return;
  const std::vector<Change> early = changes_by_word(*early_);
  const std::vector<Change> late = changes_by_word(*late_);
  const std::vector<Change> seen = changes_by_word(bench_);
  for (std::size_t n = 0; n < std::max(early.size(), seen.size()); ++n) {
    const bool is_there = n < early.size() && n < seen.size() && is_same(early[n], seen[n]);
    const bool is_in_time = is_there && early[n].when - bench_.bits(1) <= seen[n].when &&
                            seen[n].when <= late[n].when + bench_.rules().latch_limit;
    judge.expect(is_in_time, is_there ? "outputs_at_another_time" : "outputs_wrong", [&] {
      return Mismatch{.expected = {text_of_change(early, n)},
                      .actual = text_of_change(seen, n),
                      .first_difference = "outputs, after: " + after};
    });
  }
}

}  // namespace fieldproof::conformance
