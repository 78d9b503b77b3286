#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "conformance/fieldbus_dll/driven_dlpdus.hpp"
#include "conformance/fieldbus_dll/link_objection.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// What a live basic device must say, told from what it heard and what its user wants: a model of the rules
// that shares nothing with the stations but their numbers. It does not act at instants, as a station does; it
// says whether what the station says is one of the things that may come, and whether it may be silent.
//
//   PT of its own    DT1 of what is at least as urgent as the PT says, the most urgent first, each ending
//   within
//                    the duration; the token is returned by F or by RT as soon as nothing fits any more
//   CD of its own    DT3 with the buffer as it was written last, and with the number of its writes; else SR
//                    or nothing; without F an RT after it. Where it is written while the answer is due, what
//                    the answer would have been before each of these writes is right, too, but whole
//   PN of its own    PR
//   another DLPDU    an answer that has not begun is not due any more; one of a scheduler takes a token back
//   anything else    nothing; what is due waits for V(MID) of silence
//
// What is answered begins V(MID) after the last that was on the line, and V(MRD) x V(ST) after what asks
// for it at the latest.
namespace fieldproof::conformance {

class FfModel {
 public:
  using Priority = fieldbus_dll::Priority;

  explicit FfModel(const fieldbus_dll::FfConfiguration& configuration);

  // ---- the user ----
  // False: the station must refuse it.
  bool submit(Priority priority, const Octets& data);
  bool write(fieldbus_dll::FfAddress address, const Octets& data);

  // ---- what was on the line, from `begin` to `end`; instants never decrease ----
  void hear_token(Priority least, unsigned duration, kernel::Time end);
  void hear_cd(fieldbus_dll::FfAddress address, Priority priority, kernel::Time end);
  void hear_probe(kernel::Time end);
  // For others, or nothing to be answered.
  void hear_other(bool is_of_scheduler, kernel::Time end);
  void hear_noise(kernel::Time end) { silent_since_ = end; }

  // ---- what the station says ----
  std::optional<LinkObjection> say(const DrivenDlpdu& dlpdu);
  // It says nothing more, for as long as it may wait.
  std::optional<LinkObjection> be_silent();

 private:
  struct Token {
    Priority least;
    kernel::Time ends;
  };
  struct Answer {
    std::vector<Octets> allowed;  // any of these
    std::string reason;           // when it is another one
    kernel::Time until;
    bool may_be_left = false;
    std::optional<fieldbus_dll::FfAddress> published{};  // the buffer that it takes
    Priority priority = Priority::normal;                // of the CD
  };
  struct Buffer {
    Octets data;
    unsigned writes = 0;
  };
  struct Next {
    Priority priority;
    Octets data;
  };

  void hear_dlpdu(kernel::Time end);
  Octets dt3_of(fieldbus_dll::FfAddress address, Priority priority) const;
  kernel::Time earliest() const;
  kernel::Time latest_of_token() const;
  std::size_t most_data(Priority priority) const;
  kernel::Time end_of(std::size_t octets, kernel::Time begin) const;
  std::optional<Next> next_to_send() const;
  bool fits(const Next& next, kernel::Time begin) const;
  std::optional<LinkObjection> say_answer(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_under_token(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> say_data(const DrivenDlpdu& dlpdu);
  std::optional<LinkObjection> return_token(const DrivenDlpdu& dlpdu);

  fieldbus_dll::FfConfiguration configuration_;
  std::array<std::deque<Octets>, 4> queues_;  // by priority
  std::map<fieldbus_dll::FfAddress, Buffer> buffers_;
  kernel::Time silent_since_ = kernel::kStart;
  std::optional<Token> token_;
  std::optional<Answer> answer_;
};

}  // namespace fieldproof::conformance
