#pragma once

#include "conformance/interbus/slave_twins.hpp"
#include "conformance/interbus/slave_words.hpp"

namespace fieldproof::conformance {

// What a word does; each leaves what was driven in the views.
class SlaveActs {
 public:
  explicit SlaveActs(SlaveTwins& twins) : twins_(twins) {}

  // What the twins cannot tell is judged here.
  void act(const SequenceCommand& command, CaseJudge& judge);

 private:
  void send(const SequenceCommand& command, void (*append)(SlaveBench&, const SequenceCommand&));
  void drive_at_rate(const SequenceCommand& command, CaseJudge& judge);
  void drive_parts(const SequenceCommand& command);
  void drive_pulses(const SequenceCommand& command, CaseJudge& judge);
  void show_clock(CaseJudge& judge);
  void lose_supply(kernel::Duration duration);
  void periphery(const SequenceCommand& command);
  void be_silent(std::int64_t how_long);
  void keep_alive(std::int64_t how_long);
  void keep_alive_without_stop();
  kernel::Duration time_of_right_id();
  void note_what_came(bool is_id_cycle);

  SlaveTwins& twins_;
  kernel::Time last_telegram_{};  // at the slave's receiver, and the end of the last ID cycle there
  kernel::Time last_id_cycle_{};
};

}  // namespace fieldproof::conformance
