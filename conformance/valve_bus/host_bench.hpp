#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "conformance/line_bench.hpp"
#include "conformance/valve_bus/arrived_frames.hpp"
#include "conformance/valve_bus/declarations.hpp"
#include "conformance/valve_bus/driven_line.hpp"
#include "harness/judge/pics.hpp"
#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/device.hpp"

// The bench of one case for a host module of the valve bus: a line with the implementation under test (IUT),
// the lower tester in the place of all nodes, and the upper tester in the place of the PC.
//
// The lower tester hears what the IUT drives as it leaves it, frame by frame, and answers what the case says
// when it says so. Verdicts rest on that and on what the PC is told. Each case begins with a host that has
// been powered for a while and has nothing to do.
namespace fieldproof::conformance {

// What a case needs of the IUT and around it; absent: as the PICS says.
struct HostNeeds {
  std::optional<unsigned> dip{};
  std::optional<valve_bus::CharacterProfile> characters{};
  std::optional<bool> receives_own_echo{};
  std::optional<bool> acknowledged_writes{};
  std::optional<bool> verifies_writes{};
};

// Without a maker the reference plays.
using HostSetting = PlannedSetting<valve_bus::HostDevice, valve_bus::HostConfiguration>;

// The configuration of the IUT under these needs; `pics` has an answer to each item.
valve_bus::HostConfiguration host_configuration(const HostNeeds& needs, const judge::Pics& pics);

// A frame that the IUT has sent.
struct HostFrame {
  Transmission sent;
  kernel::Time start;        // of its first start bit
  kernel::Time end;          // of its last stop bit
  kernel::Duration silence;  // in front of it, at the IUT

  // The octets in front of the check. For frames of five octets only.
  valve_bus::Command command() const;
};

// What the PC was told.
struct HostEvent {
  kernel::Time when;
  std::variant<valve_bus::HostResponse, valve_bus::HostError> what;
};

std::string text_of(const HostEvent& told);
// "error 8 of ID 07: part of a command"
std::string text_of_error(const valve_bus::HostError& error);

class HostBench final : public LineBench, private valve_bus::HostApplication {
 public:
  HostBench(const HostNeeds& needs, const HostSetting& setting);

  // With the bit rate of the DIP switches as they were at power-up.
  const valve_bus::Rules& rules() const { return configuration_.rules; }
  iut::Capabilities capabilities() const { return host_->capabilities(); }
  // Of the instants of this frame.
  iut::TimingUncertainty doubt_of(const HostFrame& frame) const {
    return host_->uncertainty_of_request(frame.sent.driver_on);
  }
  const judge::Pics& pics() const { return pics_; }
  std::uint8_t random_id();
  valve_bus::Response random_response() { return {random_octet(), random_octet()}; }
  valve_bus::Command read_of(unsigned id, std::uint8_t data0 = 0, std::uint8_t data1 = 0) const {
    return {static_cast<std::uint8_t>(id), static_cast<std::uint8_t>(rules().read_command), data0, data1};
  }
  // With random data.
  valve_bus::Command write_to(unsigned id) {
    const auto [data0, data1] = random_response();
    return {static_cast<std::uint8_t>(id), static_cast<std::uint8_t>(rules().write_command), data0, data1};
  }
  kernel::Duration bits(std::int64_t count) const { return valve_bus::bits(rules(), count); }
  kernel::Duration characters(double count) const;
  kernel::Duration delimiter() const { return valve_bus::delimiter(rules()); }
  kernel::Duration time_out() const { return valve_bus::response_time_out(rules()); }
  // How much longer or shorter it may be, and how long a host rests after it has given up: 5 %.
  kernel::Duration time_out_tolerance() const { return time_out() / 20; }
  // Of a node that is neither quick nor slow.
  kernel::Duration turnaround_time() const { return delimiter() + 150 * kernel::kMicrosecond; }
  // In which a host that has been asked for something says it, or tells the PC that it cannot.
  kernel::Duration observation_timeout() const { return observation_timeout_; }

  // Throws iut::CannotBeDone at a real line: the case is about instants.
  void expect_exact_instants() const;

  // ---- upper tester: the PC ----
  void write(std::span<const std::uint8_t> octets);
  void write(std::initializer_list<std::uint8_t> octets) { write(std::span(octets.begin(), octets.size())); }
  void order(const valve_bus::Command& command);
  // At that instant, whatever is on the line then; nothing else is to be written later.
  void write_later(std::span<const std::uint8_t> octets, kernel::Duration later);
  std::size_t fifo_room() const { return host_->fifo_room(); }
  bool has_overflowed() const { return host_->has_overflowed(); }
  valve_bus::HostCounters counters(std::uint8_t id) const { return host_->counters(id); }
  // The next thing that the PC is told, waiting at most so long.
  std::optional<HostEvent> next_told(kernel::Duration within);
  bool was_told() const { return !told_.empty(); }
  // Runs until the PC has been told something or the IUT has begun to send, at most so long.
  void await(kernel::Duration within);

