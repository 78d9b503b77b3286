// What the nodes of the link say, also when it is not their turn.
#include <fmt/format.h>

#include <algorithm>

#include "conformance/fieldbus_dll/ff_expect.hpp"
#include "conformance/fieldbus_dll/ff_las_sequence_run.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

namespace {

constexpr FfAddress kUserOfLas = 0x1030;

}  // namespace

kernel::Time FfLasSequenceRun::say(const Octets& octets, std::int64_t later) {
  bench_.wait(bench_.least_gap() + bench_.octets(later));
  return bench_.send(octets);
}

bool FfLasSequenceRun::say_as(const SequenceCommand& command, const Octets& octets) {
  bench_.wait(bench_.least_gap() + bench_.octets(command.numbers.back()));
  const bool is_whole = send_link_command(bench_, octets, command);
  if (!is_whole) model_.hear_noise(bench_.now());
  return is_whole;
}

void FfLasSequenceRun::answer(const DrivenDlpdu& said) {
  const std::uint8_t node = said.octet(1);
  if (is_of(said, bench_.rules().codes.pn)) {
    if (joining_.erase(node) > 0) model_.hear_probe_response(say({bench_.rules().codes.pr, node}));
    return;
  }
  if (is_pt(bench_, said) && tokens_missed_[node] > 0) {
    --tokens_missed_[node];
    return;
  }
  if (const auto reply = bench_.returned(said)) model_.hear_answer(say(reply->octets));
}

void FfLasSequenceRun::refuse(const DrivenDlpdu&, const SequenceCommand& command) {
  const auto sr = static_cast<std::uint8_t>(bench_.rules().codes.sr | fieldbus_dll::kFinalBit);
  const auto reason = static_cast<std::uint8_t>(command.numbers[1]);
  if (!say_as(command, {sr, reason})) return;
  reason > 1 ? model_.hear_none(bench_.now()) : model_.hear_answer(bench_.now());
}

void FfLasSequenceRun::publish(const DrivenDlpdu& cd, const SequenceCommand& command) {
  const FfAddress address = static_cast<FfAddress>(cd.octet(1) << 8 | cd.octet(2));
  const Octets data = bench_.numbered_data(static_cast<std::size_t>(command.numbers[1]));
  if (say_as(command, bench_.dt3(address, data))) model_.hear_answer(bench_.now());
}

Octets FfLasSequenceRun::dt1_of(const DrivenDlpdu& pt, const Octets& data, bool is_final) const {
  return bench_.dt1(Priority::urgent, kUserOfLas, fieldbus_dll::address_of(pt.octet(1), 1), data, is_final);
}

void FfLasSequenceRun::use(const DrivenDlpdu& pt, const SequenceCommand& command) {
  const Octets data = bench_.numbered_data(static_cast<std::size_t>(command.numbers[0]));
  const bool is_final = command.numbers[1] == 1;
  const bool is_left_open = command.numbers[1] == 2;
  const Octets dt1 = dt1_of(pt, data, is_final);
  if (!is_in_token(pt, dt1.size(), command.numbers.back())) return return_token(pt);
  const bool is_whole = say_as(command, dt1);
  if (is_whole) data_.push_back(data);
  if (is_whole && is_final) return model_.hear_answer(bench_.now());
  if (is_whole) model_.hear_data(bench_.now());
  if (!is_final && !is_left_open) return_token(pt);
}

bool FfLasSequenceRun::is_in_token(const DrivenDlpdu& pt, std::size_t octets, std::int64_t later) const {
  const kernel::Time over = pt.end + bench_.octets(duration_in(pt));
  return bench_.now() + bench_.least_gap() + bench_.octets(later) + bench_.frame(octets) <= over;
}

void FfLasSequenceRun::return_token(const DrivenDlpdu& pt) {
  if (is_in_token(pt, 1)) model_.hear_answer(say({bench_.rules().codes.rt}));
}

void FfLasSequenceRun::spend(const DrivenDlpdu& pt) {
  // Silence, preamble, two delimiters, five octets of a DT1 and the frame check.
  const std::int64_t around =
      std::int64_t{bench_.link().inter_pdu_delay_octets} + bench_.link().preamble_octets + 2 + 5 + 2;
  const auto most = static_cast<std::int64_t>(bench_.link().most_data.at(2));
  std::int64_t left = duration_in(pt);
  bool is_returned = false;
  while (!is_returned) {
    const std::int64_t size = std::min(most, left - around);
    left -= size + around;
    is_returned = left < around + 2;
    const Octets data = bench_.numbered_data(static_cast<std::size_t>(size));
    const kernel::Time end = say(dt1_of(pt, data, is_returned));
    data_.push_back(data);
    is_returned ? model_.hear_answer(end) : model_.hear_data(end);
  }
}

