#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "conformance/fieldbus_dll/ff_bench.hpp"
#include "conformance/fieldbus_dll/ff_model.hpp"
#include "conformance/fieldbus_dll/ff_words.hpp"
#include "conformance/fieldbus_dll/link_scene.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"

// One sequence for a basic device: sends what its commands say and judges each DLPDU of the device, and what
// its user is told, against the model.
namespace fieldproof::conformance {

class FfSequenceRun {
 public:
  FfSequenceRun(FfBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), words_(bench), model_(bench.configuration()) {
    // That it was activated is known; when it last spoke is long ago.
    model_.hear_noise(bench.now());
    bench_.user().reports.clear();
  }

  void run(const Sequence& sequence);

 private:
  static constexpr std::int64_t kDuration = 100;  // of a token that is asked for
  static constexpr kernel::Duration kMinute = 60 * kernel::kSecond;
  void execute(const SequenceCommand& command);
  void send_framed_data(const std::vector<std::int64_t>& numbers);
  // A frame that comes in another way.
  void send_by_line(FfWord word, const std::vector<std::int64_t>& numbers);
  // A link master in standby claims a link on which nobody says anything.
  void keep_active();
  void send(const Octets& octets);
  // 0: a PT, 1: a CD, 2: a PN for the device.
  Octets asked(std::int64_t what);
  kernel::Duration quarters_of_a_bit(std::int64_t count) const;
  void end_before_it_begins(const std::vector<std::int64_t>& numbers);
  void keep_busy_until(kernel::Time until, DlpduIsNone kind);
  // How soon it answers is seen first: as soon it can answer again.
  void answer_beside_its_end(const std::vector<std::int64_t>& numbers);
  void leave_room(const std::vector<std::int64_t>& numbers);
  void settle(std::int64_t silence);
  // Who has no supply is asked for nothing.
  void submit(const std::vector<std::int64_t>& numbers);
  void ask_for_nothing(const std::vector<std::int64_t>& numbers);
  // What is next was decided before it began to send; what is submitted then comes after it.
  void submit_beside(const std::vector<std::int64_t>& numbers);
  // Others begin within what it sends.
  void send_within(std::int64_t size);
  void ask_meanwhile(const std::vector<std::int64_t>& numbers);
  void write(const std::vector<std::int64_t>& numbers);
  void judge_taken(bool is_taken, bool is_right, const Octets& data);
  void judge_said();
  void await_response_window();
  void judge_one(const DrivenDlpdu& one);
  void object(const std::optional<LinkObjection>& objection, const std::string& actual, kernel::Time when);
  void judge_reports();

  FfBench& bench_;
  CaseJudge& judge_;
  FfWords words_;
  FfModel model_;
};

}  // namespace fieldproof::conformance
