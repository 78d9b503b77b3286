#include "reports/junit_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <utility>
#include <vector>

#include "harness/judge/result_json.hpp"
#include "harness/kernel/time.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::reports {
namespace {

using judge::CaseResult;
using judge::Verdict;

enum class Outcome : std::uint8_t { passed, failure, error, skipped };

Outcome outcome_of(Verdict verdict, const JunitOptions& options) {
  switch (verdict) {
    case Verdict::pass:
      return Outcome::passed;
    case Verdict::warn:
      return options.is_strict ? Outcome::failure : Outcome::passed;
    case Verdict::fail:
      return Outcome::failure;
    case Verdict::not_applicable:
      return Outcome::skipped;
    case Verdict::inconclusive:
      if (options.inconclusive == InconclusiveAs::failure) return Outcome::failure;
      return options.inconclusive == InconclusiveAs::skipped ? Outcome::skipped : Outcome::error;
    case Verdict::none:
    case Verdict::error:
      break;
  }
  return Outcome::error;
}

Outcome outcome_of(const CaseResult& result, const JunitOptions& options) {
  const bool is_expected = counted_verdict(result) != result.verdict;
  return is_expected ? Outcome::skipped : outcome_of(result.verdict, options);
}

// What a Char of XML 1.0 may be.
bool is_xml_char(char32_t point) {
  return point == 0x9 || point == 0xA || point == 0xD || (point >= 0x20 && point <= 0xD7FF) ||
         (point >= 0xE000 && point <= 0xFFFD) || point >= 0x10000;
}

std::string xml_chars(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::string_view before = text;
    const auto point = kernel::take_code_point(text);
    const std::string_view octets = before.substr(0, before.size() - text.size());
    if (point && is_xml_char(*point)) {
      out += octets;
    } else {
      for (const char octet : octets) out += kernel::escaped_octet(octet);
    }
  }
  return out;
}

