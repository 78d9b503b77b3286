// The fuzz target of every role: octets are a sequence, which runs on the bench of `check` with the reference
// under test and the comparison of `check`. A finding is one about the reference (or the comparison) and ends
// the program with the sequence in words. FIELDPROOF_ROLE names the role, "PROTOCOL/ROLE", FIELDPROOF_SUITE
// its suite, which FIELDPROOF_SUITE_HEADER declares.
//
// The first octet of an input is the seed of the run.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string_view>

#include FIELDPROOF_SUITE_HEADER
#include "conformance/sequence_check.hpp"
#include "conformance/sequence_octets.hpp"
#include "harness/kernel/check.hpp"

namespace {

using namespace fieldproof::conformance;

constexpr std::size_t kMostOctets = 512;

struct Target {
  std::unique_ptr<Suite> suite;
  const SequenceRole* role = nullptr;
};

Target target() {
  Target one{FIELDPROOF_SUITE()};
  for (const SequenceRole& role : one.suite->sequence_roles()) {
    if (role.test_case.id.starts_with(FIELDPROOF_ROLE "/")) one.role = &role;
  }
  if (one.role != nullptr) return one;
  std::fprintf(stderr, "there are no sequences for " FIELDPROOF_ROLE "\n");
  std::abort();
}

void print(const Sequence& sequence, const SequenceRole& role, const fieldproof::judge::CaseResult& result) {
  for (const std::string& line : sequence_lines(sequence, role.vocabulary))
    std::fprintf(stderr, "  %s\n", line.c_str());
  for (const auto& finding : result.findings) {
    std::fprintf(stderr, "%s: %s", finding.reason.c_str(), finding.actual.c_str());
    for (const std::string& expected : finding.expected)
      std::fprintf(stderr, ", expected %s", expected.c_str());
    std::fprintf(stderr, "\n");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Target one = target();
  if (size < 2 || size > kMostOctets) return -1;
  const std::span octets(data, size);
  Setup setup;
  setup.seed = octets.front();
  setup.volume = Volume::quick;
  const Sequence sequence = sequence_of_octets(octets.subspan(1), one.role->vocabulary);
  const Outcome outcome = run_sequence(*one.suite, *one.role, sequence, setup);
  const bool is_found = outcome.result.verdict >= fieldproof::judge::Verdict::fail;
  if (is_found) print(sequence, *one.role, outcome.result);
  FIELDPROOF_CHECK(!is_found, "the reference does what a station of its role must");
  return 0;
}
