#include "cli/implementations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <set>

#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

using conformance::Assignment;
using conformance::Catalogue;
using conformance::Entry;

constexpr std::string_view kDeviant = "deviant:";

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

void check_role(const std::string& text, const std::string& role, const Catalogue& catalogue) {
  std::set<std::string> roles;
  for (const auto& suite : catalogue.suites()) {
    for (std::string& known : suite->roles()) roles.insert(std::move(known));
  }
  if (!roles.contains(role))
    refuse(text, fmt::format("there is no role '{}'; there are '{}'", role, fmt::join(roles, "', '")));
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

void resolve_deviation(Assignment& assignment, const Catalogue& catalogue, std::span<const Entry> among) {
  const std::string name = assignment.uri.substr(kDeviant.size());
  const std::string wanted = assignment.role.empty() ? name : fmt::format("{}/{}", assignment.role, name);
  const bool is_path = name.find('/') != std::string::npos;
  const conformance::DeviationEntry& found =
      catalogue.deviation(is_path ? name : wanted, is_path ? std::span<const Entry>{} : among);
  assignment.role = found.deviation->role;
  assignment.uri = fmt::format("{}{}", kDeviant, found.deviation->name);
}

}  // namespace

Assignment parse_implementation(const std::string& text, const Catalogue& catalogue,
                                std::span<const Entry> among) {
  Assignment assignment = split(text);
  if (!assignment.role.empty()) check_role(text, assignment.role, catalogue);
  if (assignment.uri.starts_with(kDeviant)) {
    resolve_deviation(assignment, catalogue, among);
  } else if (assignment.uri != "ref") {
    refuse(text,
           "there is no such kind of implementation; write ref, deviant:NAME or ROLE@POSITION=deviant:NAME");
  }
  return assignment;
}

}  // namespace fieldproof::cli