  void set_dip(unsigned position) { host_->set_dip(position); }
  // Power off and on, with the switches so; what was seen is forgotten.
  void restart(unsigned dip);

  // ---- lower tester: the nodes ----
  // The next frame that the IUT sends, waiting at most so long. Runs to the end of its last stop bit.
  std::optional<HostFrame> next_frame(kernel::Duration within);
  // Levels as the IUT drove them in the frame that was got last.
  const std::vector<line::Waveform>& last_waves() const { return last_waves_; }
  // Of an answer that is too late, after the last attempt of a read: as soon as the PC was told that there is
  // none. The host rests then for another 5 % of the time-out, and begins its next request at the earliest
  // when these are over. Waits for what the PC is told, at most so long.
  kernel::Duration late_turnaround_time();
  // Gives the line the octets, the first start bit so long after the last frame's last stop bit. Does not
  // run. Gives their end.
  kernel::Time answer(std::span<const std::uint8_t> octets, kernel::Duration turnaround_time);
  kernel::Time answer(const valve_bus::Response& response) { return answer(response, turnaround_time()); }
  kernel::Time answer(const valve_bus::Response& response, kernel::Duration turnaround_time) {
    return answer(octets_of(response), turnaround_time);
  }
  // Levels as they are, one a bit, at the same place.
  void answer_levels(const line::Levels& levels, kernel::Duration turnaround_time);
  // The octets without a gap, from now on; runs to their end.
  kernel::Time say(std::span<const std::uint8_t> octets);
  // The character as levels, one a bit, in a format that may be another.
  line::Levels levels_of(std::uint8_t octet, valve_bus::CharacterProfile profile) const;
  line::Levels levels_of(std::uint8_t octet) const { return levels_of(octet, rules().characters); }

  // What the nodes have been told to do by the frames that were got: to know a refresh.
  void note_write(const valve_bus::Command& command);
  bool is_refresh(const valve_bus::Command& command) const;

  // What has arrived at the IUT since `forget`.
  std::span<const ArrivedFrame> arrived() const { return arrived_.frames(); }

  // ---- stress ----
  void begin_stress(const fault::Stress& stress) {
    begin_stress_at(stress, place(), rules().bit_rate, now());
  }

  // Frames and what was told, up to now; what the nodes were told to do is kept.
  void clear_observations();

  // The case is over. What the IUT does then is still its verdict.
  void finish() { host_->end(); }
  // What the PC has ordered and was told, what the nodes and the IUT have driven: the last of it, in words.
  std::vector<std::string> decode_lines() const;

 private:
  HostBench(const HostNeeds& needs, const HostSetting& setting, judge::Pics pics);

  // What the nodes said, at the IUT.
  struct Span {
    kernel::Time start;
    kernel::Time end;
  };
  // What the tester did, as PC or as nodes.
  struct Deed {
    kernel::Time when;
    std::string_view what;  // "PC ordered"
    std::vector<std::uint8_t> octets{};
    std::size_t levels = 0;  // in the place of octets
  };
  using Seen = std::variant<HostFrame, HostEvent, Deed>;
  static kernel::Time time_of(const Seen& seen);
  std::string line_of(const Seen& seen) const;

  void on_response(const valve_bus::HostResponse& response, kernel::Time when) override;
  void on_error(const valve_bus::HostError& error, kernel::Time when) override;

  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return written_later_at_; }

  void expect_reachable() const;
  void adopt_rate(unsigned dip);
  void set_power(bool is_on);
  bool has_driven_by(kernel::Time limit);
  bool is_followed_by_a_tail(const Transmission& sent);
  void collect();
  HostFrame frame_of(Transmission sent);
  void note(Seen seen);

  judge::Pics pics_;
  valve_bus::HostConfiguration configuration_;
  valve_bus::CharacterCodec codec_;
  std::unique_ptr<valve_bus::HostDevice> host_;
  DrivenLine driven_;
  ArrivedFrames arrived_;
  kernel::Duration observation_timeout_{};

  std::deque<Transmission> frames_;  // that the case has not got yet
  std::vector<line::Waveform> last_waves_;
  std::vector<Span> said_;
  kernel::Time last_end_{};  // of the last stop bit of the frame that was got last
  std::deque<HostEvent> told_;
  std::vector<std::optional<valve_bus::Command>> writes_;
  std::deque<Seen> history_;  // the last of all
  std::vector<std::uint8_t> written_later_;
  kernel::Time written_later_at_ = kernel::kNever;
};

}  // namespace fieldproof::conformance
