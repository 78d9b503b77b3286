#include "conformance/fieldbus_dll/isa_expect.hpp"

#include <fmt/format.h>

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::Priority;

constexpr unsigned kTypeBits = 0xF0;
constexpr unsigned kFinalBit = 0x04;
constexpr unsigned kPriorityBits = 0x03;
constexpr std::size_t kEeOctets = 4;

void expect_ends_right(const IsaBench& bench, CaseJudge& judge, const DrivenDlpdu& end) {
  const bool is_right = end.octets.size() == kEeOctets && end.octet(0) == bench.ee(0)[0] &&
                        end.octet(1) == IsaBench::kScheduler && end.octet(2) == bench.address();
  judge.expect(is_right, "dlpdu_wrong", [&] {
    return Mismatch{{fmt::format("EE: {:02X} {:02X} {:02X} and a reason", bench.ee(0)[0],
                                 IsaBench::kScheduler, bench.address())},
                    end.text(),
                    end.begin};
  });
}

}  // namespace

bool is_type(const DrivenDlpdu& dlpdu, std::uint8_t code) {
  return !dlpdu.octets.empty() && (dlpdu.octet(0) & kTypeBits) == code;
}

Priority priority_of(const DrivenDlpdu& dlpdu) {
  return static_cast<Priority>(dlpdu.octet(0) & kPriorityBits);
}

bool is_final(const DrivenDlpdu& dlpdu) {
  return (dlpdu.octet(0) & kFinalBit) != 0;
}

Octets dlsdu_in(const DrivenDlpdu& dlpdu) {
  return dlpdu.rest();
}

Octets expect_submitted(IsaBench& bench, CaseJudge& judge, fieldbus_dll::IsaService service,
                        Priority priority, std::size_t size) {
  const Octets data = bench.numbered_data(size);
  judge.expect(bench.submit(service, priority, data), "data_refused", "data is accepted", "it was refused");
  return data;
}

TokenUse expect_token_use(IsaBench& bench, CaseJudge& judge, kernel::Time from) {
  const auto& codes = bench.rules().codes;
  TokenUse use;
  bool has_ended = false;
  kernel::Time since = from;
  for (const DrivenDlpdu& one : bench.listen()) {
    judge.expect(!has_ended, "talks_behind_end",
                 [&] { return Mismatch{{"silence after the EE"}, one.text(), one.begin}; });
    expect_begins(judge, one, since, "answers_too_early", since + bench.reply_wait(), "answers_too_late");
    since = one.end;
    if (is_type(one, codes.ee)) {
      expect_ends_right(bench, judge, one);
      use.end = one;
      has_ended = true;
      continue;
    }
    judge.expect(is_type(one, codes.du), "unexpected_dlpdu",
                 [&] { return Mismatch{{"DU or EE"}, one.text(), one.begin}; });
    use.data.push_back(one);
  }
  judge.expect(has_ended, "token_not_returned", "the token is returned by an EE", "no EE came");
  return use;
}

void expect_end_reason(CaseJudge& judge, const TokenUse& use, EndReason reason) {
  judge.expect(use.end.octet(3) == static_cast<std::uint8_t>(reason), "end_reason_wrong", [&] {
    return Mismatch{
        {fmt::format("EE with reason {}", static_cast<unsigned>(reason))}, use.end.text(), use.end.begin};
  });
}

void expect_serves(IsaBench& bench, CaseJudge& judge) {
  const Octets data = bench.numbered_data(6);
  const bool is_submitted = bench.submit_unit_data(Priority::urgent, data);
  expect_recovers(bench, judge, is_submitted, bench.es(Priority::time_available, 5'000), dlsdu_in, data);
}

}  // namespace fieldproof::conformance
