#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/iut/process.hpp"
#include "harness/iut/wall_clock.hpp"
#include "harness/line/character.hpp"

// A serial line of the machine in wall-clock time: a UART, or a pseudo terminal that stands in for one.
//
// A UART sends by itself at its bit rate. A pseudo terminal has neither bit rate nor parity, framing, breaks
// or a ninth bit: whoever writes into it hands over a block of characters when its last stop bit would have
// ended, and whoever reads takes them for characters that followed each other until then.
//
// Each stamp is an interval that holds the true instant. It is as wide as the process was kept from looking:
// a machine that is busy makes it wider and never wrong.
namespace fieldproof::iut {

struct SerialSettings {
  std::string path;
  std::optional<std::int64_t> bit_rate;         // absent: that of the case
  std::optional<line::CharacterFormat> format;  // absent: that of the case
  // What the way from the line to a read of the process may take beyond what stamps show; both ways.
  std::optional<kernel::Duration> latency;
  bool receives_own_echo = false;  // what this end sends comes back to it, as from a receiver that stays on
  std::string upper;               // URI of the upper tester's channel; empty: there is none
};

inline constexpr std::string_view kSerialUri = "serial:";

// "serial:/dev/ttyUSB0?baud=9600&format=8e1&latency=200us&upper=unix:/path"; `upper` is the last one, and all
// after it is its URI. Throws kernel::Error(usage) for what is no such URI.
SerialSettings serial_settings(const std::string& uri);

// "8e1": data bits, parity (n, e, o, m, s), stop bits. Nothing for other text.
std::optional<line::CharacterFormat> character_format_of(std::string_view text);

// Octets that were there at one look.
struct Arrival {
  Stamp stamp;  // the last of them became readable within it
  std::vector<std::uint8_t> octets;
};

class SerialLine {
 public:
  // Opens the device and takes it for itself. Throws kernel::Error(implementation) when it is not there, is
  // none, or is in use.
  SerialLine(const std::string& path, const WallClock& clock);
  // The other end of a pseudo terminal that is to be found at `link`, a name that is not there yet; it goes
  // with the line. Throws like the other one.
  static SerialLine at_new_terminal(const std::string& link, const WallClock& clock);
  SerialLine(SerialLine&& other) noexcept;
  SerialLine& operator=(SerialLine&&) = delete;
  ~SerialLine();

  bool is_terminal() const { return is_terminal_; }  // a pseudo terminal
  int descriptor() const;
  // "RS-485 direction by the driver", or why not.
  const std::string& direction() const { return direction_; }

  // From now on. Throws kernel::Error(implementation) for a rate or a format that the device does not take.
  void set(std::int64_t bit_rate, const line::CharacterFormat& format);
  void set_clock(const WallClock& clock);
  // While it waits it looks at least so often: how wide the stamps of arrivals are. Without it whoever waits
  // sleeps until something comes.
  void look_every(kernel::Duration step) { step_ = step; }

  // What is written comes back, and is taken away from what is read. Misbehaviour when something else comes.
  void set_echo(bool receives_own_echo) { receives_own_echo_ = receives_own_echo; }

  // Hands all over; gives when the last stop bit was on the line: by a UART that takes its time after the
  // call, at a terminal within it. Throws Misbehaviour when the device has gone or takes nothing.
  Stamp write(std::span<const std::uint8_t> octets);
  // What has arrived by `until`; waits for it. Nothing when nothing has. Throws Misbehaviour when the device
  // has gone. `also`: a descriptor that ends the waiting when it can be read.
  std::optional<Arrival> read(kernel::Time until, int also = -1);
  // All that has arrived and was not read is forgotten.
  void forget_arrived();

 private:
  struct Port;

  explicit SerialLine(const WallClock& clock);
  void open_device(const std::string& path);
  bool wait(kernel::Duration longest, short events, int also = -1) const;
  void set_rate(std::int64_t bit_rate, bool is_mark_or_space) const;
  void wait_until_sent() const;
  [[noreturn]] void blame_gone(const char* what, int error) const;

  WallClock clock_;
  std::unique_ptr<Port> port_;
  Descriptor master_;  // of a terminal that was made here
  Descriptor slave_;   // held open, so that nobody's coming and going is a hang-up
  std::string link_;
  std::string path_;
  std::string direction_;
  void take_echo(std::vector<std::uint8_t>& octets);

  bool is_terminal_ = false;
  bool receives_own_echo_ = false;
  std::deque<std::uint8_t> echo_;  // that has not come back yet
  kernel::Duration character_{};
  kernel::Duration step_ = kernel::Duration::max();
  kernel::Time last_look_{};  // at which nothing was there
};

// Whoever stamps instants should not wait for others: before them all from now on, this thread, where the
// system permits it. Lines ask for it when they are opened. False when it does not.
bool ask_for_real_time();

// Without waiting; true at the end of a stream, too.
bool can_be_read(int descriptor);

// How long it took, at worst of `rounds`, until what was written into a pseudo terminal of this machine could
// be read at its other end.
kernel::Duration measured_latency(unsigned rounds);

}  // namespace fieldproof::iut
