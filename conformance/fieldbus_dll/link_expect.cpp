#include "conformance/fieldbus_dll/link_expect.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::conformance {

void expect_silence(LinkBench& bench, CaseJudge& judge, std::string_view reason, std::string_view why) {
  const auto heard = bench.next();
  judge.expect(!heard.has_value(), reason,
               [&] { return Sighting{{fmt::format("silence: {}", why)}, heard->text(), heard->begin}; });
}

DrivenDlpdu expect_next(LinkBench& bench, CaseJudge& judge, kernel::Time limit, std::string_view reason,
                        std::string_view what) {
  auto next = bench.next(limit);
  judge.expect(next.has_value(), reason, what, "the station was silent");
  return *next;
}

DrivenDlpdu expect_next(LinkBench& bench, CaseJudge& judge, std::string_view reason, std::string_view what) {
  return expect_next(bench, judge, bench.now() + bench.patience(), reason, what);
}

void expect_begins(CaseJudge& judge, const DrivenDlpdu& dlpdu, kernel::Time earliest,
                   std::string_view reason_early, kernel::Time latest, std::string_view reason_late) {
  const auto sighting = [&] {
    return Sighting{{fmt::format("begins {} to {}", kernel::describe(earliest), kernel::describe(latest))},
                    fmt::format("{} at {}", dlpdu.text(), kernel::describe(dlpdu.begin)),
                    dlpdu.begin};
  };
  judge.expect(dlpdu.begin + kLinkRounding >= earliest, reason_early, sighting);
  judge.expect(dlpdu.begin <= latest + kLinkRounding, reason_late, sighting);
}

void judge_driven(const LinkBench& bench, CaseJudge& judge) {
  kernel::Time own_end = kernel::kStart;
  for (const DrivenDlpdu& one : bench.driven()) {
    const auto sighting = [&](std::string expected) {
      return Sighting{{std::move(expected)}, one.text(), one.begin};
    };
    judge.expect(one.is_well_formed, "frame_malformed", [&] {
      return sighting("preamble, start delimiter, whole octets, end delimiter, exact to the half bit");
    });
    judge.expect(one.has_right_check, "check_wrong", [&] { return sighting("a frame check that fits"); });
    kernel::Time silent_since = own_end;
    for (const LinkBench::Heard& heard : bench.heard()) {
      if (heard.end <= one.begin) silent_since = std::max(silent_since, heard.end);
    }
    const bool is_first = silent_since == kernel::kStart;
    judge.expect(is_first || one.begin - silent_since + kLinkRounding >= bench.least_gap(), "gap_too_short",
                 [&] {
                   return Sighting{{fmt::format("silence of V(MID), {}, in front of each DLPDU",
                                                kernel::describe(bench.least_gap()))},
                                   kernel::describe(one.begin - silent_since),
                                   one.begin};
                 });
    own_end = one.end;
  }
}

}  // namespace fieldproof::conformance
