#include "cli/baseline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "harness/config/document.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

using judge::Verdict;

// "2027-03-31", and nothing else.
std::optional<std::chrono::year_month_day> day_from(std::string_view text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return std::nullopt;
  unsigned year = 0;
  unsigned month = 0;
  unsigned day = 0;
  const auto take = [&](std::size_t at, std::size_t count, unsigned& number) {
    const char* const last = text.data() + at + count;
    const auto [rest, failure] = std::from_chars(text.data() + at, last, number);
    return failure == std::errc{} && rest == last;
  };
  if (!take(0, 4, year) || !take(5, 2, month) || !take(8, 2, day)) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(year)), std::chrono::month(month),
                                         std::chrono::day(day)};
  if (!date.ok()) return std::nullopt;
  return date;
}

std::chrono::year_month_day day_in(const config::Value& value) {
  const auto day = day_from(value.as_string());
  if (!day) config::fail(value, "it is no day; write for example \"2027-03-31\"");
  return *day;
}

std::string text_in(const config::Value& value) {
  if (value.as_string().empty()) config::fail(value, "it is empty; say in words what it is");
  return std::string(value.as_string());
}

std::string case_in(const config::Value& value, const conformance::Catalogue& catalogue) {
  const std::string id(value.as_string());
  std::vector<std::string> known;
  for (const conformance::Entry& entry : catalogue.entries()) {
    if (entry.test_case->id == id) return id;
    known.push_back(entry.test_case->id);
  }
  const auto near = config::nearest(id, std::span<const std::string>(known), 1);
  config::fail(value, fmt::format("there is no such case; the nearest is \"{}\"", near.front()));
}

bool is_judged(Verdict verdict) {
  return verdict > Verdict::none;
}

}  // namespace

Baseline Baseline::load(const std::filesystem::path& file, const conformance::Catalogue& catalogue,
                        std::chrono::year_month_day today) {
  const config::Document document = config::Document::load(file);
  Baseline baseline;
  config::read_object(document.root(), [&](config::ObjectReader& reader) {
    for (const config::Value& written : reader.required("expected").as_array()) {
      config::read_object(written, [&](config::ObjectReader& object) {
        Entry entry;
        entry.place = fmt::format("{}:{}", file.string(), written.line());
        entry.id = case_in(object.required("case"), catalogue);
        if (const auto finding = object.optional("finding")) entry.finding = text_in(*finding);
        entry.reason = text_in(object.required("reason"));
        const config::Value expires = object.required("expires");
        entry.has_expired = std::chrono::sys_days(day_in(expires)) < std::chrono::sys_days(today);
        entry.expires = expires.as_string();
        const bool is_double = std::ranges::any_of(baseline.entries_, [&](const Entry& other) {
          return other.id == entry.id && other.finding == entry.finding;
        });
        if (is_double) config::fail(written, "there is an entry for this already; leave one of the two");
        baseline.entries_.push_back(std::move(entry));
      });
    }
  });
  return baseline;
}

bool Baseline::is_about(const Entry& entry, const judge::CaseResult& result) const {
  return entry.id == result.id && (entry.finding.empty() || entry.finding == result.reason);
}

void Baseline::mark(judge::CaseResult& result) const {
  if (result.verdict <= Verdict::pass) return;
  for (const Entry& entry : entries_) {
    if (entry.has_expired || !is_about(entry, result)) continue;
    result.expected_because = fmt::format("{}, until {}", entry.reason, entry.expires);
  }
}

std::vector<std::string> Baseline::stale(const reports::Run& run) const {
  std::vector<std::string> sentences;
  for (const Entry& entry : entries_) {
    const auto found = std::ranges::find(run.cases, entry.id, &judge::CaseResult::id);
    if (found == run.cases.end() || !is_judged(found->verdict)) continue;
    const auto say = [&](const std::string& what) {
      sentences.push_back(fmt::format("{}: {} {}", entry.place, entry.id, what));
    };
    if (found->verdict == Verdict::not_applicable) {
      say("does not apply to this implementation; remove the entry");
    } else if (found->verdict == Verdict::pass) {
      say("passes; remove the entry");
    } else if (entry.has_expired) {
      say(fmt::format("was accepted until {}; mend it, or say until when from now on", entry.expires));
    } else if (!is_about(entry, *found)) {
      say(fmt::format("is accepted for '{}' and has '{}'", entry.finding, found->reason));
    }
  }
  return sentences;
}

std::chrono::year_month_day today_utc() {
  return std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
}

}  // namespace fieldproof::cli
