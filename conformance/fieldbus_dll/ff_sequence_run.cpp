#include "conformance/fieldbus_dll/ff_sequence_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conformance/fieldbus_dll/ff_vocabulary.hpp"
#include "conformance/fieldbus_dll/link_scene.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"

namespace fieldproof::conformance {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

void FfSequenceRun::run(const Sequence& sequence) {
  for (const SequenceCommand& command : sequence.commands) execute(command);
  await_response_window();
}

void FfSequenceRun::execute(const SequenceCommand& command) {
  keep_active();
  const auto word = static_cast<FfWord>(command.word);
  switch (word) {
    case FfWord::wait:
      await_response_window();
      return bench_.wait(bench_.octets(command.numbers[0]));
    case FfWord::one:
      if (const auto one = bench_.next()) return judge_one(*one);
      return await_response_window();
    case FfWord::supply:
      return switch_supply(command.numbers[0], bench_, model_);
    case FfWord::submit:
      return submit(command.numbers);
    case FfWord::write:
      return write(command.numbers);
    case FfWord::noise:
      send_noise(bench_, command.numbers[0]);
      model_.hear_noise(bench_.now());
      return settle(command.numbers.back());
    case FfWord::framed:
      return send_framed_data(command.numbers);
    case FfWord::checked:
      bench_.send_half_bits(half_bits_with_other_check(bench_.pt(Priority::time_available, kDuration),
                                                       static_cast<unsigned>(command.numbers[0])));
      model_.hear_noise(bench_.now());
      return settle(command.numbers.back());
    case FfWord::ended:
      return end_before_it_begins(command.numbers);
    case FfWord::busy:
      return answer_beside_its_end(command.numbers);
    case FfWord::room:
      return leave_room(command.numbers);
    case FfWord::many:
      for (std::int64_t n = 0; n < command.numbers[0]; ++n) send(words_.octets_of(FfWord::probe, {1, 0}));
      send(words_.octets_of(FfWord::probe, {0, 0}));
      return await_response_window();
    case FfWord::ask:
      return ask_for_nothing(command.numbers);
    case FfWord::beside:
      return submit_beside(command.numbers);
    case FfWord::idle:
      await_response_window();
      return bench_.wait(command.numbers[0] * kMinute);
    case FfWord::received:
    case FfWord::in_front:
      return send_by_line(word, command.numbers);
    case FfWord::within:
      return send_within(command.numbers[0]);
    case FfWord::meanwhile:
      return ask_meanwhile(command.numbers);
    default:
      break;
  }
  const Octets octets = words_.octets_of(word, command.numbers);
  if (send_link_command(bench_, octets, command)) {
    model_.hear(octets, bench_.now());
  } else {
    model_.hear_noise(bench_.now());
  }
  settle(command.numbers.back());
}

void FfSequenceRun::send_framed_data(const std::vector<std::int64_t>& numbers) {
  const std::vector<Octets> heard =
      send_framed(bench_, numbers[0], words_.user_data(numbers[0] == kTwoOfThem ? kToUser : kToAnother),
                  words_.user_data(kToUser));
  for (const Octets& dlpdu : heard) model_.hear(dlpdu, bench_.now());
  if (heard.empty()) model_.hear_noise(bench_.now());
  settle(numbers.back());
}

void FfSequenceRun::send_by_line(FfWord word, const std::vector<std::int64_t>& numbers) {
  constexpr std::int64_t kLong = 200;
  const Octets octets = words_.user_data(kToUser, word == FfWord::received ? kLong : FfWords::kUsualSize);
  if (word == FfWord::received) {
    send_received(bench_, octets, numbers[0]);
  } else {
    send_in_front(bench_, octets, numbers[0], numbers[1]);
  }
  model_.hear(octets, bench_.now());
  settle(numbers.back());
}

void FfSequenceRun::keep_active() {
  constexpr std::int64_t kSilentOctets = 150;
  if (!bench_.is_link_master()) return;
  kernel::Time silent_since{};
  if (!bench_.heard().empty()) silent_since = bench_.heard().back().end;
  if (!bench_.driven().empty()) silent_since = std::max(silent_since, bench_.driven().back().end);
  if (bench_.now() > silent_since + bench_.octets(kSilentOctets)) send({bench_.rules().codes.idle});
}

void FfSequenceRun::send(const Octets& octets) {
  bench_.send(octets);
  model_.hear(octets, bench_.now());
}

Octets FfSequenceRun::asked(std::int64_t what) {
  constexpr std::int64_t kUrgency = 2;
  if (what == 0) return words_.octets_of(FfWord::token, {0, kUrgency, kDuration, 0, 0});
  if (what == 1) return words_.octets_of(FfWord::compel, {0, kUrgency, 0, 0});
  return words_.octets_of(FfWord::probe, {0, 0});
}

kernel::Duration FfSequenceRun::quarters_of_a_bit(std::int64_t count) const {
  return bench_.octets(count) / 32;
}

void FfSequenceRun::end_before_it_begins(const std::vector<std::int64_t>& numbers) {
  await_response_window();
  send(asked(numbers[0]));
  send(words_.octets_of(FfWord::other, {numbers[1], numbers[2], 0}));
  await_response_window();
}

void FfSequenceRun::keep_busy_until(kernel::Time until, DlpduIsNone kind) {
  if (keep_busy(bench_, until - bench_.least_gap(), kind)) model_.hear_noise(bench_.now());
  await_response_window();
}

void FfSequenceRun::answer_beside_its_end(const std::vector<std::int64_t>& numbers) {
  await_response_window();
  send(asked(numbers[0]));
  await_response_window();
  send(asked(numbers[0]));
  keep_busy_until(bench_.now() + bench_.response_delay() + quarters_of_a_bit(numbers[1]),
                  numbers[2] != 0 ? DlpduIsNone::by_its_check : DlpduIsNone::by_its_first_octet);
}

void FfSequenceRun::leave_room(const std::vector<std::int64_t>& numbers) {
  constexpr std::int64_t kToPeer = 0;
  constexpr std::int64_t kUrgent = 3;
  constexpr std::int64_t kSize = 8;
  constexpr std::size_t kDt1Octets = 13;
  await_response_window();
  if (numbers[0] != 0) submit({kUrgent, kToPeer, kSize, 1});
  send(asked(0));
  const kernel::Time over = bench_.now() + bench_.octets(kDuration);
  keep_busy_until(over - bench_.frame(numbers[0] != 0 ? kDt1Octets : 1) + quarters_of_a_bit(numbers[1]),
                  DlpduIsNone::by_its_check);
}

void FfSequenceRun::settle(std::int64_t silence) {
  if (silence >= bench_.link().inter_pdu_delay_octets || silence == kLinkSettles)
    return await_response_window();
  bench_.wait(bench_.octets(silence));
  judge_said();
}

void FfSequenceRun::submit(const std::vector<std::int64_t>& numbers) {
  for (std::int64_t n = 0; n < numbers[3] && model_.has_supply(); ++n) {
    const fieldbus_dll::FfRequest request{static_cast<Priority>(numbers[0]), words_.destination(numbers[1]),
                                          bench_.numbered_data(static_cast<std::size_t>(numbers[2]))};
    judge_taken(bench_.submit(request.priority, request.data, request.destination), model_.submit(request),
                request.data);
  }
}

void FfSequenceRun::ask_for_nothing(const std::vector<std::int64_t>& numbers) {
  constexpr std::int64_t kLessThanAnAddress = 3;
  if (!model_.has_supply()) return;
  Octets request{static_cast<std::uint8_t>(numbers[0])};
  const bool is_cut = numbers[0] != 0 && numbers[0] < kOrderOfAMaster;
  request.resize(1 + static_cast<std::size_t>(is_cut ? std::min(numbers[1], kLessThanAnAddress) : numbers[1]),
                 0x02);
  const bool is_order = numbers[0] == kOrderOfAMaster;
  const bool is_taken = is_order ? bench_.order_transfer(FfBench::kPeer) : bench_.ask_user_request(request);
  judge_.expect(!is_taken, "unknown_request_taken", "a request that a device does not know is refused",
                "it was taken");
}

void FfSequenceRun::submit_beside(const std::vector<std::int64_t>& numbers) {
  await_response_window();
  send(asked(0));
  if (bench_.next_begins(bench_.now() + bench_.observation_timeout()) && model_.has_supply()) {
    bench_.wait(bench_.octets(2));
    const fieldbus_dll::FfRequest request{static_cast<Priority>(numbers[0]), words_.destination(0),
                                          bench_.numbered_data(static_cast<std::size_t>(numbers[1]))};
    const bool is_taken = bench_.submit(request.priority, request.data, request.destination);
    judge_one(*bench_.next());
    judge_taken(is_taken, model_.submit(request), request.data);
  }
  await_response_window();
  send(asked(0));
  await_response_window();
}

void FfSequenceRun::send_within(std::int64_t size) {
  await_response_window();
  send(asked(0));
  if (bench_.next_begins(bench_.now() + bench_.observation_timeout())) {
    bench_.wait(bench_.octets(2));
    const kernel::Time end = bench_.send(words_.user_data(kToUser, size));
    const DrivenDlpdu own = *bench_.next();
    judge_one(own);
    model_.hear_noise(std::max(own.end, end));
  }
  await_response_window();
}

void FfSequenceRun::ask_meanwhile(const std::vector<std::int64_t>& numbers) {
  constexpr std::int64_t kSize = 40;
  constexpr std::int64_t kToPeer = 0;
  await_response_window();
  const Octets octets = words_.user_data(kToAnother, kSize);
  const kernel::Time end = bench_.send_at(bench_.now(), octets);
  bench_.wait(bench_.octets(kSize / 4));
  submit({numbers[0], kToPeer, numbers[1], 1});
  write({0, numbers[1], 1, 0});
  bench_.run_until(end);
  model_.hear(octets, end);
  await_response_window();
}

void FfSequenceRun::write(const std::vector<std::int64_t>& numbers) {
  Octets data = bench_.numbered_data(static_cast<std::size_t>(numbers[1]));
  for (std::int64_t n = 0; n < numbers[2] && model_.has_supply(); ++n) {
    if (n > 0 && numbers[3] == 0) data = bench_.numbered_data(data.size());
    const FfAddress address = words_.buffer(numbers[0]);
    judge_taken(bench_.write(address, data), model_.write(address, data), data);
  }
}

void FfSequenceRun::judge_taken(bool is_taken, bool is_right, const Octets& data) {
  judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
    return Mismatch{{fmt::format("data of {} octets is {}", data.size(), is_right ? "taken" : "refused")},
                    is_taken ? "taken" : "refused"};
  });
}

