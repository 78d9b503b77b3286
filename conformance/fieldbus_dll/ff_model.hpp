#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "conformance/fieldbus_dll/ff_bench.hpp"
#include "conformance/fieldbus_dll/link_objection.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// What a basic device of the profile FF-P must send and report, told from what it received and what its user
// wants: a model of the rules that shares nothing with the stations but their numbers and what octets are
// which DLPDU. It does not act at instants, as a station does; it says whether what the station sends is one
// of the things that may come, and whether it may be silent.
//
//   PT of its own    DT1 of what is at least as urgent as the PT says, the most urgent first, each ending
//   within
//                    the duration; F in the last one, after which nothing else fits or is there, returns the
//                    token; RT where none was sent, or after the last one where the settings say so
//   CD of its own    DT3 with the buffer as it was written last, and with the number of its writes; else SR.
//   Where it
//                    is written while the answer is due, what the answer would have been before each of these
//                    writes is right, too, but whole
//   PN of its own    PR
//   another DLPDU    an answer that has not begun is not due any more; one of a scheduler takes a token back
//   anything else    nothing; what is due waits for V(MID) of silence
//
// What is answered begins V(MID) after the last that was on the line, and V(MRD) x V(ST) after what asks for
// it at the latest. A station that takes some time more than V(MID) once may take it again: it fits less into
// its token, and an answer that noise delays it may leave.
namespace fieldproof::conformance {

class FfModel {
 public:
  using Priority = fieldbus_dll::Priority;

  // With supply; has it been activated?
  explicit FfModel(const fieldbus_dll::FfConfiguration& configuration, bool is_live = true);

  void set_supply(bool is_on);
  bool has_supply() const { return has_supply_; }

  // ---- the user ----
  // False: the station must refuse it.
  bool submit(const fieldbus_dll::FfRequest& request);
  bool write(fieldbus_dll::FfAddress address, const Octets& data);

  // ---- what was on the line until `end`; instants never decrease ----
  // The octets of a frame with a right check, whatever they are.
  void hear(const Octets& octets, kernel::Time end);
  void hear_noise(kernel::Time end) { silent_since_ = end; }

  // ---- what the station sends ----
  std::optional<LinkObjection> say(const DrivenDlpdu& dlpdu);
  // It sends nothing more, for as long as it may wait.
  std::optional<LinkObjection> be_silent();

  // What its user must have been given since this was asked last.
  std::vector<FfReport> take_reports() { return std::exchange(reports_, {}); }

 private:
  struct Token {
    Priority least;
    kernel::Time ends;
    bool is_used = false;
  };
  struct Answer {
    std::vector<Octets> allowed;  // any of these
    std::string reason;           // when it is another one
    kernel::Time until;
    std::optional<fieldbus_dll::FfAddress> published{};  // the buffer that it takes
    Priority priority = Priority::normal;                // of the CD
  };
  struct Buffer {
    Octets data;
    unsigned writes = 0;
    bool is_written = false;
  };

  void hear_data(const fieldbus_dll::FfDlpdu& dlpdu);
  void hear_cd(const fieldbus_dll::FfDlpdu& cd, kernel::Time until);
  bool is_mine(fieldbus_dll::FfAddress address) const {
    return fieldbus_dll::node_of(address) == configuration_.node;
  }
  Octets dt3_of(fieldbus_dll::FfAddress address, Priority priority) const;
  Octets dt1_of(const fieldbus_dll::FfRequest& request) const;
  kernel::Time earliest() const;
  // After this a station that is as slow as it has been begins no more.
  kernel::Duration delay() const;
  kernel::Time latest_of_token() const;
  std::size_t most_data(Priority priority) const;
  kernel::Time end_of(std::size_t octets, kernel::Time begin) const;
  std::deque<fieldbus_dll::FfRequest>* next_to_send();
  bool fits(const fieldbus_dll::FfRequest& next, kernel::Time begin) const;
  std::optional<LinkObjection> say_answer(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_under_token(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_data(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> return_token(const DrivenDlpdu& dlpdu);

  fieldbus_dll::FfConfiguration configuration_;
  bool has_supply_ = true;
  bool is_live_;
  std::array<std::deque<fieldbus_dll::FfRequest>, 4> queues_;  // by priority
  std::map<fieldbus_dll::FfAddress, Buffer> buffers_;
  kernel::Time silent_since_ = kernel::kStart;
  std::optional<kernel::Duration> slowest_;  // longer than V(MID), so far
  std::optional<Token> token_;
  std::optional<Answer> answer_;
  std::vector<FfReport> reports_;
};

}  // namespace fieldproof::conformance
