#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "conformance/fieldbus_dll/driven_dlpdus.hpp"
#include "conformance/fieldbus_dll/link_objection.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// What a link active scheduler of the profile FF-P must say and may not, told from what it said before, what
// others answered and what its user wants: a model of the rules that shares nothing with the stations but
// their numbers. Nothing is heard while it speaks.
//
// - its own buffer, once it was written, when its item is due; a TL when its user orders it
// - V(MID) of silence in front of each DLPDU, and never a silence of V(ST) x 16
// - an IDLE where nobody is to be probed, else after V(ST) x 8 of silence
// - nothing while a token, a CD or a probe is out: until it is answered, the line was silent for V(MRD) x
//   V(ST), or the token is over
// - each item of the schedule in its order, not before it is due, and before all else when it is; at most
//   V(MSO) after the instant at which the line is free, and who holds a token too long has had a V(ST) more
// - all else ends, with what belongs to it, V(MSO) and V(MID) before the next item: TD when it is due, what
//   its entity sends, a TL, the circulation, in this order
// - tokens from V(DMDT) to V(DTHT), once in a circulation to each live node, in the order of addresses, the
//   first one marked, with the priority that the rotations before lead to
// - in its own turn DT1s without F, within V(DTHT), all that is urgent and has time
// - between two circulations a probe, ascending, of nodes that are not live and may be polled
// - who misses so many tokens in a row is not live any more; who answers a probe is, from the next
//   circulation on; both is told within two circulations, in lists that are numbered
// - link time goes on in what is told of it, once in V(TDP) and to who asks
//
// Who hears a CD, PT, PN, TD, CL or TL of another, or anything behind its own TL, is silent in
// standby, but for what a device answers. After V(ST) x V(TN) of silence it claims the link, and by a TL for
// it and its schedule it gets it. It has learnt link time and who is live then.
//
// A faulty answer may be taken for an answer or for none; the model holds the scheduler to neither, until it
// shows which.
namespace fieldproof::conformance {

class FfLasModel {
 public:
  using Priority = fieldbus_dll::Priority;
  using Found = std::optional<LinkObjection>;

  explicit FfLasModel(const fieldbus_dll::FfConfiguration& configuration);

  // False: the station must refuse it.
  bool submit(Priority priority, const Octets& data);
  // A buffer of its own that its schedule has.
  bool write(fieldbus_dll::FfAddress address, const Octets& data, kernel::Time now);
  void order_transfer(std::uint8_t node, kernel::Time now);
  // It goes, and comes now: nothing outlasts it. Events count from here.
  void lose_supply(kernel::Time now);

  // ---- what others say, until `end`; instants never decrease ----
  void hear_answer(kernel::Time end);  // what ends a token or a CD
  void hear_data(kernel::Time end);    // of a holder that goes on
  void hear_time_request(kernel::Time end);
  void hear_probe_response(kernel::Time end);
  void hear_noise(kernel::Time end);
  void hear_none(kernel::Time end) { silent_since_ = end; }  // no DLPDU, and surely taken for none
  // Of another scheduler, or of who becomes one.
  void hear_scheduler(const Octets& octets, kernel::Time end);

  // ---- what the station says ----
  Found say(const DrivenDlpdu& dlpdu);
  // What must have been said by now: its own turn passed with time for it.
  Found end() const;
  bool has_urgent_data() const;

  bool is_scheduler() const { return is_scheduler_; }
  // In standby: another scheduler has asked it.
  bool owes_answer() const { return owed_.has_value(); }
  // When the line is silent it has been claimed by then.
  kernel::Duration claim_silence() const;
  // In link time.
  std::uint64_t ticks_at(kernel::Time now) const;
  // It may not be silent until then.
  kernel::Time silent_until() const;
  // What its user must have been told, up to where a faulty answer leaves that open.
  const std::vector<fieldbus_dll::FfEvent>& events() const { return events_; }
  // Nothing else was to be told by now.
  bool are_events_complete() const { return !question_ && are_events_certain_; }
  bool is_surely_live(std::uint8_t node) const { return nodes_.at(node).is_live && !is_open(node); }

 private:
  static constexpr unsigned kNodes = 256;

  struct Node {
    bool is_live = false;
    std::size_t live_since = 0;  // the number of a circulation, of which it is no part
    // Tokens that it missed in a row, with and without its faulty answers.
    unsigned fewest_misses = 0;
    unsigned most_misses = 0;
    bool was_left_open = false;  // when it left: whether it was removed before is not told
  };
  enum class Asked : std::uint8_t { compels, passes_token, probes, transfers };
  struct Question {
    std::uint8_t node;
    Asked asked;
    kernel::Time token_ends = kernel::kNever;  // of anything else
    bool is_answered = false;                  // to its end
    bool is_heard = false;                     // something of its holder
    bool is_noisy = false;
  };
  struct Reported {
    std::uint64_t ticks;
    kernel::Time end;
  };

  struct OwnBuffer {
    Octets data;
    unsigned writes = 0;
    kernel::Time since = kernel::kNever;
  };

