// Arbitrary results for property tests: any octets in any text, any number in any field. Text stands for what
// an implementation under test may say, so it is rich in what formats choke on: control characters, quotes,
// markup, broken UTF-8, terminal sequences.
#pragma once

#include <rapidcheck.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "harness/judge/finding.hpp"
#include "harness/kernel/arbitrary_text.hpp"

namespace fieldproof::judge {

inline rc::Gen<double> arbitrary_number() {
  return rc::gen::oneOf(
      rc::gen::arbitrary<double>(),
      rc::gen::element(0.0, -0.0, 755.0, 0.1, 1e-308, 4.9e-324, 1.7976931348623157e308,
                       std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::quiet_NaN()));
}

inline rc::Gen<std::uint64_t> arbitrary_word() {
  return rc::gen::oneOf(rc::gen::arbitrary<std::uint64_t>(),
                        rc::gen::element<std::uint64_t>(0, 1, std::uint64_t{1} << 53U, ~std::uint64_t{0}));
}

inline rc::Gen<Verdict> arbitrary_verdict() {
  return rc::gen::element(Verdict::none, Verdict::not_applicable, Verdict::pass, Verdict::warn,
                          Verdict::inconclusive, Verdict::fail, Verdict::error);
}

inline rc::Gen<Reference> arbitrary_reference() {
  return rc::gen::build<Reference>(
      rc::gen::set(&Reference::source, kernel::arbitrary_text()),
      rc::gen::set(&Reference::clause, kernel::arbitrary_text()),
      rc::gen::set(&Reference::standing,
                   rc::gen::element(Standing::seed, Standing::sure, Standing::searched, Standing::calc,
                                    Standing::derived, Standing::memory, Standing::own)));
}

inline rc::Gen<Finding> arbitrary_finding() {
  const auto texts = rc::gen::container<std::vector<std::string>>(kernel::arbitrary_text());
  const auto time = rc::gen::map(rc::gen::arbitrary<std::int64_t>(),
                                 [](std::int64_t ps) { return kernel::Time{kernel::Duration{ps}}; });
  return rc::gen::build<Finding>(
      rc::gen::set(&Finding::verdict, arbitrary_verdict()),
      rc::gen::set(&Finding::reason, kernel::arbitrary_text()),
      rc::gen::set(&Finding::requirement, kernel::arbitrary_text()),
      rc::gen::set(&Finding::reference, arbitrary_reference()), rc::gen::set(&Finding::expected, texts),
      rc::gen::set(&Finding::actual, kernel::arbitrary_text()), rc::gen::set(&Finding::time, time),
      rc::gen::set(&Finding::step, kernel::arbitrary_text()),
      rc::gen::set(&Finding::first_difference, kernel::arbitrary_text()),
      rc::gen::set(&Finding::decisive, texts), rc::gen::set(&Finding::decode, texts));
}

inline rc::Gen<Measurement> arbitrary_measurement() {
  return rc::gen::build<Measurement>(rc::gen::set(&Measurement::name, kernel::arbitrary_text()),
                                     rc::gen::set(&Measurement::unit, kernel::arbitrary_text()),
                                     rc::gen::set(&Measurement::value, arbitrary_number()),
                                     rc::gen::set(&Measurement::low, arbitrary_number()),
                                     rc::gen::set(&Measurement::high, arbitrary_number()));
}

inline rc::Gen<CaseResult> arbitrary_result() {
  const auto duration =
      rc::gen::map(rc::gen::arbitrary<std::int64_t>(), [](std::int64_t ps) { return kernel::Duration{ps}; });
  return rc::gen::scale(
      0.3,
      rc::gen::build<CaseResult>(
          rc::gen::set(&CaseResult::id, kernel::arbitrary_text()),
          rc::gen::set(&CaseResult::verdict, arbitrary_verdict()),
          rc::gen::set(&CaseResult::reason, kernel::arbitrary_text()),
          rc::gen::set(&CaseResult::requirement, kernel::arbitrary_text()),
          rc::gen::set(&CaseResult::reference, arbitrary_reference()),
          rc::gen::set(&CaseResult::findings, rc::gen::container<std::vector<Finding>>(arbitrary_finding())),
          rc::gen::set(&CaseResult::measurements,
                       rc::gen::container<std::vector<Measurement>>(arbitrary_measurement())),
          rc::gen::set(&CaseResult::settings,
                       rc::gen::container<std::vector<std::string>>(kernel::arbitrary_text())),
          rc::gen::set(&CaseResult::planned_hits,
                       rc::gen::container<std::vector<std::uint64_t>>(arbitrary_word())),
          rc::gen::set(&CaseResult::seed, arbitrary_word()),
          rc::gen::set(&CaseResult::fingerprint, arbitrary_word()),
          rc::gen::set(&CaseResult::virtual_time, duration),
          rc::gen::set(&CaseResult::wall_time_us, arbitrary_word()),
          rc::gen::set(&CaseResult::log, kernel::arbitrary_text()),
          rc::gen::set(&CaseResult::purpose, kernel::arbitrary_text()),
          rc::gen::set(&CaseResult::expected_because, kernel::arbitrary_text())));
}

}  // namespace fieldproof::judge
