#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "conformance/fieldbus_dll/ff_bench.hpp"
#include "conformance/fieldbus_dll/ff_las_model.hpp"
#include "conformance/fieldbus_dll/ff_las_vocabulary.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"

// One sequence for a link active scheduler: does its commands as the nodes and the other link masters of the
// link, and judges each DLPDU of the scheduler against the model.
namespace fieldproof::conformance {

class FfLasSequenceRun {
 public:
  FfLasSequenceRun(FfBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), model_(bench.configuration()) {}

  void run(const Sequence& sequence);

 private:
  using Is = std::function<bool(const DrivenDlpdu&)>;

  void execute(const SequenceCommand& command);
  // In their order; what is told of the last question may be told already.
  void judge_events();

  // ---- what the scheduler says ----

  DrivenDlpdu next_said();
  // Answers what comes before.
  std::optional<DrivenDlpdu> next_that(const Is& is);
  DrivenDlpdu next_cd(fieldbus_dll::FfAddress address);
  // Of a node that answers; nothing when there is none for so long.
  void with_token(const std::function<void(const DrivenDlpdu&)>& hold);
  void object(const FfLasModel::Found& objection, const std::string& actual, kernel::Time when);

  // ---- what others say ----

  // V(MID) after the end of what was said last, or later.
  kernel::Time say(const Octets& octets, std::int64_t later = 0);
  // False: with faults.
  bool say_as(const SequenceCommand& command, const Octets& octets);
  // As nodes do.
  void answer(const DrivenDlpdu& said);
  void refuse(const DrivenDlpdu&, const SequenceCommand& command);
  void publish(const DrivenDlpdu& cd, const SequenceCommand& command);
  Octets dt1_of(const DrivenDlpdu& pt, const Octets& data, bool is_final) const;
  void use(const DrivenDlpdu& pt, const SequenceCommand& command);
  // What a holder says V(MID) from now, or later still, has to end within its token.
  bool is_in_token(const DrivenDlpdu& pt, std::size_t octets, std::int64_t later = 0) const;
  void return_token(const DrivenDlpdu& pt);
  // Urgent data as long as another DT1 fits.
  void spend(const DrivenDlpdu& pt);
  void ask_time(const DrivenDlpdu& pt, const SequenceCommand& command);
  void submit(fieldbus_dll::Priority priority, std::size_t size);
  void write(fieldbus_dll::FfAddress buffer, std::size_t size);

  // ---- what is not theirs ----

  // It is taken back in the silence behind the last DT1, by whatever has time before what is due.
  void overstay(const DrivenDlpdu& pt, std::int64_t later);
  Octets data_of(const DrivenDlpdu& pt, const Octets& data) const;
  void usurp(bool probe, std::int64_t later);
  // Data of others are no scheduler's: something has come in place of the reply.
  void interrupt(std::int64_t later);

  // ---- other schedulers ----

  // While it waits for an answer another has the link.
  void displace_by(const std::function<Octets()>& octets);
  void displace();
  void say_as_scheduler(const Octets& octets);
  // In standby, of the silence that claims the link, V(MID) at least.
  void wait_in_standby(std::int64_t parts);
  // A duration of 0 is none, and with it the DLPDU.
  void pass_none(std::uint8_t node);
  void second(const SequenceCommand& command);
  Octets of_scheduler(OtherScheduler kind, const std::vector<std::int64_t>& numbers) const;
  // What it is when the frame is over, and more.
  Octets time_of_second(std::int64_t jump) const;
  void told(std::int64_t nodes, std::int64_t parts);
  void make_noise(std::int64_t octets, std::int64_t parts);
  void hand(const SequenceCommand& command);
  void order(std::uint8_t heir, HeirSends sends);

  // ---- time, entities and the supply ----

  void ask_late(std::int64_t left, bool is_of_another);
  void say_of_entity(const DrivenDlpdu& pt, bool is_for_everybody);
  void lose_supply(std::int64_t octets);

  static constexpr std::uint8_t kSecondOfLas = 0x13;
  static constexpr std::uint8_t kGrantOfSecond = 88;
  static constexpr std::uint8_t kNobody = 0x77;

  FfBench& bench_;
  CaseJudge& judge_;
  FfLasModel model_;
  std::map<std::uint8_t, std::int64_t> tokens_missed_;
  std::set<std::uint8_t> joining_;
  std::vector<Octets> data_;
  std::int64_t submitted_ = 0;
};

}  // namespace fieldproof::conformance
