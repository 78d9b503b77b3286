#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "harness/iut/device.hpp"
#include "harness/iut/serial_line.hpp"
#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/device.hpp"
#include "protocols/valve_bus/transmitter.hpp"

// A local node of the bench that is a box at a serial line, in wall-clock time.
//
// The time of the case follows the clock of the machine by a margin: an instant of the case comes when all
// that the line had brought by then, and a margin later, has been read. So what the box says can be put where
// it was said. Frames of the tester are written as blocks when they are over; at each of them the time of the
// case is tied to the clock anew. What the box does is placed at the earliest instant at which it may have
// done it, and `doubt_of_answer` says how much later it can have been.
//
// What the line cannot do (levels, gaps inside frames, other bit rates, talking into an answer) is
// iut::CannotBeDone. Without an upper channel the bench does not see the valves, sets no switch, and finds
// the box as it is.
namespace fieldproof::valve_bus {

struct SerialAttachment {
  iut::SerialLine* line = nullptr;
  iut::Device* upper = nullptr;  // the upper tester's channel; null: there is none
  kernel::Duration latency{};    // of the way between the line and this process, each way
  std::shared_ptr<void> lease{};
  std::function<void()> on_well_ended{};
};

class SerialNode final : public NodeDevice, private iut::Bench {
 public:
  SerialNode(SerialAttachment attachment, const NodeConfiguration& configuration, const std::string& case_id,
             std::uint64_t seed);
  ~SerialNode() override;

  void wire(segment::Port& line, NodeBoards& boards) override;
  void set_power(bool is_on, kernel::Time now) override;
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;
  void end() override;

  NodeCapabilities reach() const override;
  TimingUncertainty doubt_of_answer(kernel::Time driver_on) const override;
  TimingUncertainty doubt_of_valves() const override {
    return {{}, anchor_.wall.latest - anchor_.wall.earliest};
  }

 private:
  // An instant of the case and when it was.
  struct Anchor {
    kernel::Time at{};
    iut::Stamp wall{};
  };
  struct Said {  // by the node, as it tells through the upper channel
    iut::Transmission transmission;
    kernel::Time written{};
  };
  struct Move {
    kernel::Time when{};
    std::uint16_t valves = 0;
  };
  struct Known {
    kernel::Time driver_on{};
    TimingUncertainty doubt;
  };

  template <typename Act>
  void guarded(Act&& act);
  kernel::Time wall_of(kernel::Time instant) const;
  kernel::Time instant_of(kernel::Time wall) const;

  // ---- the tester's side ----
  void expect_drivable(const line::Waveform& wave, const HeardCharacter& character) const;
  void expect_no_short_gap(kernel::Time start) const;
  [[noreturn]] void expect_an_answer() const;
  void flush(kernel::Time now);
  void wait_until_heard();

  // ---- the box's side ----
  void pump(kernel::Time now);
  void hear(const iut::Arrival& arrival);
  void ask_upper(kernel::Time until);
  void await_said();
  void place_said(kernel::Time now);
  void place_heard(kernel::Time now);
  void place_untold(kernel::Time now);
  void place(iut::Transmission transmission, kernel::Time earliest, kernel::Time latest, kernel::Time now);
  void move_due(kernel::Time now);

  void transmit(const iut::Transmission& transmission) override;
  void transmit(unsigned port, line::Waveform& wave) override;
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;

  SerialAttachment attachment_;
  NodeConfiguration configuration_;
  kernel::Duration character_;
  kernel::Duration step_;
  kernel::Duration margin_;
  iut::WallClock clock_;
  CharacterCodec codec_;
  line::CharacterCode code_;
  Transmitter transmitter_;
  segment::Port* port_ = nullptr;
  NodeBoards* boards_ = nullptr;
  Anchor anchor_;
  kernel::Time now_{};
  kernel::Time next_pump_{};
  bool is_supplied_ = false;
  bool is_well_ = true;
  bool has_ended_ = false;

  std::vector<std::uint8_t> pending_;  // of the tester, not yet written
  kernel::Time sent_until_{kernel::Duration::min()};
  std::uint64_t sent_ = 0;   // octets, of the tester
  std::uint64_t heard_ = 0;  // of these, by the node

  std::deque<iut::Arrival> arrivals_;
  std::uint64_t arrived_ = 0;         // octets, of the box
  std::uint64_t said_ = 0;            // as it tells
  std::uint64_t arrived_before_ = 0;  // the last frame of the tester
  std::deque<Said> told_;
  kernel::Time told_until_{kernel::Duration::min() / 2};  // driver off, as it told
  std::deque<Move> moves_;
  std::deque<Known> known_;
  kernel::Time said_until_{kernel::Duration::min() / 2};  // as placed
};

}  // namespace fieldproof::valve_bus
