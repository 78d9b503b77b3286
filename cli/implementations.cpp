#include "cli/implementations.hpp"

#include "cli/attachments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "conformance/assigned.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

using conformance::Assignment;
using conformance::Catalogue;
using conformance::Entry;
using conformance::Suite;

constexpr std::string_view kMutant = "mutant:";

[[noreturn]] void refuse(const std::string& text, const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage, fmt::format("--iut '{}': {}", text, sentence));
}

int position_from(const std::string& text, std::string_view digits) {
  int position = 0;
  const char* end = digits.data() + digits.size();
  const auto [rest, failure] = std::from_chars(digits.data(), end, position);
  if (failure != std::errc{} || rest != end || position < 1) {
    refuse(text,
           fmt::format("'{}' is no position; write 1 for the station next to the master, 2 for the next one",
                       digits));
  }
  return position;
}

// The suites that have the role, of which it may name the protocol (PROTOCOL/ROLE), which it has no more
// then; all of them for an assignment that names none.
std::vector<const Suite*> suites_with(const std::string& text, std::string& role,
                                      const Catalogue& catalogue) {
  const std::size_t slash = role.find('/');
  const std::string protocol = slash == std::string::npos ? "" : role.substr(0, slash);
  const std::string written = role;
  if (slash != std::string::npos) role.erase(0, slash + 1);
  std::vector<const Suite*> suites;
  std::set<std::string> roles;
  for (const auto& suite : catalogue.suites()) {
    const std::vector<std::string> known = suite->roles();
    if (!protocol.empty() && suite->protocol() != protocol) continue;
    if (role.empty() || std::find(known.begin(), known.end(), role) != known.end()) {
      suites.push_back(suite.get());
    }
    roles.insert(known.begin(), known.end());
  }
  if (suites.empty())
    refuse(text, fmt::format("there is no role '{}'; there are '{}'", written, fmt::join(roles, "', '")));
  return suites;
}

void check_position(const std::string& text, const Assignment& assignment,
                    const std::vector<const Suite*>& suites, std::size_t last_position) {
  int last = static_cast<int>(last_position);
  if (last == 0) {
    for (const Suite* suite : suites) last = std::max(last, suite->last_position());
  }
  if (assignment.position <= last) return;
  refuse(text, fmt::format("the position {} is out of range; a network has at most {} stations",
                           assignment.position, last));
}

// As it is written: "slave@3=mutant:NAME".
std::string text_of(const Assignment& one) {
  const std::string position = one.position > 0 ? fmt::format("@{}", one.position) : "";
  return one.role.empty() ? one.uri : fmt::format("{}{}={}", one.role, position, one.uri);
}

std::string place_of(const Assignment& assignment) {
  return fmt::format("{} at position {}", assignment.role, std::max(1, assignment.position));
}

// Nobody could say which of two is judged.
void check_places(const std::vector<Assignment>& implementations) {
  for (std::size_t later = 1; later < implementations.size(); ++later) {
    for (std::size_t earlier = 0; earlier < later; ++earlier) {
      const Assignment& one = implementations[earlier];
      const Assignment& other = implementations[later];
      if (one.role.empty() || other.role.empty()) {
        refuse(text_of(other),
               fmt::format("stands beside '{}', and one of the two is for every role; say both roles, or "
                           "leave one of them",
                           text_of(one)));
      }
      if (place_of(one) != place_of(other)) continue;
      refuse(text_of(other),
             fmt::format("the {} is taken by '{}'; leave one of the two", place_of(one), text_of(one)));
    }
  }
}

// What stands before the first '=' is a role unless it looks like an URI.
Assignment split(const std::string& text) {
  Assignment assignment;
  const std::size_t equals = text.find('=');
  std::string_view before = std::string_view(text).substr(0, equals);
  if (equals == std::string::npos || before.find(':') != std::string_view::npos) {
    assignment.uri = text;
    return assignment;
  }
  const std::size_t at = before.find('@');
  if (at != std::string_view::npos) assignment.position = position_from(text, before.substr(at + 1));
  assignment.role = before.substr(0, at);
  assignment.uri = text.substr(equals + 1);
  return assignment;
}

void resolve_mutant(Assignment& assignment, const Catalogue& catalogue, std::span<const Entry> among) {
  const std::string name = assignment.uri.substr(kMutant.size());
  const std::string wanted = assignment.role.empty() ? name : fmt::format("{}/{}", assignment.role, name);
  const bool is_path = name.find('/') != std::string::npos;
  const conformance::MutantEntry& found =
      catalogue.mutant(is_path ? name : wanted, is_path ? std::span<const Entry>{} : among);
  assignment.role = found.mutant->role;
  assignment.uri = fmt::format("{}{}", kMutant, found.mutant->name);
}

// What a program brings along, of any role where none is said.
bool is_own(const Assignment& assignment, std::span<const Suite* const> suites) {
  if (assignment.uri != conformance::kOwnUri) return false;
  return std::any_of(suites.begin(), suites.end(), [&](const Suite* suite) {
    const std::vector<std::string> roles = suite->roles();
    return std::any_of(roles.begin(), roles.end(), [&](const std::string& role) {
      return (assignment.role.empty() || assignment.role == role) && suite->has_own(role);
    });
  });
}

