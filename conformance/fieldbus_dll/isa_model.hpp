#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "conformance/fieldbus_dll/driven_dlpdus.hpp"
#include "conformance/fieldbus_dll/link_objection.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// What a data link entity of the profile ISA-D must say, told from what it heard and what its user wants: a
// model of the rules that shares nothing with the stations but their numbers. It does not act at instants; it
// says whether what the station says is one of the things that may come, and whether it may be silent. Its
// user never works on a reply.
//
//   ET   one frame of what is at least as urgent as the ET says, the most urgent first; then EE
//   ES   frames, as long as all that must follow them ends within the duration; then EE
//   CD   DT with what the user has for it, else without data
//   after a CD of its own: a reply, V(RR) of waiting, or another DLPDU, which ends its token
//
// What is said begins V(MID) after the last that was on the line, and V(RR) after it at the latest, a reply
// to a CD V(FD) after the CD.
namespace fieldproof::conformance {

class IsaModel {
 public:
  using Priority = fieldbus_dll::Priority;

  IsaModel(const fieldbus_dll::IsaRules& rules, std::uint8_t address) : rules_(rules), address_(address) {}

  // ---- the user; false: the station must refuse it ----
  bool submit(fieldbus_dll::IsaService service, Priority priority, std::uint8_t destination,
              const Octets& data);

  // ---- what was on the line until `end`; instants never decrease ----
  // Without a duration: for one frame.
  void hear_token(Priority least, std::optional<unsigned> duration, std::uint8_t from, kernel::Time end);
  void hear_cd(Priority least, std::uint8_t from, kernel::Time end);
  // Data of `from` for the station, in a DT: a reply where one is waited for.
  void hear_dt(std::uint8_t from, kernel::Time end);
  void hear_other(bool is_of_scheduler, kernel::Time end);
  void hear_noise(kernel::Time end) { silent_since_ = end; }

  // ---- what the station says ----
  std::optional<LinkObjection> say(const DrivenDlpdu& dlpdu);
  // It says nothing more, for as long as it may wait.
  std::optional<LinkObjection> be_silent();
  // It has compelled this station, which may reply now.
  std::optional<std::uint8_t> compelled() const;

 private:
  struct Request {
    bool compels;
    Priority priority;
    std::uint8_t destination;
    Octets data;
  };
  struct Token {
    std::uint8_t from;
    Priority least;
    std::optional<kernel::Time> ends;  // of an ES
    bool is_used = false;
  };
  struct Awaited {
    std::uint8_t node;
    kernel::Time until;
  };
  struct Answer {
    Priority least;
    std::uint8_t to;
    kernel::Time until;
  };
  using Queues = std::array<std::deque<Request>, 4>;  // by priority

  kernel::Duration times(std::int64_t octets) const { return fieldbus_dll::octets(rules_.link, octets); }
  kernel::Duration frame_of(std::size_t octets) const;
  kernel::Time earliest() const;
  static std::deque<Request>* most_urgent(Queues& queues, Priority least);
  bool is_another_dlpdu_for_waiting(kernel::Time end);
  bool fits(const Request& request, kernel::Time begin) const;
  Octets expected_reply();
  std::optional<LinkObjection> say_reply(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_under_token(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_request(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_end(const DrivenDlpdu& dlpdu);

  fieldbus_dll::IsaRules rules_;
  std::uint8_t address_;
  Queues to_send_;
  Queues replies_;
  kernel::Time silent_since_ = kernel::kStart;
  std::optional<Token> token_;
  std::optional<Awaited> awaited_;
  std::optional<Answer> answer_;
};

}  // namespace fieldproof::conformance
