#include "fuzz/ff_las_watch.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::fuzz {
namespace {

using kernel::Duration;
using kernel::Time;

// First octets; of CD and PT without the bits that are set in them.
constexpr unsigned kLasCd = 0xA0;
constexpr unsigned kLasPt = 0x30;
constexpr unsigned kLasPn = 0x26;
constexpr unsigned kLasPr = 0x27;
constexpr unsigned kLasTd = 0x11;
constexpr unsigned kLasCt = 0x14;
constexpr unsigned kLasCl = 0x01;
constexpr unsigned kLasTl = 0x06;
constexpr unsigned kLasFinal = 0x04;
constexpr unsigned kLasPriority = 0x03;

bool is_las_pt(unsigned control) {
  return (control & 0xF8U) == kLasPt && (control & kLasPriority) != 0;
}
bool is_las_cd(unsigned control) {
  return (control & 0xF0U) == kLasCd;
}
bool may_be_of_another_scheduler(unsigned control) {
  return is_las_pt(control) || is_las_cd(control) || control == kLasPn || control == kLasTd ||
         control == kLasCl || control == kLasTl;
}

}  // namespace

FfLasWatch::FfLasWatch(const fieldbus_dll::FfConfiguration& configuration) : configuration_(configuration) {
  for (const std::uint8_t node : configuration.live) may_be_live_.at(node) = is_surely_live_.at(node) = true;
}

Duration FfLasWatch::times(std::int64_t octets) const {
  return fieldbus_dll::octets(configuration_.rules.link, octets);
}

Time FfLasWatch::end_of(const LinkSaid& said) const {
  constexpr std::size_t kCheckAndDelimiters = 4;
  return said.begin + times(static_cast<std::int64_t>(said.octets.size() + kCheckAndDelimiters +
                                                      configuration_.rules.link.preamble_octets));
}

Time FfLasWatch::due() const {
  const auto& schedule = configuration_.schedule;
  const std::uint64_t cycle = items_done_ / schedule.items.size();
  const auto& item = schedule.items[items_done_ % schedule.items.size()];
  return kernel::kStart +
         static_cast<std::int64_t>(cycle * schedule.macrocycle + item.at) * fieldbus_dll::kTick;
}

// ---- what is heard ----

void FfLasWatch::on_begin(Time now) {
  // What comes behind the silence answers nothing any more.
  const Time silent_since = std::max(heard_until_, driven_until_);
  if (now - silent_since >= response_delay(configuration_.rules.link)) close_question(now);
  is_line_busy_ = true;
}

void FfLasWatch::on_wave(const line::Waveform& wave) {
  if (wave.start >= driven_until_) {
    for (const LinkOctets& octets : link_frames_in(wave, configuration_.rules.link)) {
      const unsigned control = octets[0];
      if (may_be_of_another_scheduler(control)) is_scheduler_ = knows_schedule_ = false;
      if (control == kLasCt) is_asked_for_time_ = true;
      if (!question_) continue;
      if (question_->asks == Asks::transfer) is_scheduler_ = knows_schedule_ = false;
      if ((control & kLasFinal) != 0 && control != kLasCt) question_->may_be_answered = true;
      if (control == kLasPr) may_be_live_.at(question_->node) = true;
    }
  }
  is_line_busy_ = false;
  heard_until_ = wave.end();
}

// ---- what is said ----

void FfLasWatch::close_question(Time now) {
  if (!question_) return;
  const Question question = *question_;
  question_.reset();
  const Time silent_since = std::max(heard_until_, driven_until_);
  const bool is_silent = now - silent_since >= response_delay(configuration_.rules.link);
  FIELDPROOF_CHECK(question.may_be_answered || is_silent || now >= question.token_ends,
                   "a scheduler is silent while a token, a CD or a probe of its own is out");
  if (question.asks != Asks::token) return;
  if (!question.may_be_answered) is_surely_live_.at(question.node) = false;
  unsigned& misses = misses_.at(question.node);
  misses = heard_until_ < question.end ? misses + 1 : 0;
  if (misses < configuration_.rules.misses_until_removal) return;
  may_be_live_.at(question.node) = false;
  misses = 0;
}

