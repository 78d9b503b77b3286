#include "reports/diff.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/judge/result_json.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::reports {
namespace {

using judge::CaseResult;
using judge::Verdict;
using Json = nlohmann::ordered_json;

bool is_failure(Verdict verdict) {
  return verdict >= Verdict::fail;
}

std::map<std::string, const CaseResult*> by_id(const Run& run) {
  std::map<std::string, const CaseResult*> cases;
  for (const CaseResult& result : run.cases) cases.insert_or_assign(result.id, &result);
  return cases;
}

bool has_drifted(double before, double after, const DriftLimits& limits) {
  if (before == after || (std::isnan(before) && std::isnan(after))) return false;
  if (!std::isfinite(before) || !std::isfinite(after)) return true;
  const double moved = std::abs(after - before);
  return moved > limits.absolute && moved > limits.relative * std::abs(before);
}

void compare_verdicts(const CaseResult& before, const CaseResult& after, Difference& difference) {
  const VerdictChange change{after.id, before.verdict, after.verdict, before.reason, after.reason};
  if (is_failure(after.verdict) && !is_failure(before.verdict)) {
    difference.new_failures.push_back(change);
  } else if (is_failure(before.verdict) && !is_failure(after.verdict) && after.verdict >= Verdict::pass) {
    difference.fixed.push_back(change);
  } else if (before.verdict != after.verdict || before.reason != after.reason) {
    difference.changed.push_back(change);
  }
}

// A case may measure something of one name several times: the first belongs to the first, and so on.
using NamedMeasurements = std::map<std::pair<std::string_view, std::size_t>, const judge::Measurement*>;

NamedMeasurements by_name(const CaseResult& result) {
  std::map<std::string_view, std::size_t> seen;
  NamedMeasurements measurements;
  for (const judge::Measurement& one : result.measurements) {
    measurements[{one.name, seen[one.name]++}] = &one;
  }
  return measurements;
}

void compare_measurements(const CaseResult& before, const CaseResult& after, const DriftLimits& limits,
                          Difference& difference) {
  const NamedMeasurements earlier = by_name(before);
  for (const auto& [name, now] : by_name(after)) {
    const auto then = earlier.find(name);
    if (then == earlier.end() || !has_drifted(then->second->value, now->value, limits)) continue;
    difference.drifts.push_back({after.id, now->name, now->unit, then->second->value, now->value});
  }
}

void compare_cases(const CaseResult& before, const CaseResult& after, const DriftLimits& limits,
                   Difference& difference) {
  compare_verdicts(before, after, difference);
  compare_measurements(before, after, limits, difference);
  const bool were_run = before.verdict >= Verdict::pass && after.verdict >= Verdict::pass;
  if (were_run && before.seed == after.seed && before.fingerprint != after.fingerprint) {
    difference.fingerprints.push_back({after.id, after.seed, before.fingerprint, after.fingerprint});
  }
}

std::string implementations_text(const RunIdentity& identity) {
  std::string text;
  for (const Implementation& one : identity.implementations) {
    if (!text.empty()) text += " ";
    text += one.role + (one.position > 0 ? fmt::format("@{}", one.position) : "") + "=" + one.uri;
  }
  return text;
}

void compare_identities(const RunIdentity& before, const RunIdentity& after, Difference& difference) {
  const auto hold = [&](const char* what, const std::string& then, const std::string& now) {
    if (then == now) return;
    const auto shown = [](const std::string& text) { return text.empty() ? "none" : text; };
    difference.identity.push_back(fmt::format("{} changed from {} to {}", what, shown(then), shown(now)));
  };
  hold("the program", before.tool_version, after.tool_version);
  hold("the suite", before.suite_version, after.suite_version);
  hold("the seed", fmt::format("{}", before.seed), fmt::format("{}", after.seed));
  hold("the volume", before.volume, after.volume);
  hold("the plan", before.plan_hash, after.plan_hash);
  hold("the network", before.network_hash, after.network_hash);
  hold("the PICS", before.pics_hash, after.pics_hash);
  hold("the implementation", implementations_text(before), implementations_text(after));
}

void tell_incomplete(std::string_view which, const Run& run, Difference& difference) {
  if (run.is_complete()) return;
  const Counts counts = count(run);
  difference.incomplete.push_back(
      fmt::format("the {} run is incomplete: {}; {} of {} selected cases were not judged", which,
                  run.identity.incomplete_because, counts.not_run(), counts.selected));
}

std::string change_line(const VerdictChange& change) {
  std::string line =
      fmt::format("  {}: {} -> {}", escaped_line(change.id), name(change.before), name(change.after));
  if (!change.reason_after.empty()) line += "  (" + escaped_line(change.reason_after) + ")";
  return line + "\n";
}

std::string change_lines(std::string_view title, const std::vector<VerdictChange>& changes) {
  if (changes.empty()) return "";
  std::string out = fmt::format("{} ({})\n", title, changes.size());
  for (const VerdictChange& change : changes) out += change_line(change);
  return out;
}

std::string id_lines(std::string_view title, const std::vector<std::string>& ids) {
  if (ids.empty()) return "";
  std::string out = fmt::format("{} ({})\n", title, ids.size());
  for (const std::string& id : ids) out += "  " + escaped_line(id) + "\n";
  return out;
}

std::string drift_lines(const std::vector<Drift>& drifts) {
  if (drifts.empty()) return "";
  std::string out = fmt::format("timing drift ({})\n", drifts.size());
  for (const Drift& drift : drifts) {
    const std::string unit = escaped_line(drift.unit);
    const std::string share =
        std::isfinite(drift.relative()) ? fmt::format(", {:+.3f} %", 100 * drift.relative()) : "";
    out += fmt::format("  {} {}: {:.9g} -> {:.9g} {} ({:+.6g} {}{})\n", escaped_line(drift.id),
                       escaped_line(drift.measurement), drift.before, drift.after, unit, drift.absolute(),
                       unit, share);
  }
  return out;
}

std::string fingerprint_lines(const std::vector<FingerprintChange>& changes) {
  if (changes.empty()) return "";
  std::string out = fmt::format("equal seeds, different fingerprints ({})\n", changes.size());
  for (const FingerprintChange& change : changes) {
    out += fmt::format("  {} seed {}: {} -> {}\n", escaped_line(change.id), change.seed,
                       judge::fingerprint_text(change.before), judge::fingerprint_text(change.after));
  }
  return out;
}

Json changes_json(const std::vector<VerdictChange>& changes) {
  Json json = Json::array();
  for (const VerdictChange& change : changes) {
    json.push_back({{"id", kernel::as_utf8(change.id)},
                    {"before", name(change.before)},
                    {"after", name(change.after)},
                    {"reason_before", kernel::as_utf8(change.reason_before)},
                    {"reason_after", kernel::as_utf8(change.reason_after)}});
  }
  return json;
}

Json texts_json(const std::vector<std::string>& texts) {
  Json json = Json::array();
  for (const std::string& text : texts) json.push_back(kernel::as_utf8(text));
  return json;
}

Json drifts_json(const std::vector<Drift>& drifts) {
  Json json = Json::array();
  for (const Drift& drift : drifts) {
    json.push_back({{"id", kernel::as_utf8(drift.id)},
                    {"measurement", kernel::as_utf8(drift.measurement)},
                    {"unit", kernel::as_utf8(drift.unit)},
                    {"before", judge::number_to_json(drift.before)},
                    {"after", judge::number_to_json(drift.after)},
                    {"absolute", judge::number_to_json(drift.absolute())},
                    {"relative", judge::number_to_json(drift.relative())}});
  }
  return json;
}

Json fingerprints_json(const std::vector<FingerprintChange>& changes) {
  Json json = Json::array();
  for (const FingerprintChange& change : changes) {
    json.push_back({{"id", kernel::as_utf8(change.id)},
                    {"seed", fmt::format("{}", change.seed)},
                    {"before", judge::fingerprint_text(change.before)},
                    {"after", judge::fingerprint_text(change.after)}});
  }
  return json;
}

}  // namespace

