#pragma once

#include <cstdint>
#include <vector>

#include "conformance/interbus/slave_twins.hpp"
#include "conformance/sequence.hpp"

// The words of sequences for a slave, and what they do to it and to its twins.
namespace fieldproof::conformance {

// In the order of the vocabulary.
enum class SlaveWord : std::uint8_t {
  data,
  id,
  telegrams,
  status,
  inputs,
  plugs,
  periphery,
  returns,
  silence,
  kept_alive,
  power,
  glitch,
  good,
  no_stop,
  rate,
  pulses,
  parts,
  right_id,
  clock,
  cut,
  lost_in_a_telegram,
  three_parts,
  cut_without_stop,
  glitch_within,
  returned_glitch,
  returned_pulses,
  kept_alive_without_stop,
};

std::vector<SequenceWord> slave_words();

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
