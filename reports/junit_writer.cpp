#include "reports/junit_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
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

// Servers keep the first of two tests of one name and lose the other: ids that differ only in '/' and '.' get
// a number.
class UniqueNames {
 public:
  Names of(const std::string& id) {
    Names names = names_of(id);
    const std::string first = names.name;
    for (int n = 2; !used_.emplace(names.classname, names.name).second; ++n) {
      names.name = fmt::format("{} ({})", first, n);
    }
    return names;
  }

 private:
  std::set<std::pair<std::string, std::string>> used_;
};

// The first and the last part of a text that is too long.
std::string capped(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  return fmt::format("{}\n[{} octets are left out]\n{}", text.substr(0, most / 2), text.size() - most / 2 * 2,
                     text.substr(text.size() - most / 2));
}

struct Totals {
  std::size_t tests = 0;
  std::size_t failures = 0;
  std::size_t errors = 0;
  std::size_t skipped = 0;
  std::uint64_t wall_time_us = 0;

  void add(Outcome outcome, std::uint64_t us) {
    wall_time_us += us;
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

std::string outcome_element(Outcome outcome, const std::string& message, std::string_view type,
                            const std::string& text) {
  if (outcome == Outcome::passed) return "";
  if (outcome == Outcome::skipped)
    return fmt::format("      <skipped message=\"{}\"/>\n", attribute(message));
  const char* element = outcome == Outcome::failure ? "failure" : "error";
  return fmt::format("      <{0} message=\"{1}\" type=\"{2}\">{3}</{0}>\n", element, attribute(message), type,
                     cdata(text));
}

// One <testcase>, and what counts of it.
struct Written {
  std::string suite;
  Outcome outcome = Outcome::passed;
  std::uint64_t wall_time_us = 0;
  std::string xml;
};

Written test_case(const RunIdentity& identity, const CaseResult& result, const Names& names,
                  const OutcomeRules& rules, const JunitLimits& limits) {
  Written out{names.classname, outcome_of(result, rules), result.wall_time_us, {}};
  out.xml = fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{}\">\n",
                        attribute(names.classname), attribute(names.name), seconds(result.wall_time_us));
  out.xml += properties(identity, result);
  const std::string text = capped(finding_text(identity, result), limits.text_octets);
  out.xml += outcome_element(out.outcome, outcome_message(result), name(result.verdict), text);
  if (result.verdict == Verdict::warn && out.outcome == Outcome::passed) {
    out.xml += "      <system-out>" + cdata(text) + "</system-out>\n";
  }
  if (!result.log.empty()) {
    out.xml += "      <system-err>" + cdata(capped(result.log, limits.text_octets)) + "</system-err>\n";
  }
  out.xml += "    </testcase>\n";
  return out;
}

Written test_case(const Complaint& complaint) {
  std::string xml = fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0.000000\">\n",
                                kComplaintSuite, complaint.name);
  xml += outcome_element(complaint.outcome, complaint.text, complaint.type, complaint.text + "\n");
  return {std::string(kComplaintSuite), complaint.outcome, 0, xml + "    </testcase>\n"};
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

std::vector<Written> written(const Run& run, const OutcomeRules& rules, const JunitLimits& limits) {
  std::vector<Written> all;
  UniqueNames names;
  const std::vector<Complaint> complaints = complaints_about(run, rules);
  for (const Complaint& one : complaints) names.of(fmt::format("{}/{}", kComplaintSuite, one.name));
  for (const auto& [folder, results] : by_folder(run)) {
    for (const CaseResult* result : results) {
      all.push_back(test_case(run.identity, *result, names.of(result->id), rules, limits));
    }
  }
  for (const Complaint& one : complaints) all.push_back(test_case(one));
  return all;
}

std::string totals_of(std::span<const Written> cases) {
  Totals totals;
  for (const Written& one : cases) totals.add(one.outcome, one.wall_time_us);
  return totals.attributes();
}

// How many of them, from the first on, one file holds.
std::size_t fitting(std::span<const Written> cases, const JunitLimits& limits) {
  std::size_t octets = 0;
  std::size_t count = 0;
  while (count < std::min(cases.size(), limits.cases)) {
    octets += cases[count].xml.size();
    if (count > 0 && octets > limits.octets) break;
    ++count;
  }
  return count;
}

std::string document(std::span<const Written> cases, const Manifest& manifest) {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out += fmt::format("<testsuites name=\"fieldproof\" {}>\n", totals_of(cases));
  while (!cases.empty()) {
    const auto end =
        std::ranges::find_if(cases, [&](const Written& one) { return one.suite != cases.front().suite; });
    const auto suite = cases.first(static_cast<std::size_t>(end - cases.begin()));
    out += fmt::format("  <testsuite name=\"{}\" {}{}>\n", attribute(suite.front().suite), totals_of(suite),
                       timestamp(manifest));
    for (const Written& one : suite) out += one.xml;
    out += "  </testsuite>\n";
    cases = cases.subspan(suite.size());
  }
  return out + "</testsuites>\n";
}

}  // namespace

std::string junit_xml(const Run& run, const Manifest& manifest, const OutcomeRules& rules) {
  return document(written(run, rules, {}), manifest);
}

std::vector<std::string> junit_files(const Run& run, const Manifest& manifest, const OutcomeRules& rules,
                                     const JunitLimits& limits) {
  const std::vector<Written> all = written(run, rules, limits);
  std::vector<std::string> files;
  std::span<const Written> rest = all;
  do {
    const std::size_t count = fitting(rest, limits);
    files.push_back(document(rest.first(count), manifest));
    rest = rest.subspan(count);
  } while (!rest.empty());
  return files;
}

}  // namespace fieldproof::reports
