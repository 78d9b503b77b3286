#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "harness/iut/attached_case.hpp"
#include "harness/iut/device.hpp"
#include "harness/iut/serial_line.hpp"
#include "harness/iut/uart_line.hpp"

// A box at a serial line as an implementation, in wall-clock time, in any role whose line (port 0) carries
// the characters of a UART. What is asked of it at other ports goes through the upper channel.
//
// The time of the case follows the clock of the machine by a margin: an instant of the case comes when all
// that the line had brought by then, and a margin later, has been read. So what the box sends can be put
// where it was sent. Frames of the tester are written as blocks when they are over; at each of them the time
// of the case is tied to the clock anew. What the box does is placed at the earliest instant at which it may
// have done it, and `set_uncertainty` says how much later it can have been.
//
// A box that asks by itself waits for its answer by its own clock. An answer of the tester that it receives
// too late is InDoubt.
//
// What the line cannot do (gaps inside frames, wrong characters, talking into an answer) is CannotBeDone.
// Without an upper channel the bench does not see the process side and finds the box as it is.
namespace fieldproof::iut {

struct SerialAttachment {
  SerialLine* line = nullptr;
  Device* upper = nullptr;     // the upper tester's channel; null: there is none
  kernel::Duration latency{};  // of the way between the line and this process, each way
};

class WallClockDevice final : public Device, private Bench {
 public:
  WallClockDevice(const SerialAttachment& attachment, MakeUartLine make_uart)
      : attachment_(attachment), make_uart_(make_uart) {}

  UnitKind unit_kind() const override { return UnitKind::characters; }
  Capabilities capabilities() const override;
  bool begin(const CaseBegin& begin, Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;
  void receive(unsigned port, std::span<const Character> characters, kernel::Time now) override;
  void receive(unsigned port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;
  void end() override;

 private:
  // An instant of the case and when it was.
  struct Anchor {
    kernel::Time at{};
    Stamp wall{};
  };
  struct Sent {  // by the box, as it reports through the upper channel
    UartTransmission transmission;
    kernel::Time written{};
  };
  struct Written {  // an item
    kernel::Time when{};
    Item item = 0;
    std::uint64_t value = 0;
  };

  void set_line(const UartLine& uart);
  void set_anchor(const Anchor& anchor);
  kernel::Time wall_of(kernel::Time instant) const { return anchor_.wall.latest + (instant - anchor_.at); }
  kernel::Time instant_of(kernel::Time wall) const { return anchor_.at + (wall - anchor_.wall.latest); }

  // ---- the tester's side ----
  void ask(unsigned port, std::span<const Character> characters, kernel::Time now);
  void send(const Character& character);
  void expect_no_short_gap(kernel::Time start) const;
  [[noreturn]] void expect_an_answer() const;
  void flush(kernel::Time now);
  void expect_in_time(kernel::Time received) const;
  void wait_until_received();

  // ---- the box's side ----
  void pump(kernel::Time now);
  void expect_no_delay(kernel::Duration delay) const;
  void keep(const Arrival& arrival);
  void ask_upper(kernel::Time until) { attachment_.upper->on_time(until); }
  void await_reported();
  void place_reported(kernel::Time now);
  void place_arrived(kernel::Time now);
  void place_unreported(kernel::Time now);
  void place(UartTransmission transmission, kernel::Time earliest, kernel::Time latest, kernel::Time now);
  void write_due(kernel::Time now);

  // ---- what the box reports through the upper channel ----
  void set_driver(unsigned port, bool is_on, kernel::Time at) override;
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override;
  void transmit(unsigned port, line::Waveform& wave) override;
  void write(Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(Item item, kernel::Time when) override;

  SerialAttachment attachment_;
  MakeUartLine make_uart_;
  Bench* bench_ = nullptr;
  UartLine uart_;
  kernel::Duration character_{};
  kernel::Duration step_{};
  kernel::Duration margin_{};
  WallClock clock_;
  Anchor anchor_;
  kernel::Time now_{};
  kernel::Time next_pump_{};
  bool is_supplied_ = false;

  std::vector<std::uint8_t> pending_;  // of the tester, not yet written
  kernel::Time sent_until_{kernel::Duration::min()};
  kernel::Time sent_from_{};  // of what is pending, or was written last
  kernel::Duration asked_before_ =
      kernel::Duration::max();              // this, as the case has it: the box's last stop bit
  kernel::Time asked_at_ = kernel::kNever;  // and when that was
  bool is_asking_ = false;
  bool was_asked_ = false;      // since power-up
  std::uint64_t sent_ = 0;      // octets, of the tester
  std::uint64_t received_ = 0;  // of these, by the box

  std::deque<Arrival> arrivals_;
  std::uint64_t arrived_ = 0;         // octets, of the box
  std::uint64_t reported_ = 0;        // of these, as it reports
  std::uint64_t arrived_before_ = 0;  // the last frame of the tester
  std::deque<Sent> reports_;
  kernel::Time reported_on_ = kernel::kNever;                 // its driver, as it reported last
  kernel::Time reported_until_{kernel::Duration::min() / 2};  // driver off, as it reported
  std::deque<Written> writes_;
  kernel::Time driven_until_{};                             // as placed
  kernel::Time placed_until_{kernel::Duration::min() / 2};  // without the driver
  kernel::Time ended_at_ = kernel::kNever;                  // the last of these, as the box reports
};

}  // namespace fieldproof::iut
