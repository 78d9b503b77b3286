#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/isa_bench.hpp"
#include "conformance/fieldbus_dll/link_objection.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// What a data link entity of the profile ISA-D must say, told from what it heard and what its user wants: a
// model of the rules that shares nothing with the stations but their numbers and what octets are which DLPDU.
// It does not act at instants; it says whether what the station says is one of the things that may come, and
// whether it may be silent.
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

  void set_supply(bool is_on);
  bool has_supply() const { return has_supply_; }

  // ---- the user; false: the station must refuse it ----
  bool submit(fieldbus_dll::IsaService service, Priority priority, std::uint8_t destination,
              const Octets& data, kernel::Time now = kernel::kStart);
  // Data for a CD are being worked out.
  void work_on_reply(bool works) { works_ = works; }

  // ---- what was on the line until `end`; instants never decrease ----
  // The octets of a frame with a right check, whatever they are.
  void hear(const Octets& octets, kernel::Time begin, kernel::Time end);
  // Without a duration: for one frame.
  void hear_token(Priority least, std::optional<unsigned> duration, std::uint8_t from, kernel::Time end);
  void hear_cd(Priority least, std::uint8_t from, kernel::Time end);
  // Data of `from` for the station, in a DT: a reply where one is waited for.
  void hear_dt(std::uint8_t from, kernel::Time end);
  void hear_other(bool is_of_scheduler, kernel::Time end);
  void hear_noise(kernel::Time end);

  // ---- what the station says ----
  std::optional<LinkObjection> say(const DrivenDlpdu& dlpdu);
  // It says nothing more, for as long as it may wait.
  std::optional<LinkObjection> be_silent();
  // What its user must have been given since this was asked last.
  std::vector<IsaReport> take_reports() { return std::exchange(reports_, {}); }
  // When the duration of the token that it holds is over; nothing: there is no such token.
  std::optional<kernel::Time> token_end() const { return token_ ? token_->ends : std::nullopt; }
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
  void report(fieldbus_dll::IsaEventKind kind, std::uint8_t node) { reports_.push_back({{}, {kind, node}}); }
  void miss_reply();
  kernel::Duration delay() const;
  bool fits(const Request& request, kernel::Time begin) const;
  Octets expected_reply();
  std::optional<LinkObjection> say_reply(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_under_token(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_request(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_end(const DrivenDlpdu& dlpdu);

  fieldbus_dll::IsaRules rules_;
  std::uint8_t address_;
  bool has_supply_ = true;
  bool works_ = false;
  kernel::Time reply_since_ = kernel::kStart;  // when data for a CD came last
  std::optional<kernel::Duration> slowest_;    // longer than V(MID), so far
  std::vector<IsaReport> reports_;
  Queues to_send_;
  Queues replies_;
  kernel::Time silent_since_ = kernel::kStart;
  kernel::Time resumes_at_ = kernel::kStart;  // when its wait for a reply was over last
  std::optional<Token> token_;
  std::optional<Awaited> awaited_;
  std::optional<Answer> answer_;
};

}  // namespace fieldproof::conformance
