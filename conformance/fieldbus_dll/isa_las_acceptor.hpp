#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "conformance/fieldbus_dll/isa_bench.hpp"
#include "conformance/fieldbus_dll/link_objection.hpp"

// What a link master of the profile ISA-D may say as the scheduler, until when it must have said something,
// and what its user must be given: rules over what it said before, what others said and what its user wants.
// It shares nothing with the stations but their numbers and what octets are which DLPDU.
//
//   V(MID) of silence in front of each DLPDU
//   each item of the schedule in its order, within V(ST) of its time or of the instant at which the link is
//   free; a schedule begins with the station, and anew when the link is handed to it
//   nothing while a token is out: until its holder returns it, is silent for V(RR), or an ES is over (VC(UC))
//   nothing after a CD of its own until the reply, another DLPDU, or V(RR)
//   a reply to a CD of the holder within V(FD)
//   what its user submits goes between, the most urgent first, where it ends before the next item is due
//   a TL when it is ordered, and nothing after it until the heir shows itself, or is silent for V(RR)
//   nothing in standby: after a TL that was taken, or after a scheduler with a lower address
//   a sign of life within V(RR) when the link is handed to it
//
// A faulty answer, or one of somebody else, may be taken for a sign of life or for nothing; the acceptor
// holds the scheduler to neither.
namespace fieldproof::conformance {

class IsaLasAcceptor {
 public:
  using Priority = fieldbus_dll::Priority;
  using Found = std::optional<LinkObjection>;

  IsaLasAcceptor(const fieldbus_dll::IsaConfiguration& configuration, kernel::Time begin)
      : configuration_(configuration), begin_(begin), silent_since_(begin) {}

  // ---- the user ----
  // False: the station must refuse it.
  bool submit(fieldbus_dll::IsaService service, Priority priority, std::uint8_t destination,
              const Octets& data, kernel::Time now);
  void order_transfer(std::uint8_t heir, kernel::Time now);
  // What its user must have been given since this was asked last. Where two events are right, that of
  // `actual`, which it has been given.
  std::vector<IsaReport> take_reports(const std::vector<IsaReport>& actual);

  // ---- what others said, until `end`; instants never decrease ----
  // The octets of a frame with a right check, whatever they are.
  void hear(const Octets& octets, kernel::Time end);
  void hear_noise(kernel::Time end);

  // ---- what the station says ----
  Found say(const DrivenDlpdu& dlpdu);
  // It has said nothing until `silent_until`.
  LinkObjection silence() const;

  bool is_standby() const { return is_standby_; }
  // A token is over while it replied to its holder: its user is told then, or when it says something else.
  bool may_owe_event(kernel::Time now) const { return out_ && out_->may_from <= now; }
  // When a token or a TL that is out is over; without one it is over.
  kernel::Time out_until() const { return out_ ? out_->may_from : kernel::kStart; }
  // It may not be silent for longer; kNever in standby.
  kernel::Time silent_until() const;

 private:
  struct Request {
    bool compels;
    Priority priority;
    std::uint8_t destination;
    Octets data;
  };
  using Queues = std::array<std::deque<Request>, 4>;  // by priority
  // A token, or a TL, that is out.
  struct Out {
    std::uint8_t node;                   // its holder, or the heir
    kernel::Time may_from;               // it may go on from then
    kernel::Time must_by;                // and must by then
    std::optional<kernel::Time> over{};  // VC(UC) of an ES
    bool is_transfer = false;
    bool is_used = false;    // an ES whose duration is shorter than V(RR) counts as that
    bool is_unsure = false;  // whether its holder has used it
  };
  // A reply that the station waits for (of `node`), or owes (to it).
  struct Reply {
    std::uint8_t node;
    kernel::Time until;
    Priority least = Priority::time_available;
  };
  struct Due {
    IsaReport report;
    std::optional<IsaReport> other{};
  };

  const fieldbus_dll::IsaRules& rules() const { return configuration_.rules; }
  kernel::Duration times(std::int64_t octets) const { return fieldbus_dll::octets(rules().link, octets); }
  kernel::Duration frame_of(std::size_t octets) const;
  kernel::Duration slot() const { return times(rules().link.slot_time_octets); }
  kernel::Duration reply_wait() const { return times(rules().reply_wait_octets); }
  const fieldbus_dll::IsaScheduleItem& item() const { return configuration_.schedule.items[next_]; }
  kernel::Time due() const { return begin_ + item().at; }
  kernel::Time free_by() const;
  static Request* most_urgent(Queues& queues, Priority least);
  kernel::Duration needed_for(const Request& request) const;
  Octets delegation() const;
  void report(fieldbus_dll::IsaEventKind kind, std::uint8_t node) {
    reports_.push_back({{{}, {kind, node}}});
  }
  void hear_as_scheduler(const fieldbus_dll::IsaDlpdu& dlpdu, kernel::Time end);
  void hear_holder(fieldbus_dll::IsaType type, kernel::Time end);
  void hear_other(kernel::Time end);
  void hear_transfer(std::uint8_t from, kernel::Time end);
  void end_wait();
  Found say_reply(const DrivenDlpdu& dlpdu);
  Found say_dlpdu(const DrivenDlpdu& dlpdu);
  Found say_delegation(const DrivenDlpdu& dlpdu);
  Found say_transfer(const DrivenDlpdu& tl);
  Found say_request(const DrivenDlpdu& dlpdu, bool may_show_itself);

  fieldbus_dll::IsaConfiguration configuration_;
  kernel::Time begin_;  // of the schedule
  std::size_t next_ = 0;
  kernel::Time silent_since_;
  Queues to_send_;
  Queues replies_;
  kernel::Time submitted_ = kernel::kStart;  // the last one
  std::vector<Due> reports_;
  std::optional<Out> out_;
  std::optional<Reply> awaited_;
  std::optional<Reply> owed_;
  std::optional<std::uint8_t> ordered_;
  kernel::Time ordered_at_ = kernel::kStart;
  bool is_standby_ = false;
  bool has_shown_itself_ = true;
  bool may_show_itself_ = false;  // once, also after a TL that was not taken
};

}  // namespace fieldproof::conformance
