#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include "conformance/fieldbus_dll/isa_bench.hpp"
#include "conformance/fieldbus_dll/isa_las_acceptor.hpp"
#include "conformance/fieldbus_dll/isa_las_vocabulary.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"

// One sequence for a link active scheduler of IEC/ISA: does its commands as the other stations of the link,
// and has the acceptor judge each DLPDU of the scheduler.
namespace fieldproof::conformance {

class IsaLasSequenceRun {
 public:
  IsaLasSequenceRun(IsaBench& bench, CaseJudge& judge);

  void run(const Sequence& sequence);

 private:
  static constexpr std::uint8_t kFirstOrdered = 0x13;
  static constexpr std::uint8_t kLowerScheduler = 0x08;
  static constexpr std::uint8_t kHigherScheduler = 0x30;
  static constexpr std::uint8_t kThirdSender = 0x2A;
  static constexpr std::uint8_t kNoAddress = 0;
  static constexpr std::array<std::uint8_t, 4> kOtherSchedulers{kHigherScheduler, kLowerScheduler, 0xF7,
                                                                0x0F};

  using Hold = std::function<void(const DrivenDlpdu&)>;
  void execute(const SequenceCommand& command);

  // ---- what the scheduler says ----

  // Nothing in standby. What it compels is answered.
  std::optional<DrivenDlpdu> next_said();
  std::optional<DrivenDlpdu> next_of_any_kind();
  void judge_reports();
  bool is_token(const DrivenDlpdu& one) const;
  void with_token(const Hold& hold);
  void obey();

  // ---- what others say ----

  Octets header(std::uint8_t code, fieldbus_dll::Priority priority, std::uint8_t to, std::uint8_t from) const;
  Octets tl(std::uint8_t to, std::uint8_t from, std::int64_t version) const;
  void say(const Octets& octets);
  // A holder does not talk into what the scheduler may say when its token is over.
  void say_under_token(const Octets& octets);
  void give_back(const DrivenDlpdu& token);
  void give_back_as(const DrivenDlpdu& token, const SequenceCommand& command);
  void use(const DrivenDlpdu& token, HolderData data, std::size_t size, std::int64_t frames);
  void compel(const DrivenDlpdu& token);
  // So that what comes V(MID) later begins so many octets before.
  void wait_until_over(std::int64_t octets);
  void overstay(const DrivenDlpdu& token, std::int64_t octets);
  void ask(const DrivenDlpdu& token, fieldbus_dll::Priority priority, bool is_returned);
  void answer(const DrivenDlpdu& cd);
  Octets said_by_third(std::int64_t kind) const;
  Octets said_by_another(std::uint8_t scheduler, std::int64_t kind) const;

  // ---- the user ----

  void submit(fieldbus_dll::Priority priority, std::size_t size, std::size_t to);
  void submit_for(fieldbus_dll::IsaService service, fieldbus_dll::Priority priority, std::uint8_t destination,
                  const Octets& data);
  void order(std::uint8_t heir);
  // What it has begun ends before.
  void transfer(const SequenceCommand& command);
  void take_over(const SequenceCommand& command, std::uint8_t heir);
  // What it holds or owes is begun V(MID) later at the soonest.
  void say_at_once(const Octets& octets);
  void resume(std::int64_t version, bool is_ordered, std::int64_t in);
  // What was submitted, ordered and out is gone; who begins as the scheduler begins as that again.
  void lose_supply(std::int64_t octets);

  IsaBench& bench_;
  CaseJudge& judge_;
  IsaLasAcceptor acceptor_;
  std::array<std::deque<PeerAnswer>, 4> outcomes_;  // by priority
};

}  // namespace fieldproof::conformance
