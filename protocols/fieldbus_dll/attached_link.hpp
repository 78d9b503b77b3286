#pragma once

#include <cstdint>
#include <deque>
#include <span>

#include "harness/iut/attached_case.hpp"
#include "harness/iut/served_station.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

// The line of the data link as an implementation outside hears and drives it, whatever its profile and role.
//
//   port 0  the line: levels that are half a bit wide, told when a transmission is over; or telegrams, which
//           are the octets of a frame, its check among them, without preamble and delimiters
//   port 1  one character when others begin to drive the line (1) and when they cease (0)
//   port 2  the user: characters are the octets of what it asks for, and of what it is told
//
// An implementation that hears frames is no receiver of its own: a case that drives anything but whole
// frames, as this link has them, does not apply to it.
namespace fieldproof::fieldbus_dll {

inline constexpr unsigned kLinePort = 0;
inline constexpr unsigned kActivityPort = 1;
inline constexpr unsigned kUserPort = 2;

// Words that an implementation writes or reads, in each role.
inline constexpr iut::Item kRefused = 0;  // told within `power` or a request of the user: it is not taken
inline constexpr iut::Item kEvent = 1;    // told: kind | node << 8

// Numbers in an octet string of the user, the high octet first.
void put_number(Octets& octets, std::uint64_t number, unsigned size);
std::uint64_t number_at(std::span<const std::uint8_t> octets, std::size_t at, unsigned size);

class AttachedLink {
 public:
  // Throws kernel::Error for an implementation that announces characters.
  AttachedLink(iut::AttachedCase& attached, const LinkRules& rules);

  void wire(segment::Port& line) { line_ = &line; }
  void receive(const line::Waveform& reception);
  void on_activity(bool begins, kernel::Time now);
  // Of the user. False: the implementation has refused it.
  bool ask(const Octets& request, kernel::Time now);
  // The supply, which begins and ends what the station does.
  bool start(kernel::Time now);
  void stop(kernel::Time now);
  // What is asked for at the moment is not taken. Misbehaviour where nothing is.
  void refuse();

  void on_time(kernel::Time now);
  kernel::Time next_time() const;

  // What the implementation drives on the line, now or later.
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters);
  void transmit(unsigned port, line::Waveform& wave);
  // What is sent at the user's port.
  static Octets told_octets(std::span<const std::uint16_t> characters);

 private:
  template <typename Ask>
  bool is_taken(Ask&& ask) {
    is_asking_ = true;
    is_refused_ = false;
    ask();
    is_asking_ = false;
    return !is_refused_;
  }
  bool hears_frames() const { return attached_.unit_kind() == iut::UnitKind::telegrams; }
  void tell_frame(const line::Waveform& reception);
  line::Waveform wave_of(std::span<const std::uint8_t> octets, kernel::Time start) const;
  void drive(line::Waveform&& wave);
  void drive_due(kernel::Time now);

  iut::AttachedCase& attached_;
  LinkRules rules_;
  line::DelimitedFrameCode code_;
  segment::Port* line_ = nullptr;
  bool is_asking_ = false;
  bool is_refused_ = false;
  kernel::Time driven_until_ = kernel::kStart;
  std::deque<line::Waveform> ahead_;  // whose time has not come yet
};

// A station of ours, as an implementation: what both profiles share.
template <typename Station>
class ServedLink : public iut::ServedStation<Station> {
 public:
  void receive(unsigned, const line::Waveform& reception) override {
    this->act(reception.end(), [&] { this->station().receive(kLinePort, reception); });
  }
  void receive(unsigned port, std::span<const iut::Character> characters, kernel::Time now) override {
    Octets octets;
    for (const iut::Character& one : characters) octets.push_back(static_cast<std::uint8_t>(one.data));
    if (octets.empty()) return;
    this->act(now, [&] {
      if (port == kActivityPort) {
        this->station().on_activity(kLinePort, octets.front() != 0, now);
      } else if (!asked(octets, now)) {
        refuse(now);
      }
    });
  }

 protected:
  virtual bool asked(const Octets& request, kernel::Time now) = 0;
  void refuse(kernel::Time now) { this->bench().write(kRefused, 1, now); }
  void tell_user(const Octets& octets, kernel::Time when) {
    const kernel::Time now = this->not_past(when);
    this->bench().send(kUserPort, now, std::vector<std::uint16_t>(octets.begin(), octets.end()));
  }
  void tell_event(std::uint64_t kind, std::uint8_t node, kernel::Time when) {
    this->bench().write(kEvent, kind | std::uint64_t{node} << 8, this->not_past(when));
  }
};

}  // namespace fieldproof::fieldbus_dll