void FfLasSequenceRun::ask_time(const DrivenDlpdu& pt, const SequenceCommand& command) {
  if (!say_as(command, {bench_.rules().codes.ct, pt.octet(1)})) return return_token(pt);
  model_.hear_time_request(bench_.now());
  const DrivenDlpdu said = next_said();
  is_of(said, bench_.rules().codes.td) ? return_token(pt) : answer(said);
}

void FfLasSequenceRun::submit(Priority priority, std::size_t size) {
  const Octets data = bench_.numbered_data(size);
  const bool is_taken = bench_.submit(priority, data);
  ++submitted_;
  const bool is_right = model_.submit(priority, data);
  judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
    return Mismatch{{fmt::format("data of {} octets is {}", size, is_right ? "taken" : "refused")},
                    is_taken ? "taken" : "refused"};
  });
}

void FfLasSequenceRun::write(FfAddress buffer, std::size_t size) {
  const Octets data = bench_.numbered_data(size);
  const bool is_taken = bench_.write(buffer, data);
  const bool is_right = model_.write(buffer, data, bench_.now());
  judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
    return Mismatch{{fmt::format("a buffer of {} octets is {}", size, is_right ? "taken" : "refused")},
                    is_taken ? "taken" : "refused"};
  });
}

void FfLasSequenceRun::overstay(const DrivenDlpdu& pt, std::int64_t later) {
  const kernel::Time over = pt.end + bench_.octets(duration_in(pt));
  const kernel::Time last = over + bench_.slot() + bench_.octets(later);
  const std::size_t most = bench_.link().most_data.at(0);
  const Octets none = data_of(pt, {});
  const kernel::Duration around = bench_.least_gap() + bench_.frame(none.size());
  if (pt.end + bench_.least_gap() + bench_.slot() >= over) return return_token(pt);
  bool is_over = false;
  while (!is_over) {
    const std::int64_t left = (last - bench_.now() - around) / bench_.octets(1);
    const auto room = static_cast<std::size_t>(std::max<std::int64_t>(0, left)) + 1;
    is_over = room <= most;
    const Octets data = bench_.numbered_data(is_over ? room : std::min(room / 2, most));
    data_.push_back(data);
    model_.hear_data(say(data_of(pt, data)));
  }
  const kernel::Time free = bench_.now() + bench_.least_gap() + bench_.octets(1);
  const DrivenDlpdu one = next_said();
  const auto& codes = bench_.rules().codes;
  // Nothing else may have had time, and a TD have become due later.
  const bool may_wait =
      is_cd(bench_, one) || is_of(one, codes.idle) || is_of(one, codes.dt3) || is_of(one, codes.td);
  judge_.expect(may_wait || one.begin <= free, "holder_not_stopped", [&] {
    return Mismatch{{"the token is taken back as soon as the line is free"}, one.text(), one.begin};
  });
  answer(one);
}

Octets FfLasSequenceRun::data_of(const DrivenDlpdu& pt, const Octets& data) const {
  return bench_.dt1(Priority::time_available, kUserOfLas, fieldbus_dll::address_of(pt.octet(1), 1), data);
}

void FfLasSequenceRun::usurp(bool probe, std::int64_t later) {
  const auto& codes = bench_.rules().codes;
  const auto asked = next_that([&](const DrivenDlpdu& one) {
    return probe ? is_of(one, codes.pn) : is_pt(bench_, one) && tokens_missed_[one.octet(1)] == 0;
  });
  if (!asked) return;
  const auto another = static_cast<std::uint8_t>(asked->octet(1) + 1);
  const Octets said = probe ? Octets{codes.pr, another}
                            : bench_.dt1(Priority::urgent, FfBench::kPeersAddress,
                                         fieldbus_dll::address_of(another, 1), bench_.numbered_data(4), true);
  const kernel::Time end = say(said, later);
  // A PR of another is no answer; a token counts as used, and does not come back.
  probe ? model_.hear_none(end) : model_.hear_data(end);
}

void FfLasSequenceRun::interrupt(std::int64_t later) {
  const auto asked = next_that([&](const DrivenDlpdu& one) { return is_cd(bench_, one); });
  if (!asked) return;
  const auto another = static_cast<std::uint8_t>(asked->octet(1) + 1);
  model_.hear_data(say(bench_.dt1(Priority::urgent, FfBench::kPeersAddress,
                                  fieldbus_dll::address_of(another, 1), bench_.numbered_data(4)),
                       later));
}

}  // namespace fieldproof::conformance