  const fieldbus_dll::FfRules& rules() const { return configuration_.rules; }
  // No token that is answered is a miss.
  unsigned misses_of_no_node() const { return std::max(rules().misses_until_removal, 1U); }
  kernel::Duration times(std::int64_t octets) const;
  kernel::Time item_at(std::size_t number) const;  // of all macrocycles
  kernel::Time due() const;
  // It may have been removed, and may not.
  bool is_open(std::uint8_t node) const;
  bool is_polled(unsigned node) const;
  bool has_to_probe() const;
  bool may_have_to_probe() const;
  bool is_next_to_probe(std::uint8_t node) const;
  bool has_time_for_td() const;
  // The next item that has something to say.
  kernel::Time next_said_item() const;
  // What ends then, and may be followed by an answer, leaves V(MSO) and V(MID) free before what is due, with
  // so many octets to spare.
  bool leaves_time(kernel::Time end, std::int64_t spare) const;
  // From the begin of a frame to the end of all that belongs to it.
  kernel::Duration time_of(const DrivenDlpdu& dlpdu) const;
  Found check_order(const DrivenDlpdu& dlpdu) const;
  Found check_own_turn(const DrivenDlpdu& next) const;
  // Data has time in its own turn if it has in each gap from the token or the probe before it to the one
  // after.
  void note_own_turn(const DrivenDlpdu& next);
  bool is_behind_own_turn(const DrivenDlpdu& next) const;

  void leave();
  void take(kernel::Time now);
  void learn(const fieldbus_dll::FfDlpdu& dlpdu, kernel::Time end);
  void owe_buffer(const fieldbus_dll::FfDlpdu& cd);
  Found say_in_standby(const DrivenDlpdu& dlpdu);
  const fieldbus_dll::FfScheduleItem* next_item() const;
  bool is_own_item_next() const;
  Found pass_own_items(const DrivenDlpdu& dlpdu);
  Found say_own_buffer(const DrivenDlpdu& dt3);
  Found say_transfer(const DrivenDlpdu& tl);
  Found close_question(kernel::Time now);
  void expect_event(fieldbus_dll::FfEventKind kind, std::uint8_t node);
  void expect_event_of(const Question& question);
  void count_token(const Question& token);
  void remove(std::uint8_t node);
  void show_live(std::uint8_t node);
  Found say_dlpdu(const DrivenDlpdu& dlpdu);
  Found say_cd(const DrivenDlpdu& cd);
  Found say_token(const DrivenDlpdu& pt);
  Found begin_circulation(const DrivenDlpdu& pt);
  Found go_on(const DrivenDlpdu& pt);
  Found pass_over(unsigned first, unsigned behind_last);
  Found check_grant(const DrivenDlpdu& pt) const;
  Found check_told() const;
  Priority least_before_token(bool is_first) const;
  void interrupt_own_turn();
  std::vector<Priority> priorities_behind(kernel::Duration rotation) const;
  Found say_probe(const DrivenDlpdu& pn);
  Found say_time(const DrivenDlpdu& td, bool is_answer);
  Found say_data(const DrivenDlpdu& dt1);
  Found say_activation(const DrivenDlpdu& dt1);
  Found say_live_list(const Octets& list);
  Found check_revision(std::uint8_t said);
  Found say_idle(const DrivenDlpdu& idle);
  Found say_of_user(const DrivenDlpdu& dt1, const Octets& data);

  fieldbus_dll::FfConfiguration configuration_;
  std::array<Node, kNodes> nodes_{};
  std::array<std::deque<Octets>, 4> queues_;  // by priority

  bool is_scheduler_ = true;
  std::optional<Octets> owed_;        // in standby
  std::optional<std::uint8_t> heir_;  // it was ordered to hand the link to it
  kernel::Time ordered_ = kernel::kStart;
  std::map<fieldbus_dll::FfAddress, OwnBuffer> own_;

  kernel::Time silent_since_ = kernel::kStart;
  kernel::Time free_since_ = kernel::kStart;   // it may have begun what it says now
  kernel::Time free_latest_ = kernel::kStart;  // a token is taken back a V(ST) after its end at the latest
  std::optional<Question> question_;
  std::vector<fieldbus_dll::FfEvent> events_;
  bool are_events_certain_ = true;
  bool is_asked_for_time_ = false;
  kernel::Time time_told_ = kernel::kStart;
  kernel::Time td_due_ = kernel::kStart;  // answers to CTs do not count
  std::optional<Reported> told_;
  std::size_t items_done_ = 0;
  kernel::Time link_time_begin_ = kernel::kStart;

  std::optional<std::uint8_t> last_token_;         // of this circulation
  std::optional<kernel::Time> circulation_begin_;  // not known behind a circulation without a token
  std::optional<Priority> priority_;
  std::size_t circulations_ = 0;
  bool is_first_circulation_ = true;
  unsigned probes_ = 0;  // since the last token
  unsigned idles_ = 0;   // the same
  std::optional<std::uint8_t> last_probe_;

  // The number of the circulation since which it is to be told.
  std::map<std::uint8_t, std::size_t> to_activate_;
  std::optional<std::size_t> list_changed_;
  std::optional<std::uint8_t> revision_;  // told last, here or by another scheduler
  unsigned fewest_changes_ = 0;           // since then, or since its supply
  unsigned most_changes_ = 0;

  // Its own turn in the circulation: since its first DT1.
  struct OwnTurn {
    kernel::Time begin;
    Priority lowest;
    bool is_interrupted = false;
  };
  std::optional<OwnTurn> own_turn_;
  kernel::Time turn_since_ = kernel::kStart;  // it may have begun, though nothing of it was said
  bool has_time_in_turn_ = true;
  bool is_data_owed_ = false;

  // What its supply begins with, whenever that comes.
  std::optional<std::uint8_t> first_revision_;
  std::optional<std::int64_t> first_ticks_;
  bool is_new_to_link_time_ = true;
};

}  // namespace fieldproof::conformance
