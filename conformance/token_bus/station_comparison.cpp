#include "conformance/token_bus/station_comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace fieldproof::conformance {
namespace {

std::string octets_in_words(std::span<const std::int64_t> values) {
  constexpr std::size_t kMost = 24;
  return fmt::format("{:02X}{}", fmt::join(values.first(std::min(values.size(), kMost)), " "),
                     values.size() > kMost ? fmt::format(" and {} more", values.size() - kMost) : "");
}

std::string event_in_words(std::span<const std::int64_t> values) {
  return fmt::format("{} about {:04X}", token_bus::text_of(static_cast<token_bus::EventKind>(values[0])),
                     values[1]);
}

constexpr EventKind kTokenFrames{"frames", "frame_missing", "frame_unasked", "frame_other", octets_in_words};
constexpr EventKind kTokenIndications{"indications", "indication_missing", "indication_unasked",
                                      "indication_other", octets_in_words};
constexpr EventKind kTokenEvents{"events", "event_missing", "event_unasked", "event_other", event_in_words};

template <typename T>
std::span<const T> rest(const std::vector<T>& all, std::size_t known) {
  return std::span<const T>(all).subspan(std::min(known, all.size()));
}

}  // namespace

void TokenComparison::compare(bool is_alone) {
  compare_submissions();
  compare_frames(std::max(bench_.driven_frames().all().size(), twin_.driven().size()));
  expect_nothing_overdue();
  expect_chance();
  compare_indications();
  compare_all_events(is_alone);
  compare_counters();
}

void TokenComparison::compare_submissions() {
  for (; !submitted_.empty(); submitted_.pop_front(), ++submissions_) {
    const Submission& one = submitted_.front();
    const bool is_right = twin_.taken().at(submissions_);
    judge_.expect(one.is_taken == is_right, is_right ? "data_refused" : "data_taken_unasked", [&] {
      return Mismatch{{fmt::format("data of {} octets is {}", one.size, is_right ? "taken" : "refused")},
                      one.is_taken ? "taken" : "refused"};
    });
  }
}

void TokenComparison::compare_sure_frames() {
  expect_no_early_begin();
  compare_frames(twin_.sure_frames());
  if (twin_.overdue()) expect_begun_by(*twin_.overdue());
}

// The first `count` that there are.
void TokenComparison::compare_frames(std::size_t count) {
  const auto new_of = [&](const std::vector<DrivenFrame>& all) {
    return rest(all, frames_)
        .first(std::min(all.size(), std::max(count, frames_)) - std::min(frames_, all.size()));
  };
  const auto seen = new_of(bench_.driven_frames().all());
  const auto right = new_of(twin_.driven());
  // What begins at another time is said first: what comes then is often something else.
  for (std::size_t n = 0; n < std::min(seen.size(), right.size()); ++n) {
    if (seen[n].octets != right[n].octets) break;
    expect_in_time(seen[n], twin_.spans().at(frames_ + n));
  }
  compare_new(kTokenFrames, frames_of(seen), frames_of(right));
  frames_ += seen.size();
}

void TokenComparison::expect_in_time(const DrivenFrame& one, const BeginSpan& span) {
  const auto expect = [&](bool holds, std::string_view reason) {
    judge_.expect(holds, reason, [&] {
      return Mismatch{{fmt::format("{}, begun {} to {}", one.text(), kernel::describe(span.earliest),
                                   kernel::describe(span.latest))},
                      fmt::format("begun {}", kernel::describe(one.begin)),
                      one.begin};
    });
  };
  expect(one.begin >= span.earliest, "begins_too_early");
  expect(one.begin <= span.latest, "begins_too_late");
}

void TokenComparison::expect_no_early_begin() {
  const auto& early = twin_.early_begin();
  judge_.expect(!early, "begins_too_early", [&] {
    return Mismatch{{fmt::format("a transmission, begun {} at the earliest", kernel::describe(early->due))},
                    fmt::format("begun {}", kernel::describe(early->begin)),
                    early->begin};
  });
}

