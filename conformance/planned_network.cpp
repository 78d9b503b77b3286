#include "conformance/planned_network.hpp"

#include <fmt/ranges.h>

namespace fieldproof::conformance {
namespace {

[[noreturn]] void refuse_place(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage, "--iut: " + sentence);
}

}  // namespace

std::string network_case_id(const iut::RoleName& role) {
  return fmt::format("{}/{}/network", role.protocol, role.role);
}

void expect_roles(const NetworkRequest& request, std::span<const std::string_view> roles) {
  for (const Assignment& one : request.implementations) {
    if (one.uri == kReferenceUri && one.role.empty()) continue;
    if (std::ranges::find(roles, one.role) != roles.end()) continue;
    refuse_place(fmt::format("'{}' has no place in this network; write {}=URI or {}@N=URI", one.uri,
                             fmt::join(roles, "=URI, "), roles.front()));
  }
}

void expect_place(const Assignment& assignment, std::string_view role, std::size_t position,
                  std::size_t places) {
  if (position <= places) return;
  refuse_place(fmt::format("'{}': the network has {} {}; write {}@1 to {}@{}", assignment.uri, places, role,
                           role, role, places));
}

iut::Attachment attached_to_network(const NetworkRequest& request, const iut::RoleName& role,
                                    const std::string& uri, const std::string& case_id, std::uint64_t seed) {
  auto attachment = request.attach ? request.attach(role, {uri, case_id, seed, request.limits})
                                   : std::optional<iut::Attachment>{};
  if (!attachment) {
    throw kernel::Error(kernel::ErrorKind::usage, fmt::format("'{}' cannot take part in a network", uri));
  }
  if (attachment->device->capabilities().is_wall_clock) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("'{}': a network runs in virtual time, and a serial line does not", uri));
  }
  attachment->is_in_network = true;
  return std::move(*attachment);
}

}  // namespace fieldproof::conformance
