#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "conformance/fieldbus_dll/driven_dlpdus.hpp"
#include "conformance/fieldbus_dll/link_objection.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// What a link master of the profile ISA-D may say as the scheduler, and until when it must have said
// something: rules over what it said before, what others said and what its user wants. It shares nothing with
// the stations but their numbers.
//
//   V(MID) of silence in front of each DLPDU
//   each item of the schedule in its order, within V(ST) of its time or of the instant at which the link is
//   free; a schedule begins with the station, and anew when the link is handed to it
//   nothing while a token is out: until its holder returns it, is silent for V(RR), or an ES is over (VC(UC))
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
  bool submit(Priority priority, std::uint8_t destination, const Octets& data, kernel::Time now);
  void order_transfer(std::uint8_t heir);

  // ---- what others said, until `end`; instants never decrease ----
  void hear_return(kernel::Time end);  // of the holder
  void hear_data(kernel::Time end);    // of the holder
  void hear_cd(kernel::Time end);      // of the holder, which waits for a reply
  void hear_other(kernel::Time end);   // of anybody, or with faults
  void hear_heir(kernel::Time end);
  void hear_scheduler(std::uint8_t address, kernel::Time end);
  void hear_transfer(kernel::Time end);  // a TL for the station

  // ---- what the station says ----
  Found say(const DrivenDlpdu& dlpdu);

  bool is_standby() const { return is_standby_; }
  // It may not be silent for longer; kNever in standby.
  kernel::Time silent_until() const;

 private:
  struct Request {
    Priority priority;
    std::uint8_t destination;
    Octets data;
  };
  // A token, or a TL, that is out.
  struct Out {
    kernel::Time may_from;             // it may go on from then
    kernel::Time must_by;              // and must by then
    std::optional<kernel::Time> over;  // VC(UC) of an ES
    std::optional<std::uint8_t> heir;  // of a TL
  };

  const fieldbus_dll::IsaRules& rules() const { return configuration_.rules; }
  kernel::Duration times(std::int64_t octets) const { return fieldbus_dll::octets(rules().link, octets); }
  kernel::Duration slot() const { return times(rules().link.slot_time_octets); }
  kernel::Duration reply_wait() const { return times(rules().reply_wait_octets); }
  const fieldbus_dll::IsaScheduleItem& item() const { return configuration_.schedule.items[next_]; }
  kernel::Time due() const { return begin_ + item().at; }
  kernel::Time free_by() const;
  const Request* most_urgent() const;
  bool surely_fits(const Request& request, kernel::Time from) const;
  Octets delegation() const;
  Found say_dlpdu(const DrivenDlpdu& dlpdu);
  Found say_delegation(const DrivenDlpdu& dlpdu);
  Found say_transfer(const DrivenDlpdu& tl);
  Found say_data(const DrivenDlpdu& du, bool may_show_itself);

  fieldbus_dll::IsaConfiguration configuration_;
  kernel::Time begin_;  // of the schedule
  std::size_t next_ = 0;
  kernel::Time silent_since_;
  std::array<std::deque<Request>, 4> queues_;  // by priority
  kernel::Time submitted_ = kernel::kStart;    // the last one
  std::optional<Out> out_;
  std::optional<std::uint8_t> ordered_;
  bool is_standby_ = false;
  bool has_shown_itself_ = true;
  bool may_show_itself_ = false;  // once, also after a TL that was not taken
};

}  // namespace fieldproof::conformance