void FfLasWatch::on_said(const LinkSaid& said) {
  const unsigned control = said.octets[0];
  const Time silent_since = std::max(heard_until_, driven_until_);
  const Duration silence = times(configuration_.rules.link.inter_pdu_delay_octets);
  FIELDPROOF_CHECK(!is_line_busy_ && said.begin >= silent_since + silence,
                   "a scheduler leaves V(MID) of silence in front of its frames");
  if (control == kLasCl) {
    is_scheduler_ = true;
    question_.reset();
    priority_.reset();
    misses_ = {};
    may_be_live_.fill(true);
    is_surely_live_.fill(false);
  }
  // Into a token that is out, and without its end, it says the time to who asked for it last.
  const bool is_silent = said.begin - silent_since >= response_delay(configuration_.rules.link);
  const bool is_answer = control == kLasTd && is_asked_for_time_ && !is_silent;
  is_asked_for_time_ = false;
  if (is_scheduler_ && !is_answer && control != kLasCl) {
    close_question(said.begin);
    if (is_las_cd(control)) {
      check_cd(said);
    } else if (is_las_pt(control)) {
      check_token(said);
    } else if (control == kLasPn) {
      check_probe(said);
    } else {
      check_room(end_of(said));
    }
    if (control == kLasTl) question_ = Question{Asks::transfer, 0, end_of(said), kernel::kNever};
  }
  driven_until_ = end_of(said);
}

void FfLasWatch::check_room(Time end) const {
  if (!knows_schedule_) return;
  const Duration free = times(configuration_.rules.scheduling_overhead_octets);
  FIELDPROOF_CHECK(end + free <= due(), "what a scheduler begins ends V(MSO) before the next item");
}

void FfLasWatch::check_cd(const LinkSaid& said) {
  const auto address = static_cast<std::uint32_t>(said.octets[1] << 8 | said.octets[2]);
  question_ = Question{Asks::data, said.octets[1], end_of(said), kernel::kNever};
  if (!knows_schedule_) return;
  const auto& items = configuration_.schedule.items;
  FIELDPROOF_CHECK(address == items[items_done_ % items.size()].address,
                   "items are compelled in their order");
  FIELDPROOF_CHECK(said.begin >= due(), "an item is not compelled before it is due");
  const Time silent_since = std::max(heard_until_, driven_until_);
  const bool is_late = said.begin > due();
  FIELDPROOF_CHECK(!is_late || silent_since + response_delay(configuration_.rules.link) >= due(),
                   "an item is compelled at its instant when the line is silent");
  ++items_done_;
}

void FfLasWatch::check_token(const LinkSaid& said) {
  const std::uint8_t node = said.octets[1];
  const unsigned duration = said.octets[2] * 256U + said.octets[3];
  const auto& rules = configuration_.rules;
  FIELDPROOF_CHECK(duration >= rules.least_token_octets && duration <= rules.token_holding_octets,
                   "a token is for V(DMDT) to V(DTHT)");
  FIELDPROOF_CHECK(may_be_live_.at(node), "a token is for a node that is live");
  const unsigned priority = said.octets[0] & kLasPriority;
  const unsigned last = priority_.value_or(3);
  const bool begins = (said.octets[0] & kLasFinal) != 0;
  const unsigned step = priority > last ? priority - last : last - priority;
  // A circulation in which nobody is live has no token, but its probe.
  FIELDPROOF_CHECK(step == 0 || (begins && step <= probes_),
                   "the priority of tokens changes by a step, where a circulation begins");
  priority_ = priority;
  probes_ = 0;
  const Time token_ends = end_of(said) + times(duration);
  check_room(token_ends);
  question_ = Question{Asks::token, node, end_of(said), token_ends};
}

void FfLasWatch::check_probe(const LinkSaid& said) {
  constexpr std::int64_t kPrOnLine = 7;
  ++probes_;
  const std::uint8_t node = said.octets[1];
  const auto& rules = configuration_.rules;
  const bool is_unpolled = node >= rules.first_unpolled && node < rules.first_unpolled + rules.unpolled;
  FIELDPROOF_CHECK(node >= rules.first_node && node <= rules.last_node && !is_unpolled,
                   "a probe is for an address that may be polled");
  FIELDPROOF_CHECK(node != configuration_.node && !is_surely_live_.at(node),
                   "a probe is for a node that is not live");
  check_room(end_of(said) + response_delay(rules.link) + times(kPrOnLine));
  question_ = Question{Asks::probe, node, end_of(said), kernel::kNever};
}

}  // namespace fieldproof::fuzz
