#include "conformance/fieldbus_dll/link_expect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace fieldproof::conformance {

void expect_silence(LinkBench& bench, CaseJudge& judge, std::string_view reason, std::string_view why) {
  const auto heard = bench.next();
  judge.expect(!heard.has_value(), reason,
               [&] { return Mismatch{{fmt::format("silence: {}", why)}, heard->text(), heard->begin}; });
}

DrivenDlpdu expect_next(LinkBench& bench, CaseJudge& judge, kernel::Time limit, std::string_view reason,
                        std::string_view what) {
  auto next = bench.next(limit);
  judge.expect(next.has_value(), reason, what, "the station was silent");
  return *next;
}

DrivenDlpdu expect_next(LinkBench& bench, CaseJudge& judge, std::string_view reason, std::string_view what) {
  return expect_next(bench, judge, bench.now() + bench.observation_timeout(), reason, what);
}

void expect_begins(CaseJudge& judge, const DrivenDlpdu& dlpdu, kernel::Time earliest,
                   std::string_view reason_early, kernel::Time latest, std::string_view reason_late) {
  const auto sighting = [&] {
    return Mismatch{{fmt::format("begins {} to {}", kernel::describe(earliest), kernel::describe(latest))},
                    fmt::format("{} at {}", dlpdu.text(), kernel::describe(dlpdu.begin)),
                    dlpdu.begin};
  };
  judge.expect(dlpdu.begin + kLinkRounding >= earliest, reason_early, sighting);
  judge.expect(dlpdu.begin <= latest + kLinkRounding, reason_late, sighting);
}

void expect_dlsdus(CaseJudge& judge, const std::vector<DrivenDlpdu>& data, DlsduOf dlsdu_of,
                   const std::vector<Octets>& right, const DlsduReasons& reasons) {
  judge.expect(data.size() >= right.size(), reasons.missing, [&] {
    return Mismatch{{fmt::format("{} data DLPDUs", right.size())}, fmt::format("{}", data.size())};
  });
  judge.expect(data.size() <= right.size(), reasons.more, [&] {
    const DrivenDlpdu& first = data[right.size()];
    return Mismatch{{fmt::format("{} data DLPDUs", right.size())},
                    fmt::format("{}, the first one too many: {}", data.size(), first.text()),
                    first.begin};
  });
  for (std::size_t n = 0; n < right.size(); ++n) {
    judge.expect(dlsdu_of(data[n]) == right[n], reasons.others, [&] {
      return Mismatch{{fmt::format("DLSDU {:02X}", fmt::join(right[n], " "))},
                      data[n].text(),
                      data[n].begin,
                      fmt::format("data DLPDU {}", n + 1)};
    });
  }
}

void expect_recovers(LinkBench& bench, CaseJudge& judge, bool is_submitted, const Octets& token,
                     DlsduOf dlsdu_of, const Octets& right) {
  judge.expect(is_submitted, "does_not_recover", "data is accepted", "it was refused");
  bench.send(token);
  const std::vector<DrivenDlpdu> all = bench.listen();
  const bool is_served =
      std::ranges::any_of(all, [&](const DrivenDlpdu& one) { return dlsdu_of(one) == right; });
  judge.expect(is_served, "does_not_recover", [&] {
    return Mismatch{{"under a long token, all that was submitted"},
                    all.empty() ? std::string("silence") : all.front().text()};
  });
}

void judge_driven(const LinkBench& bench, CaseJudge& judge) {
  // Both are in the order of their ends, and in an hour of a busy link there are millions.
  const std::span heard = bench.heard();
  std::size_t next_heard = 0;
  kernel::Time heard_until = kernel::kStart;
  kernel::Time own_end = kernel::kStart;
  for (const DrivenDlpdu& one : bench.driven()) {
    const auto sighting = [&](std::string expected) {
      return Mismatch{{std::move(expected)}, one.text(), one.begin};
    };
    judge.expect(one.is_well_formed, "frame_malformed", [&] {
      return sighting("preamble, start delimiter, whole octets, end delimiter, exact to the half bit");
    });
    judge.expect(one.has_right_check, "check_wrong", [&] { return sighting("a frame check that fits"); });
    for (; next_heard < heard.size() && heard[next_heard].end <= one.begin; ++next_heard)
      heard_until = std::max(heard_until, heard[next_heard].end);
    const bool is_over_another =
        next_heard < heard.size() && heard[next_heard].begin < one.begin && one.begin < heard[next_heard].end;
    judge.expect(!is_over_another, "gap_too_short",
                 [&] { return sighting("silence of V(MID): another is on the line"); });
    const kernel::Time silent_since = std::max(own_end, heard_until);
    const bool is_first = silent_since == kernel::kStart;
    judge.expect(is_first || one.begin - silent_since + kLinkRounding >= bench.least_gap(), "gap_too_short",
                 [&] {
                   return Mismatch{{fmt::format("silence of V(MID), {}, in front of each DLPDU",
                                                kernel::describe(bench.least_gap()))},
                                   kernel::describe(one.begin - silent_since),
                                   one.begin};
                 });
    own_end = one.end;
  }
}

}  // namespace fieldproof::conformance
