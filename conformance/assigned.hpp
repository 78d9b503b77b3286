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

}  // namespace fieldproof::conformance