Assignment parse_implementation(const std::string& text, const Catalogue& catalogue,
                                std::span<const Entry> among, std::size_t last_position) {
  Assignment assignment = split(text);
  const std::vector<const Suite*> suites = suites_with(text, assignment.role, catalogue);
  check_position(text, assignment, suites, last_position);
  if (assignment.uri.starts_with(kMutant)) {
    resolve_mutant(assignment, catalogue, among);
  } else if (assignment.uri != "ref" && !is_attachment(assignment.uri) && !is_own(assignment, suites)) {
    refuse(text,
           "there is no such kind of implementation; write ref, mutant:NAME, plugin:LIBRARY, exec:PROGRAM, "
           "unix:PATH, tcp:HOST:PORT, or one of them after ROLE= or ROLE@POSITION=");
  }
  return assignment;
}

// An implementation outside without a place plays the roles that it serves.
std::vector<Assignment> in_served_roles(const std::string& text, const Assignment& assignment,
                                        std::span<const Entry> among) {
  std::vector<iut::RoleName> judged;
  for (const Entry& entry : among) {
    const iut::RoleName role{std::string(entry.suite->protocol()), entry.test_case->role()};
    if (std::ranges::find(judged, role) == judged.end()) judged.push_back(role);
  }
  std::vector<Assignment> implementations;
  for (const iut::RoleName& role : served_among(assignment.uri, judged))
    implementations.push_back({role.role, assignment.position, assignment.uri});
  if (implementations.empty() && !judged.empty()) {
    std::vector<std::string> paths;
    for (const iut::RoleName& role : judged) paths.push_back(role.path());
    refuse(text, fmt::format("it serves none of the roles that the selected cases judge: {}",
                             fmt::join(paths, ", ")));
  }
  return implementations;
}

bool has_mutant(const Suite& suite, const std::string& role, std::string_view name) {
  return std::any_of(suite.mutants().begin(), suite.mutants().end(), [&](const conformance::Mutant& mutant) {
    return mutant.name == name && (role.empty() || mutant.role == role);
  });
}

}  // namespace

std::vector<Assignment> parse_implementations(std::span<const std::string> texts, const Catalogue& catalogue,
                                              std::span<const Entry> among, std::size_t last_position) {
  std::vector<Assignment> implementations;
  for (const std::string& text : texts) {
    const Assignment assignment = parse_implementation(text, catalogue, among, last_position);
    if (assignment.role.empty() && is_attachment(assignment.uri)) {
      for (Assignment& one : in_served_roles(text, assignment, among))
        implementations.push_back(std::move(one));
    } else {
      implementations.push_back(assignment);
    }
  }
  check_places(implementations);
  return implementations;
}

void expect_parts(std::span<const Assignment> implementations, std::span<const Entry> among) {
  std::set<std::string> judged;
  std::set<std::string> parts;
  for (const Entry& entry : among) {
    judged.insert(entry.test_case->role());
    parts.insert(entry.test_case->parts.begin(), entry.test_case->parts.end());
  }
  for (const Assignment& one : implementations) {
    if (one.role.empty() || judged.empty() || judged.contains(one.role) || parts.contains(one.role)) continue;
    refuse(text_of(one), fmt::format("a {} takes part in none of the selected cases, which judge '{}'",
                                     one.role, fmt::join(judged, "', '")));
  }
}

std::optional<std::string> reason_not_runnable(const Assignment& assignment, const Suite& suite,
                                               std::size_t last_position) {
  const std::vector<std::string> roles = suite.roles();
  if (!assignment.role.empty() && std::find(roles.begin(), roles.end(), assignment.role) == roles.end()) {
    return fmt::format("the protocol has no role '{}'; write one of '{}'", assignment.role,
                       fmt::join(roles, "', '"));
  }
  const std::size_t last =
      last_position != 0 ? last_position : static_cast<std::size_t>(suite.last_position());
  if (static_cast<std::size_t>(assignment.position) > last) {
    return fmt::format("the position {} is out of range; a network has at most {} stations",
                       assignment.position, last);
  }
  const Suite* const only = &suite;
  if (assignment.uri == "ref" || is_attachment(assignment.uri) || is_own(assignment, std::span(&only, 1))) {
    return std::nullopt;
  }
  if (!assignment.uri.starts_with(kMutant)) {
    return fmt::format("'{}' is no implementation that can be run again; write ref or mutant:NAME",
                       assignment.uri);
  }
  const std::string name = assignment.uri.substr(kMutant.size());
  if (has_mutant(suite, assignment.role, name)) return std::nullopt;
  std::vector<std::string> known;
  for (const conformance::Mutant& mutant : suite.mutants()) known.push_back(mutant.name);
  const auto near = config::nearest(name, std::span<const std::string>(known), 3);
  return fmt::format("there is no mutant '{}'; the nearest are '{}'", name, fmt::join(near, "', '"));
}

}  // namespace fieldproof::cli