double Drift::relative() const {
  if (before == 0) return std::copysign(std::numeric_limits<double>::infinity(), after);
  return absolute() / std::abs(before);
}

bool Difference::is_empty() const {
  return new_failures.empty() && fixed.empty() && changed.empty() && appeared.empty() &&
         disappeared.empty() && drifts.empty() && fingerprints.empty() && identity.empty() &&
         incomplete.empty();
}

Difference compare(const Run& before, const Run& after, const DriftLimits& limits) {
  Difference difference;
  compare_identities(before.identity, after.identity, difference);
  tell_incomplete("first", before, difference);
  tell_incomplete("second", after, difference);
  const auto former = by_id(before);
  const auto latter = by_id(after);
  for (const CaseResult& result : after.cases) {
    const auto found = former.find(result.id);
    if (found != former.end()) {
      compare_cases(*found->second, result, limits, difference);
      continue;
    }
    difference.appeared.push_back(result.id);
    if (is_failure(result.verdict)) {
      difference.new_failures.push_back({result.id, Verdict::none, result.verdict, "", result.reason});
    }
  }
  for (const CaseResult& result : before.cases) {
    if (!latter.contains(result.id)) difference.disappeared.push_back(result.id);
  }
  return difference;
}

std::string diff_text(const Difference& difference, const TextOptions& options) {
  if (difference.is_empty()) return "no difference\n";
  std::string out;
  for (const auto* sentences : {&difference.identity, &difference.incomplete}) {
    for (const std::string& sentence : *sentences) out += escaped_line(sentence) + "\n";
  }
  const std::string failures = change_lines("new failures", difference.new_failures);
  out += options.colour && !failures.empty() ? "\x1b[31m" + failures + "\x1b[0m" : failures;
  out += change_lines("fixed", difference.fixed);
  out += change_lines("changed", difference.changed);
  out += id_lines("appeared", difference.appeared);
  out += id_lines("disappeared", difference.disappeared);
  return out + drift_lines(difference.drifts) + fingerprint_lines(difference.fingerprints);
}

std::string diff_json(const Difference& difference) {
  const Json json = {{"schema", "fieldproof/diff/1"},
                     {"identity", texts_json(difference.identity)},
                     {"incomplete", texts_json(difference.incomplete)},
                     {"new_failures", changes_json(difference.new_failures)},
                     {"fixed", changes_json(difference.fixed)},
                     {"changed", changes_json(difference.changed)},
                     {"appeared", texts_json(difference.appeared)},
                     {"disappeared", texts_json(difference.disappeared)},
                     {"drifts", drifts_json(difference.drifts)},
                     {"fingerprints", fingerprints_json(difference.fingerprints)}};
  return json.dump(1) + "\n";
}

}  // namespace fieldproof::reports
