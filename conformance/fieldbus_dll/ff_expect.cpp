#include "conformance/fieldbus_dll/ff_expect.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::kFinalBit;
using fieldbus_dll::kPriorityBits;
using fieldbus_dll::Priority;

constexpr unsigned kLongBit = 0x08;

bool has_code(const DrivenDlpdu& dlpdu, std::uint8_t code, unsigned free_bits) {
  return !dlpdu.octets.empty() && (dlpdu.octet(0) & ~free_bits) == code;
}

std::size_t octets_of_address(const DrivenDlpdu& dlpdu) {
  return (dlpdu.octet(0) & kLongBit) != 0 ? 4 : 2;
}

fieldbus_dll::FfAddress address_at(const DrivenDlpdu& dlpdu, std::size_t first) {
  fieldbus_dll::FfAddress one = 0;
  for (std::size_t n = 0; n < octets_of_address(dlpdu); ++n) one = one << 8 | dlpdu.octet(first + n);
  return one;
}

Octets behind(const DrivenDlpdu& dlpdu, std::size_t header) {
  if (dlpdu.octets.size() <= header) return {};
  return {dlpdu.octets.begin() + static_cast<std::ptrdiff_t>(header), dlpdu.octets.end()};
}

}  // namespace

bool is_pt(const FfBench& bench, const DrivenDlpdu& dlpdu) {
  const bool has_priority = (dlpdu.octet(0) & kPriorityBits) != 0;
  return has_priority && has_code(dlpdu, bench.rules().codes.pt, kFinalBit | kPriorityBits);
}

bool is_cd(const FfBench& bench, const DrivenDlpdu& dlpdu) {
  return has_code(dlpdu, bench.rules().codes.cd, kLongBit | kFinalBit | kPriorityBits);
}

bool is_dt1(const FfBench& bench, const DrivenDlpdu& dlpdu) {
  return has_code(dlpdu, bench.rules().codes.dt1, kLongBit | kFinalBit | kPriorityBits);
}

bool is_dt3(const FfBench& bench, const DrivenDlpdu& dlpdu) {
  return has_code(dlpdu, bench.rules().codes.dt3, kLongBit | kFinalBit | kPriorityBits);
}

bool is_of(const DrivenDlpdu& dlpdu, std::uint8_t code) {
  return has_code(dlpdu, code, 0);
}

bool has_final_use(const DrivenDlpdu& dlpdu) {
  return (dlpdu.octet(0) & kFinalBit) != 0;
}

Priority priority_in(const DrivenDlpdu& dlpdu) {
  return static_cast<Priority>(dlpdu.octet(0) & kPriorityBits);
}

unsigned duration_in(const DrivenDlpdu& pt) {
  return static_cast<unsigned>(pt.octet(2) << 8 | pt.octet(3));
}

AddressesOfDt1 addresses_in(const DrivenDlpdu& dt1) {
  const std::size_t size = octets_of_address(dt1);
  return {address_at(dt1, 1), address_at(dt1, 1 + size)};
}

Octets dlsdu_of(const DrivenDlpdu& dt1) {
  return behind(dt1, 1 + 2 * octets_of_address(dt1));
}

BufferOfDt3 buffer_in(const DrivenDlpdu& dt3) {
  const std::size_t size = octets_of_address(dt3);
  return {address_at(dt3, 1), dt3.octet(1 + size), behind(dt3, 2 + size)};
}

std::vector<DrivenDlpdu> expect_token_used(FfBench& bench, CaseJudge& judge, kernel::Time from) {
  const auto& codes = bench.rules().codes;
  std::vector<DrivenDlpdu> data;
  bool is_returned = false;
  kernel::Time since = from;
  for (const DrivenDlpdu& one : bench.listen()) {
    judge.expect(!is_returned, "token_returned_twice",
                 [&] { return Mismatch{{"silence: the token has been returned"}, one.text(), one.begin}; });
    expect_begins(judge, one, since, "answers_too_early", since + bench.response_delay(), "answers_too_late");
    since = one.end;
    const bool is_data = is_dt1(bench, one);
    judge.expect(is_data || is_of(one, codes.rt) || is_of(one, codes.ri), "unexpected_dlpdu",
                 [&] { return Mismatch{{"DT1, RI or RT"}, one.text(), one.begin}; });
    if (is_data) data.push_back(one);
    is_returned = is_of(one, codes.rt) || (is_data && has_final_use(one));
  }
  judge.expect(is_returned, "token_not_returned", "the token is returned, by RT or by F", "it was kept");
  return data;
}

void expect_serves(FfBench& bench, CaseJudge& judge) {
  const Octets data = bench.numbered_data(6);
  const bool is_submitted = bench.submit(Priority::urgent, data);
  expect_recovers(bench, judge, is_submitted, bench.pt(Priority::time_available, 5'000), dlsdu_of, data);
}

}  // namespace fieldproof::conformance
