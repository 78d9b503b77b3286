#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "conformance/test_case.hpp"
#include "harness/iut/limits.hpp"

// What the URI of an implementation says, and who plays the role that a case judges.
namespace fieldproof::conformance {

inline constexpr std::string_view kReferenceUri = "ref";
inline constexpr std::string_view kMutantUri = "mutant:";
inline constexpr std::string_view kRecordedUri = "recorded:";
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

// What a suite is given for one role, besides its reference and its mutants.
template <typename Device, typename Configuration>
struct StationSources {
  using Make = std::function<std::unique_ptr<Device>(const IutRequest&, const Configuration&)>;

  Make own{};       // what the URI `own` means: the station of the program that holds the suite
  Make attached{};  // implementations outside; null for a URI of another kind

  // Null: one of the suite's own, or nothing at all.
  std::unique_ptr<Device> make(const IutRequest& wanted, const Configuration& configuration) const {
    const Make& make = wanted.uri == kOwnUri ? own : attached;
    return make ? make(wanted, configuration) : nullptr;
  }
};

// The name behind `mutant:`. Throws kernel::Error(usage) for any other URI; `what` is "INTERBUS slave".
std::string mutant_of(const std::string& uri, std::string_view what);

}  // namespace fieldproof::conformance