void TokenComparison::expect_begun_by(kernel::Time latest) {
  judge_.fail(
      kTokenFrames.missing,
      {{fmt::format("a transmission, begun by {}", kernel::describe(latest))}, "it is silent", latest});
}

// What was due, and might begin no later than now, has begun.
void TokenComparison::expect_nothing_overdue() {
  const auto until = twin_.awaited_until();
  if (until && *until <= bench_.now() && !twin_.may_be_silent()) expect_begun_by(*until);
}

// What is drawn each time is the same so often once in a million rings.
void TokenComparison::expect_chance() {
  constexpr std::size_t kDraws = 12;
  const auto expect_drawn = [&](const std::vector<std::size_t>& drawn, std::string_view reason,
                                std::string_view text) {
    const bool is_one = drawn.size() >= kDraws &&
                        std::ranges::adjacent_find(drawn, std::ranges::not_equal_to()) == drawn.end();
    judge_.expect(!is_one, reason, [&] {
      return Mismatch{{fmt::format("{}, drawn each time", text)},
                      fmt::format("{} each of {} times", drawn.front(), drawn.size())};
    });
  };
  expect_drawn(twin_.tokens_to_windows(), "windows_not_drawn", "tokens from one window to the next");
  expect_drawn(twin_.last_claims(), "last_claim_not_drawn", "octets of the last claim");
}

void TokenComparison::compare_indications() {
  compare_new(kTokenIndications, indications_of(rest(bench_.user().frames, indications_), bench_.rules()),
              indications_of(rest(twin_.user().frames, indications_), bench_.rules()));
  indications_ = bench_.user().frames.size();
}

// That it is alone a station knows when it has claimed the token, or when a window was silent: by the end
// of some windows it has said it as often.
void TokenComparison::compare_all_events(bool is_alone) {
  const auto is_sole = [](const TokenUser::Reported& one) {
    return one.event.kind == token_bus::EventKind::sole_station;
  };
  std::vector<TokenUser::Reported> seen(bench_.user().all_events);
  std::vector<TokenUser::Reported> right(twin_.user().all_events);
  const auto sole_seen = std::ranges::count_if(seen, is_sole);
  const auto sole_right = std::ranges::count_if(right, is_sole);
  const bool is_about_another = std::ranges::any_of(seen, [&](const TokenUser::Reported& one) {
    return is_sole(one) && one.event.address != bench_.address();
  });
  // One that is named as its own successor may say that, or that it is alone.
  const auto is_about_alone = [&](const TokenUser::Reported& one) {
    const bool is_change = one.event.kind == token_bus::EventKind::successor_changed;
    return is_sole(one) || (is_change && one.event.address == bench_.address());
  };
  std::erase_if(seen, is_about_alone);
  std::erase_if(right, is_about_alone);
  compare_new(kTokenEvents, events_of(rest(seen, events_)), events_of(rest(right, events_)));
  events_ = seen.size();
  judge_.expect(!is_about_another, kTokenEvents.different, "sole station about itself",
                "sole station about another");
  judge_.expect(sole_seen <= sole_right, kTokenEvents.surplus, "sole station when it becomes so",
                "it is reported again");
  if (!is_alone) return;
  judge_.expect(sole_right == sole_right_ || sole_seen > sole_seen_, kTokenEvents.missing, "sole station",
                "it is not reported");
  sole_seen_ = sole_seen;
  sole_right_ = sole_right;
}

void TokenComparison::compare_counters() {
  const token_bus::Counters seen = bench_.counters();
  const token_bus::Counters right = twin_.counters();
  judge_.expect(seen == right, "counter_wrong", [&] {
    return Mismatch{{fmt::format("faulty receptions {}", fmt::join(right, " "))},
                    fmt::format("{}", fmt::join(seen, " "))};
  });
}

void TokenComparison::compare_new(const EventKind& kind, const Observations& seen,
                                  const Observations& right) {
  compare_events(kind, seen, std::array{right}, true, judge_);
}

}  // namespace fieldproof::conformance