// Also for line ends: a reader would turn them into spaces, and two different names into the same.
std::string attribute(std::string_view text) {
  std::string out;
  for (const char c : xml_chars(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\n':
        out += "&#10;";
        break;
      case '\r':
        out += "&#13;";
        break;
      case '\t':
        out += "&#9;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string cdata(std::string_view text) {
  std::string safe = xml_chars(text);
  for (std::size_t at = 0; (at = safe.find("]]>", at)) != std::string::npos; at += 15) {
    safe.replace(at, 3, "]]]]><![CDATA[>");
  }
  return "<![CDATA[" + safe + "]]>";
}

std::string seconds(std::uint64_t microseconds) {
  return fmt::format("{}.{:06}", microseconds / 1'000'000, microseconds % 1'000'000);
}

struct Names {
  std::string classname;
  std::string name;
};

Names names_of(const std::string& id) {
  const std::size_t cut = id.rfind('/');
  if (cut == std::string::npos) return {"", id};
  Names names{id.substr(0, cut), id.substr(cut + 1)};
  for (char& c : names.classname) {
    if (c == '/') c = '.';
  }
  return names;
}

struct Totals {
  std::size_t tests = 0;
  std::size_t failures = 0;
  std::size_t errors = 0;
  std::size_t skipped = 0;
  std::uint64_t wall_time_us = 0;

  void add(const CaseResult& result, const JunitOptions& options) {
    add(outcome_of(result, options));
    wall_time_us += result.wall_time_us;
  }

  void add(Outcome outcome) {
    ++tests;
    failures += outcome == Outcome::failure ? 1U : 0U;
    errors += outcome == Outcome::error ? 1U : 0U;
    skipped += outcome == Outcome::skipped ? 1U : 0U;
  }

  std::string attributes() const {
    return fmt::format(R"(tests="{}" failures="{}" errors="{}" skipped="{}" time="{}")", tests, failures,
                       errors, skipped, seconds(wall_time_us));
  }
};

std::string property(std::string_view name, std::string_view value) {
  return fmt::format("        <property name=\"{}\" value=\"{}\"/>\n", name, attribute(value));
}

std::string properties(const RunIdentity& identity, const CaseResult& result) {
  std::string standing(name(result.reference.standing));
  if (!judge::is_verified(result.reference.standing)) standing += ", unverified";
  return "      <properties>\n" + property("verdict", name(result.verdict)) +
         property("purpose", result.purpose) + property("requirement", result.requirement) +
         property("source", result.reference.source) + property("standing", standing) +
         property("seed", fmt::format("{}", result.seed)) +
         property("repro", reproduce_command(identity, result.id)) +
         property("virtual_time", kernel::describe(result.virtual_time)) +
         property("wall_time", fmt::format("{} us", result.wall_time_us)) +
         property("fingerprint", judge::fingerprint_text(result.fingerprint)) + "      </properties>\n";
}

std::string message_of(const CaseResult& result) {
  if (result.verdict == Verdict::none) return "the case was not judged";
  if (counted_verdict(result) != result.verdict) return "expected: " + result.expected_because;
  if (result.verdict == Verdict::inconclusive) return "inconclusive: " + result.reason;
  return result.reason;
}

std::string outcome_element(Outcome outcome, const std::string& message, std::string_view type,
                            const std::string& text) {
  if (outcome == Outcome::passed) return "";
  if (outcome == Outcome::skipped)
    return fmt::format("      <skipped message=\"{}\"/>\n", attribute(message));
  const char* element = outcome == Outcome::failure ? "failure" : "error";
  return fmt::format("      <{0} message=\"{1}\" type=\"{2}\">{3}</{0}>\n", element, attribute(message), type,
                     cdata(text));
}

std::string test_case(const RunIdentity& identity, const CaseResult& result, const Names& names,
                      const JunitOptions& options) {
  std::string out =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{}\">\n", attribute(names.classname),
                  attribute(names.name), seconds(result.wall_time_us));
  out += properties(identity, result);
  const Outcome outcome = outcome_of(result, options);
  out += outcome_element(outcome, message_of(result), name(result.verdict), finding_text(identity, result));
  if (result.verdict == Verdict::warn && outcome == Outcome::passed) {
    out += "      <system-out>" + cdata(finding_text(identity, result)) + "</system-out>\n";
  }
  if (!result.log.empty()) out += "      <system-err>" + cdata(result.log) + "</system-err>\n";
  return out + "    </testcase>\n";
}

// The cases of one folder; folders in the order of their first case.
std::vector<std::pair<std::string, std::vector<const CaseResult*>>> by_folder(const Run& run) {
  std::vector<std::pair<std::string, std::vector<const CaseResult*>>> folders;
  std::map<std::string, std::size_t> places;
  for (const CaseResult& result : run.cases) {
    const std::string folder = names_of(result.id).classname;
    const auto [place, is_new] = places.try_emplace(folder, folders.size());
    if (is_new) folders.emplace_back(folder, std::vector<const CaseResult*>{});
    folders.at(place->second).second.push_back(&result);
  }
  return folders;
}

// xs:dateTime without zone, which is what consumers take; the manifest is in UTC.
std::string timestamp(const Manifest& manifest) {
  std::string utc = manifest.started;
  if (!utc.empty() && utc.back() == 'Z') utc.pop_back();
  return utc.empty() ? "" : fmt::format(" timestamp=\"{}\"", attribute(utc));
}

// What is wrong with a run that none of its cases tells; a testcase of the suite fieldproof.run each.
struct Complaint {
  std::string_view name;
  std::string_view type;
  std::string text;
  Outcome outcome;
};

std::vector<Complaint> complaints_about(const Run& run, const JunitOptions& options) {
  std::vector<Complaint> all;
  if (!run.is_complete()) {
    const Counts counts = count(run);
    all.push_back({"is_complete", "incomplete",
                   fmt::format("the run is incomplete: {}; {} of {} selected cases were not judged",
                               run.identity.incomplete_because, counts.not_run(), counts.selected),
                   outcome_of(Verdict::inconclusive, options)});
  }
  if (!run.identity.stale_expectations.empty()) {
    all.push_back({"baseline_is_current", "stale",
                   fmt::format("{}", fmt::join(run.identity.stale_expectations, "\n")), Outcome::failure});
  }
  return all;
}

std::string suite_of(const std::vector<Complaint>& complaints, const Manifest& manifest) {
  Totals totals;
  for (const Complaint& one : complaints) totals.add(one.outcome);
  std::string out =
      fmt::format("  <testsuite name=\"fieldproof.run\" {}{}>\n", totals.attributes(), timestamp(manifest));
  for (const Complaint& one : complaints) {
    out +=
        fmt::format("    <testcase classname=\"fieldproof.run\" name=\"{}\" time=\"0.000000\">\n", one.name);
    out += outcome_element(one.outcome, one.text, one.type, one.text + "\n");
    out += "    </testcase>\n";
  }
  return out + "  </testsuite>\n";
}

}  // namespace

std::string junit_xml(const Run& run, const Manifest& manifest, const JunitOptions& options) {
  Totals all;
  for (const CaseResult& result : run.cases) all.add(result, options);
  const std::vector<Complaint> complaints = complaints_about(run, options);
  for (const Complaint& one : complaints) all.add(one.outcome);
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out += fmt::format("<testsuites name=\"fieldproof\" {}>\n", all.attributes());
  for (const auto& [folder, results] : by_folder(run)) {
    Totals totals;
    for (const CaseResult* result : results) totals.add(*result, options);
    out += fmt::format("  <testsuite name=\"{}\" {}{}>\n", attribute(folder), totals.attributes(),
                       timestamp(manifest));
    for (const CaseResult* result : results) {
      out += test_case(run.identity, *result, names_of(result->id), options);
    }
    out += "  </testsuite>\n";
  }
  if (!complaints.empty()) out += suite_of(complaints, manifest);
  return out + "</testsuites>\n";
}

}  // namespace fieldproof::reports
