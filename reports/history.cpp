#include "reports/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "reports/history_numbers.hpp"
#include "reports/joined_verdict.hpp"

namespace fieldproof::reports {
namespace {

using judge::Verdict;

enum class CaseEnding : std::uint8_t { good, open, bad };

std::optional<CaseEnding> ending_of_case(Verdict verdict) {
  if (verdict >= Verdict::fail) return CaseEnding::bad;
  if (verdict == Verdict::inconclusive) return CaseEnding::open;
  if (verdict == Verdict::pass || verdict == Verdict::warn) return CaseEnding::good;
  return std::nullopt;
}

std::string setup_of(const RunIdentity& identity) {
  std::string text;
  for (const Implementation& one : identity.implementations) {
    const std::string place = one.position > 0 ? fmt::format("@{}", one.position) : "";
    text += fmt::format("{}{}{}{}{}", text.empty() ? "" : "; ", one.role, place, one.role.empty() ? "" : "=",
                        one.uri);
  }
  if (text.empty()) text = "ref";
  text += fmt::format(", volume {}", identity.volume);
  for (const auto& [what, hash] :
       {std::pair("network", &identity.network_hash), std::pair("PICS", &identity.pics_hash),
        std::pair("faults", &identity.plan_hash)}) {
    if (!hash->empty()) text += fmt::format(", {} {}", what, *hash);
  }
  return text;
}

struct Judged {
  std::size_t run = 0;
  Verdict verdict = Verdict::none;
  std::string reason;  // of a failure
};

class Builder {
 public:
  Builder(History& history, std::span<const DocumentKind> kinds) : history_(history), kinds_(kinds) {}

  // The newest comes first.
  void take(const std::string& name, const std::filesystem::path& path, const StoredRun& stored) {
    const std::size_t setup = place_of(setup_of(stored.run.identity));
    const std::size_t at = history_.runs.size();
    history_.runs.push_back(summary_of(name, stored, setup));
    for (const judge::CaseResult& result : stored.run.cases) {
      if (ending_of_case(result.verdict)) {
        cases_[{setup, result.id}].push_back(
            {at, result.verdict, result.verdict >= Verdict::fail ? result.reason : ""});
      }
    }
    for (Number& number : numbers_of(path, stored.run, kinds_)) {
      if (!std::isfinite(number.value)) continue;
      auto& values = numbers_[{setup, number.name, number.unit}];
      if (values.empty() || values.back().first != at) values.emplace_back(at, number.value);
    }
  }

  void end() {
    std::ranges::reverse(history_.runs);
    for (auto& [key, judged] : cases_) {
      turn(judged, &Judged::run);
      find_broken(key, judged);
      find_flaky(key, judged);
    }
    for (auto& [key, values] : numbers_) {
      turn(values, &std::pair<std::size_t, double>::first);
      add_quantity(key, values);
    }
    std::ranges::stable_sort(history_.quantities, {},
                             [](const Quantity& one) { return one.trend.probability; });
  }

 private:
  using CaseKey = std::pair<std::size_t, std::string>;
  using NumberKey = std::tuple<std::size_t, std::string, std::string>;

  // From the newest first to the oldest first.
  template <typename Values, typename Place>
  void turn(Values& values, Place place) const {
    std::ranges::reverse(values);
    for (auto& value : values) value.*place = history_.runs.size() - 1 - value.*place;
  }

  std::size_t place_of(const std::string& setup) {
    const auto found = std::ranges::find(history_.setups, setup);
    if (found != history_.setups.end()) return static_cast<std::size_t>(found - history_.setups.begin());
    history_.setups.push_back(setup);
    return history_.setups.size() - 1;
  }

