#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/character.hpp"
#include "harness/segment/station.hpp"
#include "protocols/valve_bus/device.hpp"
#include "protocols/valve_bus/frame.hpp"

// What a host module of the valve bus may send and tell, from what its PC ordered and from the characters
// that arrive, without the options of acknowledged and of verified writes:
//
//   it sends      what was ordered, in that order, a read up to three times; the last write of a node again
//                 and again; each frame with its check, and a delimiter behind the last character heard
//   it tells      the end of each read once, in order: what the first frame in the window said, if that frame
//   is
//                 three good characters of which the exclusive or is 0, or an error behind the last attempt,
//                 with what was known before; each refused order
//
// Anything else is a broken invariant. The characters come from the receiver of the house.
namespace fieldproof::fuzz {

class ValveHostModel final : public segment::Tap, public valve_bus::HostApplication {
 public:
  // With the bit rate of its switches in the rules.
  explicit ValveHostModel(const valve_bus::Rules& rules);

  // Whatever was ordered and heard is forgotten.
  void set_power(bool is_on);
  void order(const valve_bus::Command& command) { orders_.push_back(command); }
  void order_part() { ++parts_; }

  // What arrived at the host.
  void on_wave(const line::Waveform& wave) override;
  void run_until(kernel::Time now);
  void on_driven(const line::Waveform& wave);

  void on_response(const valve_bus::HostResponse& response, kernel::Time when) override;
  void on_error(const valve_bus::HostError& error, kernel::Time when) override;

  // Every order has been sent and has ended.
  bool is_done() const { return orders_.empty() && !read_ && parts_ == 0; }
  // A read has been sent and has not ended.
  bool is_reading() const { return read_.has_value(); }
  std::uint64_t requests() const { return requests_; }
  std::uint64_t responses() const { return responses_; }

 private:
  struct Frame {
    std::vector<std::uint8_t> octets;
    bool is_good = true;
    kernel::Time start{};
    kernel::Time busy_until{};
  };
  struct Read {
    valve_bus::Command command;
    unsigned attempts = 1;
    kernel::Time sent{};  // the end of its last stop bit
  };

  void on_request(const valve_bus::Command& command, kernel::Time start, kernel::Time end);
  void on_heard(const line::CharacterReceiver::Received& one);
  void end_frame();
  bool is_refused(const valve_bus::Command& command) const;
  void expect_no_answer_of(std::uint8_t id, valve_bus::HostErrorKind kind);

  valve_bus::Rules rules_;
  line::CharacterReceiver receiver_;
  line::CharacterReceiver request_receiver_;
  bool is_on_ = false;
  std::deque<valve_bus::Command> orders_;
  unsigned parts_ = 0;
  std::optional<Read> read_;
  std::array<std::optional<valve_bus::Command>, 256> written_{};
  std::array<std::optional<valve_bus::HostResponse>, 256> known_{};
  std::optional<valve_bus::HostResponse> owed_old_;  // to be told next

  std::vector<line::CharacterReceiver::Received> request_;  // as far as it has been driven
  kernel::Time driving_until_{kernel::Duration::min()};
  Frame frame_;
  std::vector<Frame> in_window_;  // that began in the window of the read, and are over
  kernel::Time heard_until_{kernel::Duration::min()};
  bool was_busy_ = false;  // the line, for a time-out since the last order ended: that costs attempts, too
  std::uint64_t requests_ = 0;
  std::uint64_t responses_ = 0;
};

}  // namespace fieldproof::fuzz
