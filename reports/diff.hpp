// What changed from one run to another.
//
// Cases are matched by id, measurements by case and name, those of one name by their order. A failure is a
// verdict of fail or error; a new failure is one that is a failure only in the second run (also of a case
// that only the second run has), a fixed one is judged in both runs and a failure only in the first. A
// measurement drifts when it moved by more than `absolute` (in its unit) and by more than `relative` of its
// former value; what became or ceased to be a number drifts always. What an incomplete run never judged is in
// no list, so `incomplete` says which of the two is: a comparison with it proves nothing about the rest.
// Equal case seeds with different fingerprints are listed: with the same implementation they break
// determinism.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reports/results.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::reports {

struct DriftLimits {
  double absolute = 0;
  double relative = 0.001;
};

struct VerdictChange {
  std::string id;
  judge::Verdict before = judge::Verdict::none;
  judge::Verdict after = judge::Verdict::none;
  std::string reason_before;
  std::string reason_after;
};

struct Drift {
  std::string id;
  std::string measurement;
  std::string unit;
  double before = 0;
  double after = 0;

  double absolute() const { return after - before; }
  double relative() const;  // of the former value; infinite when that is zero
};

struct FingerprintChange {
  std::string id;
  std::uint64_t seed = 0;
  std::uint64_t before = 0;
  std::uint64_t after = 0;
};

struct Difference {
  std::vector<VerdictChange> new_failures;
  std::vector<VerdictChange> fixed;
  std::vector<VerdictChange> changed;  // other changes of verdict or reason, both runs have the case
  std::vector<std::string> appeared;
  std::vector<std::string> disappeared;
  std::vector<Drift> drifts;
  std::vector<FingerprintChange> fingerprints;
  std::vector<std::string> identity;  // sentences: "the seed changed from 1 to 2"

  std::vector<std::string> incomplete;  // sentences: "the second run is incomplete: ..."

  bool is_empty() const;
};

Difference compare(const Run& before, const Run& after, const DriftLimits& limits = {});

std::string diff_text(const Difference& difference, const TextOptions& options = {});
std::string diff_json(const Difference& difference);

}  // namespace fieldproof::reports
