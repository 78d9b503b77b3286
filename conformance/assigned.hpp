#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "conformance/test_case.hpp"
#include "harness/iut/attached_case.hpp"
#include "harness/iut/limits.hpp"

// What the URI of an implementation says, and who plays the role that a case judges.
namespace fieldproof::conformance {

inline constexpr std::string_view kReferenceUri = "ref";
inline constexpr std::string_view kMutantUri = "mutant:";
inline constexpr std::string_view kOwnUri = "own";

// The last assignment for the role of the case, or for every role; else the reference.
Assignment assigned_to(const TestCase& test_case, const Setup& setup);

// Who is to play the role of one case.
struct IutRequest {
  const std::string& uri;
  const std::string& case_id;
  std::uint64_t seed;
  iut::PeerLimits limits{};
};

// Makes the station of the program that holds the suite, which the URI `own` means; null: there is none.
template <typename Device, typename Configuration>
using MakeOwn = std::function<std::unique_ptr<Device>(const IutRequest&, const Configuration&)>;

// The name after `mutant:`. Throws kernel::Error(usage) for any other URI; `what` is "INTERBUS slave".
std::string mutant_of(const std::string& uri, std::string_view what);

// Implementations outside, for any role; nothing for a URI of another kind. Throws kernel::Error for one that
// cannot be had.
using Attach =
    std::function<std::optional<iut::Attachment>(const iut::RoleName& role, const IutRequest& request)>;

[[noreturn]] void refuse_outside(const iut::RoleName& role);

// A `Kind` without an Attached has stations of the program only: an implementation outside is refused, before
// it is started.
template <typename Kind>
void expect_playable(const std::string& uri) {
  if constexpr (!requires { typename Kind::Attached; }) {
    if (uri != kReferenceUri && uri != kOwnUri && !uri.starts_with(kMutantUri))
      refuse_outside({Kind::protocol, Kind::role});
  }
}

// The station that an implementation outside plays.
template <typename Kind>
std::unique_ptr<typename Kind::Device> attached_station(iut::Attachment attachment,
                                                        const typename Kind::Configuration& configuration,
                                                        const std::string& case_id, std::uint64_t seed) {
  if constexpr (requires { typename Kind::Attached; }) {
    return std::make_unique<typename Kind::Attached>(std::move(attachment), configuration, case_id, seed);
  } else {
    refuse_outside({Kind::protocol, Kind::role});
  }
}

}  // namespace fieldproof::conformance