void FfSequenceRun::judge_said() {
  while (bench_.next_begins(bench_.now())) {
    const DrivenDlpdu one = *bench_.next();
    judge_one(one);
  }
}

void FfSequenceRun::await_response_window() {
  for (const DrivenDlpdu& one : bench_.listen()) judge_one(one);
  object(model_.be_silent(), "silence", bench_.now());
  judge_reports();
}

void FfSequenceRun::judge_one(const DrivenDlpdu& one) {
  object(model_.say(one), bench_.words(one), one.begin);
  const kernel::Duration length = one.end - one.begin;
  const kernel::Duration right = bench_.frame(one.octets.size());
  judge_.expect(length + kLinkRounding >= right && length <= right + kLinkRounding, "frame_length_wrong",
                [&] {
                  return Mismatch{{fmt::format("{}: {} octets of preamble", kernel::describe(right),
                                               bench_.link().preamble_octets)},
                                  kernel::describe(length),
                                  one.begin};
                });
}

void FfSequenceRun::object(const std::optional<LinkObjection>& objection, const std::string& actual,
                           kernel::Time when) {
  if (objection) judge_.fail(objection->reason, {{objection->expected}, actual, when});
}

void FfSequenceRun::judge_reports() {
  judge_reported(judge_, model_.take_reports(), std::exchange(bench_.user().reports, {}), bench_.now());
}

}  // namespace fieldproof::conformance
