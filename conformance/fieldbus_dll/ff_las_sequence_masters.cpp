// What the other link masters say: they take the link over, hand it on, and tell of it.
#include <fmt/format.h>

#include <algorithm>

#include "conformance/fieldbus_dll/ff_expect.hpp"
#include "conformance/fieldbus_dll/ff_las_sequence_run.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

void FfLasSequenceRun::displace_by(const std::function<Octets()>& octets) {
  if (!next_that([&](const DrivenDlpdu& one) {
        return is_pt(bench_, one) || is_cd(bench_, one) || is_of(one, bench_.rules().codes.pn);
      }))
    return;
  bench_.wait(bench_.least_gap());
  say_as_scheduler(octets());
}

void FfLasSequenceRun::displace() {
  if (model_.is_scheduler()) displace_by([&] { return Octets{bench_.rules().codes.cl, kSecondOfLas}; });
}

void FfLasSequenceRun::say_as_scheduler(const Octets& octets) {
  bench_.send(octets);
  model_.hear_scheduler(octets, bench_.now());
  if (!model_.owes_answer()) return;
  if (!bench_.next_begins(bench_.now() + bench_.response_delay() + kLinkRounding))
    judge_.fail("not_a_device", {{"an answer: another scheduler asks it"}, "silence", bench_.now()});
  const DrivenDlpdu one = *bench_.next();
  object(model_.say(one), one.text(), one.begin);
}

void FfLasSequenceRun::wait_in_standby(std::int64_t parts) {
  const kernel::Duration claim = model_.claim_silence() - bench_.octets(bench_.rules().claim_delay_octets);
  const kernel::Duration wanted =
      parts == kPartsOfClaim ? claim - bench_.octets(1) : claim * parts / kPartsOfClaim;
  const kernel::Time until = bench_.now() + std::max(bench_.least_gap(), wanted);
  if (!bench_.next_begins(until)) return bench_.run_until(until);
  const DrivenDlpdu one = *bench_.next();
  object(model_.say(one), one.text(), one.begin);
  answer(one);
}

void FfLasSequenceRun::pass_none(std::uint8_t node) {
  bench_.wait(bench_.least_gap());
  model_.hear_none(bench_.send({bench_.control(bench_.rules().codes.pt, Priority::normal), node, 0, 0}));
}

void FfLasSequenceRun::second(const SequenceCommand& command) {
  const auto kind = static_cast<OtherScheduler>(command.numbers[0]);
  if (model_.is_scheduler() && kind == OtherScheduler::passes_none) {
    if (next_that([&](const DrivenDlpdu& one) { return is_cd(bench_, one); }))
      pass_none(kNodesOfLas.at(static_cast<std::size_t>(command.numbers[1])));
    return;
  }
  if (model_.is_scheduler() && kind != OtherScheduler::idles)
    return displace_by([&] { return of_scheduler(kind, command.numbers); });
  displace();
  wait_in_standby(command.numbers[3]);
  if (!model_.is_scheduler()) say_as_scheduler(of_scheduler(kind, command.numbers));
}

Octets FfLasSequenceRun::of_scheduler(OtherScheduler kind, const std::vector<std::int64_t>& numbers) const {
  const auto& codes = bench_.rules().codes;
  const std::uint8_t node = kNodesOfLas.at(static_cast<std::size_t>(numbers[1]));
  switch (kind) {
    case OtherScheduler::claims:
      return {codes.cl, kSecondOfLas};
    case OtherScheduler::passes:
      return {bench_.control(codes.pt, Priority::normal), node, 0, kGrantOfSecond};
    case OtherScheduler::probes:
      return {codes.pn, node};
    case OtherScheduler::probes_this:
      return {codes.pn, bench_.node()};
    case OtherScheduler::compels:
      return bench_.cd(kItemsOfLas[0]);
    case OtherScheduler::tells_time:
      return time_of_second(numbers[2]);
    case OtherScheduler::idles:
      return {codes.idle};
    case OtherScheduler::passes_none:
      return {bench_.control(codes.pt, Priority::normal), node, 0, 0};
    case OtherScheduler::compels_this:
      return bench_.cd(kOwnBuffersOfLas[node % 2]);
  }
  return {};
}

Octets FfLasSequenceRun::time_of_second(std::int64_t jump) const {
  constexpr std::size_t kTimeOctets = 6;
  Octets td{bench_.rules().codes.td};
  const kernel::Time end = bench_.now() + bench_.frame(1 + kTimeOctets);
  const std::uint64_t ticks = model_.ticks_at(end) + static_cast<std::uint64_t>(jump);
  for (std::size_t n = kTimeOctets; n-- > 0;) td.push_back(static_cast<std::uint8_t>(ticks >> (8 * n)));
  return td;
}

void FfLasSequenceRun::told(std::int64_t nodes, std::int64_t parts) {
  displace();
  wait_in_standby(parts);
  if (model_.is_scheduler()) return;
  std::vector<bool> live(fieldbus_dll::kNodeNumbers);
  for (std::size_t n = 0; n < kNodesOfLas.size(); ++n) live[kNodesOfLas.at(n)] = (nodes >> n & 1) != 0;
  constexpr std::uint8_t kRevision = 9;
  say_as_scheduler(bench_.dt1(Priority::normal, fieldbus_dll::kEverybody,
                              fieldbus_dll::address_of(kSecondOfLas),
                              fieldbus_dll::live_list_spdu(kRevision, live)));
}

void FfLasSequenceRun::make_noise(std::int64_t octets, std::int64_t parts) {
  displace();
  wait_in_standby(parts);
  if (model_.is_scheduler()) return;
  send_noise(bench_, octets);
  model_.hear_noise(bench_.now());
}

void FfLasSequenceRun::hand(const SequenceCommand& command) {
  displace();
  wait_in_standby(command.numbers[2]);
  if (model_.is_scheduler()) return;
  const auto version =
      static_cast<std::uint16_t>(bench_.configuration().schedule.version + command.numbers[1]);
  const Octets tl{bench_.rules().codes.tl, command.numbers[0] != 0 ? kSecondOfLas : bench_.node(),
                  static_cast<std::uint8_t>(version >> 8), static_cast<std::uint8_t>(version)};
  const bool is_whole = send_link_command(bench_, tl, command);
  is_whole ? model_.hear_scheduler(tl, bench_.now()) : model_.hear_noise(bench_.now());
}

void FfLasSequenceRun::order(std::uint8_t heir, HeirSends sends) {
  if (!model_.is_scheduler() && sends != HeirSends::not_awaited) answer(next_said());
  judge_.expect(bench_.order_transfer(heir), "order_refused", "a link master takes the order",
                "it is refused");
  model_.order_transfer(heir, bench_.now());
  if (sends == HeirSends::not_awaited) return;
  const auto tl = next_that([&](const DrivenDlpdu& one) { return is_of(one, bench_.rules().codes.tl); });
  if (!tl) judge_.fail("not_transferred", {{fmt::format("a TL for {:02X}", heir)}, "none", bench_.now()});
  if (sends == HeirSends::nothing) return;
  bench_.wait(bench_.least_gap());
  const auto& codes = bench_.rules().codes;
  if (sends == HeirSends::token_back) return say_as_scheduler({codes.rt});
  say_as_scheduler({codes.pn, sends == HeirSends::probe ? kSecondOfLas : bench_.node()});
}

}  // namespace fieldproof::conformance