  static HistoryRun summary_of(const std::string& name, const StoredRun& stored, std::size_t setup) {
    const RunIdentity& identity = stored.run.identity;
    const JudgedPart said = judged_run(name, stored.run);
    HistoryRun run{
        name,         stored.manifest.started, setup, identity.suite_version, identity.seed, said.verdict,
        said.sentence};
    for (const judge::CaseResult& result : stored.run.cases) {
      const std::optional<CaseEnding> ending = ending_of_case(counted_verdict(result));
      if (!ending) continue;
      ++(*ending == CaseEnding::good  ? run.passed
         : *ending == CaseEnding::bad ? run.failed
                                      : run.inconclusive);
    }
    run.not_run = count(stored.run).not_run();
    run.wall_time_us = stored.manifest.wall_time_us;
    return run;
  }

  void find_broken(const CaseKey& key, const std::vector<Judged>& judged) {
    if (judged.back().verdict < Verdict::fail) return;
    std::size_t first = judged.size() - 1;
    while (first > 0 && judged[first - 1].verdict >= Verdict::fail) --first;
    if (first == 0 || *ending_of_case(judged[first - 1].verdict) != CaseEnding::good) return;
    history_.broken.push_back(
        {key.second, key.first, judged[first - 1].run, judged[first].run, judged.back().reason});
  }

  // One turn may be a repair or a new fault; two turns under one suite are neither.
  void find_flaky(const CaseKey& key, const std::vector<Judged>& judged) {
    std::map<std::string, std::vector<Judged>> by_suite;
    for (const Judged& one : judged) by_suite[history_.runs[one.run].suite_version].push_back(one);
    for (const auto& [suite, all] : by_suite) {
      std::size_t turns = 0;
      std::map<std::uint64_t, CaseEnding> by_seed;
      FlakyCase flaky{key.second, key.first, suite, false, {}};
      for (std::size_t n = 0; n < all.size(); ++n) {
        const CaseEnding ending = *ending_of_case(all[n].verdict);
        turns += n > 0 && ending != *ending_of_case(all[n - 1].verdict) ? 1U : 0U;
        const auto [known, is_new] = by_seed.emplace(history_.runs[all[n].run].seed, ending);
        flaky.has_equal_seeds = flaky.has_equal_seeds || known->second != ending;
        flaky.verdicts.emplace_back(all[n].run, all[n].verdict);
      }
      if (turns >= 2) history_.flaky.push_back(std::move(flaky));
    }
  }

  void add_quantity(const NumberKey& key, const std::vector<std::pair<std::size_t, double>>& values) {
    if (values.size() < 2) return;
    const auto& [setup, name, unit] = key;
    std::vector<double> numbers;
    for (const auto& [run, value] : values) numbers.push_back(value);
    const auto [least, most] = std::ranges::minmax(numbers);
    Quantity quantity{name, unit, setup, values, {}};
    // What never changes cannot drift, and takes nothing of the chance that is left for others.
    if (least != most) {
      quantity.trend = trend_of(numbers);
      history_.varying += quantity.trend.is_tested() ? 1U : 0U;
    } else {
      quantity.trend.values = numbers.size();
    }
    history_.quantities.push_back(std::move(quantity));
  }

  History& history_;
  std::span<const DocumentKind> kinds_;
  std::map<CaseKey, std::vector<Judged>> cases_;
  std::map<NumberKey, std::vector<std::pair<std::size_t, double>>> numbers_;
};

}  // namespace

Drifts History::drifts(const Quantity& quantity) const {
  constexpr double kChance = 0.05;
  if (!quantity.trend.is_tested()) return Drifts::untested;
  if (quantity.trend.probability * static_cast<double>(varying) < kChance) return Drifts::yes;
  return quantity.trend.probability < kChance ? Drifts::perhaps : Drifts::no;
}

History history_of(const std::filesystem::path& folder, std::size_t most,
                   std::span<const DocumentKind> kinds) {
  History history;
  history.folder = folder.string();
  Builder builder(history, kinds);
  history.found = for_each_run(
      folder, most, [&](const std::string& name, const std::filesystem::path& path, const StoredRun& stored) {
        builder.take(name, path, stored);
      });
  builder.end();
  return history;
}

}  // namespace fieldproof::reports
