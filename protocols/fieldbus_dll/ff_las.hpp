#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "protocols/fieldbus_dll/ff_station.hpp"

// The reference link master of the profile FF-P: the link active scheduler (LAS), or a station that becomes
// it when nothing is heard for V(ST) x V(TN), or by a TL.
//
//   standby ──silence for V(ST) x V(TN) + V(MICD): CL──▶ scheduling ◀──TL── standby
//
//   scheduling ──item due: CD──▶ awaiting_reply ──DT3, SR or V(MRD) x V(ST)──▶ scheduling
//   scheduling ──PT──▶ awaiting_holder ──RT, F, or silence of V(MRD) x V(ST), or duration over──▶ scheduling
//   scheduling ──PN──▶ awaiting_probe ──PR or V(MRD) x V(ST)──▶ scheduling
//   scheduling ──TL──▶ transferring ──anything──▶ standby; V(MRD) x V(ST) of silence──▶ scheduling
//
// What is due in the schedule goes before everything else: nothing is begun that does not end V(MSO) before
// it. Then come the distribution of time, what it tells other entities, and the token: once to each node in
// the order of their addresses, then one probe. Its own turn is at its own place in that order.
//
// A circulation ends when the next begins. When it took less than V(TTRT), the next one admits a lower
// priority, else a higher one; the first admits urgent data only.
//
// Hearing another scheduler it leaves.
namespace fieldproof::fieldbus_dll {

enum class FfLasState : std::uint8_t {
  standby,
  scheduling,
  own_turn,
  awaiting_reply,
  awaiting_holder,
  awaiting_probe,
  transferring
};

class FfLas : public FfStation {
 public:
  explicit FfLas(const FfConfiguration& configuration);

  bool start(kernel::Time now) override;
  void stop(kernel::Time now) override;
  bool order_transfer(std::uint8_t node, kernel::Time now) override;
  bool submit(const FfRequest& request, kernel::Time now) override;

  void on_activity(segment::PortIndex port, bool begins, kernel::Time now) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

  FfLasState las_state() const { return las_; }
  bool is_scheduler() const { return las_ != FfLasState::standby; }
  const std::vector<bool>& live() const { return live_; }
  Priority token_priority() const { return token_priority_; }
  // Of the last circulation; zero before the second one.
  kernel::Duration rotation() const { return rotation_; }

 protected:
  // ---- decisions ----
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override;
  void on_spdu(const FfDlpdu& dlpdu, kernel::Time now) override;
  virtual kernel::Duration claim_silence() const;
  // Whether the line was silent before it had a supply it does not know.
  virtual kernel::Time silent_for_claim_since() const { return std::max(line().silent_since(), started_); }
  virtual bool leaves_to(const FfDlpdu& dlpdu) const { return is_of_scheduler(dlpdu.type); }
  virtual bool is_from_awaited(const FfDlpdu& dlpdu) const;
  virtual bool is_too_slow(kernel::Duration rotation) const { return rotation >= rules().target_rotation; }
  virtual Priority next_priority(Priority now, bool is_too_slow) const;
  virtual std::uint8_t next_probe(std::uint8_t last) const;
  virtual bool probes_now() const { return true; }
  virtual unsigned token_grant(kernel::Duration left) const;
  virtual kernel::Duration kept_free_before_cd() const;
  virtual kernel::Time due(const FfScheduleItem& item) const;
  // To the next item of the schedule.
  virtual void advance();
  virtual kernel::Duration time_distributed_every() const {
    return rules().time_distribution_period * 9 / 10;
  }
  virtual bool is_missed_too_often(unsigned misses) const { return misses >= rules().misses_until_removal; }
  virtual void on_token_used(std::uint8_t node) { misses_[node] = 0; }
  virtual kernel::Duration longest_silence() const;
  virtual kernel::Time answer_awaited_until(const Place& question) const {
    return question.end + response_delay(rules().link);
  }
  // Who holds a token may use it until then; after that it is taken back where it leaves the line silent.
  virtual kernel::Time holder_until(kernel::Time passed, unsigned grant) const {
    return passed + octet_times(grant) + octet_times(rules().link.slot_time_octets);
  }
  virtual bool retakes() const { return true; }
  virtual kernel::Duration rotation_of(kernel::Time last, kernel::Time now) const { return now - last; }
  virtual Octets live_list() const { return live_list_spdu(revision_, live_); }

  // ---- actions ----
  void enter_las(FfLasState state) { las_ = state; }
  void take_link(kernel::Time now);
  void leave(kernel::Time now);
  std::uint8_t awaited() const { return awaited_; }

 private:
  void begin_anew();
  void schedule(kernel::Time now);
  bool compel(kernel::Time now);
  bool distribute_time(kernel::Time now);
  bool tell_entities(kernel::Time now);
  bool transfer(kernel::Time now);
  bool circulate(kernel::Time now);
  bool pass_token(std::uint8_t node, kernel::Time now);
  bool use_own_turn(kernel::Time now);
  bool probe(kernel::Time now);
  void keep_active(kernel::Time now);
  void begin_circulation(kernel::Time now);
  void on_answer_time_over(kernel::Time now);
  void on_back(kernel::Time now);
  void miss(kernel::Time now);
  void set_live(std::uint8_t node, bool is_live);
  void await(FfLasState state, std::uint8_t node, const Place& question);
  // Sends what must be answered.
  Place send_question(const FfDlpdu& dlpdu, kernel::Time now) { return {now, transmit(dlpdu, now)}; }
  void say(const FfDlpdu& dlpdu, kernel::Time now);
  FfDlpdu time_dlpdu(kernel::Time now) const;
  kernel::Time next_cd() const;
  void set_schedule(kernel::Time now);
  // A frame that begins now, and `more` after it, ends before what is due.
  bool has_time(const FfDlpdu& dlpdu, kernel::Duration more, kernel::Time now) const;
  kernel::Time timer() const;

  FfLasState las_ = FfLasState::standby;
  kernel::Time started_{};
  std::vector<bool> live_;
  std::vector<unsigned> misses_;
  std::uint8_t revision_ = 0;

  std::uint64_t cycle_ = 0;  // link time at which the macrocycle of the next item began
  std::size_t item_ = 0;
  kernel::Time last_distribution_{};
  std::deque<FfRequest> to_tell_;  // other entities

  unsigned turn_ = 0;  // the node that comes next in the circulation; kNodes behind the last one
  bool is_first_token_ = true;
  bool has_circulated_ = false;
  kernel::Time circulation_begin_{};
  kernel::Duration rotation_{};
  Priority token_priority_ = Priority::urgent;
  std::uint8_t last_probe_ = 0;
  kernel::Time own_turn_until_{};

  std::uint8_t awaited_ = 0;
  bool has_answered_ = false;
  kernel::Time answer_until_ = kernel::kNever;
  kernel::Time token_until_ = kernel::kNever;
  kernel::Time blocked_until_ = kernel::kStart;  // nothing else fits before the next item
  std::optional<std::uint8_t> ordered_heir_;
};

}  // namespace fieldproof::fieldbus_dll
