#include "conformance/fieldbus_dll/isa_las_sequence_run.hpp"

#include <algorithm>

#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {

using fieldbus_dll::Priority;

namespace {

constexpr std::size_t kSizeOfReply = 8;

Octets operator+(Octets header, const Octets& data) {
  header.insert(header.end(), data.begin(), data.end());
  return header;
}

}  // namespace

Octets IsaLasSequenceRun::header(std::uint8_t code, Priority priority, std::uint8_t to,
                                 std::uint8_t from) const {
  return {bench_.control(code, priority), to, from};
}

Octets IsaLasSequenceRun::tl(std::uint8_t to, std::uint8_t from, std::int64_t version) const {
  return {bench_.rules().codes.tl, to, from, static_cast<std::uint8_t>(version >> 8),
          static_cast<std::uint8_t>(version & 0xFF)};
}

void IsaLasSequenceRun::say(const Octets& octets) {
  bench_.wait(bench_.least_gap());
  acceptor_.hear(octets, bench_.send(octets));
}

void IsaLasSequenceRun::say_under_token(const Octets& octets) {
  if (bench_.now() + bench_.least_gap() + bench_.octets(1) <= acceptor_.out_until()) say(octets);
}

void IsaLasSequenceRun::give_back(const DrivenDlpdu& token) {
  say_under_token(bench_.ee(token.octet(1)));
}

void IsaLasSequenceRun::give_back_as(const DrivenDlpdu& token, const SequenceCommand& command) {
  bench_.wait(bench_.least_gap());
  const Octets ee = bench_.ee(token.octet(1));
  const bool is_whole = send_link_command(bench_, ee, command);
  is_whole ? acceptor_.hear(ee, bench_.now()) : acceptor_.hear_noise(bench_.now());
}

void IsaLasSequenceRun::use(const DrivenDlpdu& token, HolderData data, std::size_t size,
                            std::int64_t frames) {
  const auto& codes = bench_.rules().codes;
  const std::uint8_t to = data == HolderData::for_another     ? kThirdSender
                          : data == HolderData::for_everybody ? bench_.rules().everybody
                                                              : bench_.address();
  const std::uint8_t code = data == HolderData::reply_to_scheduler ? codes.dt : codes.du;
  for (std::int64_t n = 0; n < frames; ++n)
    say_under_token(header(code, Priority::normal, to, token.octet(1)) + bench_.numbered_data(size));
}

void IsaLasSequenceRun::compel(const DrivenDlpdu& token) {
  say(header(bench_.rules().codes.cd, Priority::normal, kThirdSender, token.octet(1)));
  bench_.wait(bench_.reply_wait() + bench_.octets(1) - bench_.least_gap());
  give_back(token);
}

void IsaLasSequenceRun::wait_until_over(std::int64_t octets) {
  const kernel::Time begin = acceptor_.out_until() - bench_.octets(octets) - bench_.least_gap();
  if (begin > bench_.now()) bench_.run_until(begin);
}

void IsaLasSequenceRun::overstay(const DrivenDlpdu& token, std::int64_t octets) {
  use(token, HolderData::for_another, 1, 1);
  wait_until_over(octets);
  use(token, HolderData::for_another, 30, 1);
}

void IsaLasSequenceRun::ask(const DrivenDlpdu& token, Priority priority, bool is_returned) {
  say(header(bench_.rules().codes.cd, priority, bench_.address(), token.octet(1)));
  (void)next_said();
  if (is_returned) give_back(token);
}

void IsaLasSequenceRun::answer(const DrivenDlpdu& cd) {
  const auto priority = static_cast<Priority>(cd.octet(0) & 3U);
  const auto number = static_cast<std::size_t>(priority);
  const Octets data =
      bench_.numbered_data(std::min<std::size_t>(kSizeOfReply, bench_.link().most_data.at(number - 1)));
  const Octets reply = bench_.dt(priority, data, cd.octet(1));
  const PeerAnswer outcome = outcomes_.at(number).front();
  outcomes_.at(number).pop_front();
  switch (outcome) {
    case PeerAnswer::replies:
      return say(reply);
    case PeerAnswer::is_silent:
      return;
    case PeerAnswer::sends_data:
      return say(header(bench_.rules().codes.du, priority, bench_.address(), kThirdSender) + data);
    case PeerAnswer::another_replies:
      return say(bench_.dt(priority, data, kThirdSender));
    case PeerAnswer::is_none:
      return say(bench_.dt(priority, data, kNoAddress));
    case PeerAnswer::replies_late:
      bench_.wait(bench_.reply_wait() - bench_.octets(1) - bench_.least_gap());
      return say(reply);
    case PeerAnswer::replies_urgently:
      return say(bench_.dt(Priority::urgent, {}, cd.octet(1)));
    case PeerAnswer::hands_over:
      return say(tl(bench_.address(), kThirdSender, 1));
    case PeerAnswer::higher_scheduler:
      return say(said_by_another(kHigherScheduler, 0));
    case PeerAnswer::lower_scheduler:
      return say(said_by_another(kLowerScheduler, 0));
  }
}

Octets IsaLasSequenceRun::said_by_third(std::int64_t kind) const {
  const auto& codes = bench_.rules().codes;
  if (kind == 0) return bench_.ee(kThirdSender);
  if (kind == 1) return header(codes.cd, Priority::normal, kFirstOrdered, kThirdSender);
  return header(codes.du, Priority::normal, bench_.rules().everybody, kThirdSender);
}

Octets IsaLasSequenceRun::said_by_another(std::uint8_t scheduler, std::int64_t kind) const {
  const auto& codes = bench_.rules().codes;
  if (kind == 2) return tl(kThirdSender, scheduler, 1);
  const Octets token = header(kind == 0 ? codes.et : codes.es, Priority::normal, kThirdSender, scheduler);
  return kind == 0 ? token : token + Octets{0, 20};
}

}  // namespace fieldproof::conformance
