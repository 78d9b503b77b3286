#include "cli/protocol_entry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/attachments.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

std::span<const ProtocolEntry> of_this_process;

}  // namespace

void use_protocols(std::span<const ProtocolEntry> protocols) {
  of_this_process = protocols;
}

std::span<const ProtocolEntry> protocols() {
  return of_this_process;
}

Suites make_suites(const conformance::Disturbances& disturbances) {
  const conformance::SuiteGiven given{
      .attach = attachments(), .disturbances = disturbances, .on_real_line = station_on_real_line};
  Suites all;
  for (const ProtocolEntry& protocol : protocols())
    if (protocol.suite != nullptr) all.push_back(protocol.suite(given));
  return all;
}

std::vector<const Role*> roles() {
  std::vector<const Role*> all;
  for (const ProtocolEntry& protocol : protocols())
    for (const Role& role : protocol.roles) all.push_back(&role);
  return all;
}

const Role* find_role(const std::string& path) {
  for (const Role* role : roles())
    if (role->path() == path) return role;
  return nullptr;
}

const Role& role_named(const std::string& path) {
  if (const Role* found = find_role(path)) return *found;
  std::vector<std::string> known;
  for (const Role* role : roles()) known.push_back(role->path());
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no role '{}'; there are '{}'", path, fmt::join(known, "', '")));
}

}  // namespace fieldproof::cli
