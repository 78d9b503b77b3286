#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "harness/iut/attached_case.hpp"
#include "harness/iut/served_station.hpp"

// A station of a shared line that has a user, between the bench and an implementation outside, in both
// directions and whatever the protocol:
//
//   port 0  the line: levels, reported when a transmission is over
//   port 2  the user: characters are the octets of what it asks for, and of what is reported to it
//
// Its timers depend on when others drive the line, so it asks for activity.
//
// UserLine is the bench's end of it; ServedUserLine is a station of ours as an implementation.
namespace fieldproof::iut {

inline constexpr unsigned kLinePort = 0;
inline constexpr unsigned kUserPort = 2;

// Words that an implementation writes.
inline constexpr Item kRefused = 0;  // within `power` or a request of the user: it is not taken
inline constexpr Item kEvent = 1;    // kind | whom it is about << 8

// Numbers in an octet string of the user, the high octet first.
void put_number(std::vector<std::uint8_t>& octets, std::uint64_t number, unsigned size);
std::uint64_t number_at(std::span<const std::uint8_t> octets, std::size_t at, unsigned size);

class UserLine {
 public:
  explicit UserLine(AttachedCase& attached) : attached_(attached) {}

  void wire(segment::Port& line) { line_ = &line; }
  void receive_levels(const line::Waveform& reception);
  void on_activity(bool begins, kernel::Time now);
  // Of the user. False: the implementation has refused it.
  bool ask(const std::vector<std::uint8_t>& request, kernel::Time now);
  // The supply, which begins and ends what the station does.
  bool start(kernel::Time now);
  void stop(kernel::Time now);
  // What is asked for at the moment is not taken. Misbehaviour where nothing is.
  void refuse();

  void on_time(kernel::Time now);
  kernel::Time next_time() const;

  // Throws kernel::Error for an implementation that does not ask for activity.
  void expect_activity() const;
  // What the implementation drives on the line, now or later.
  void transmit(unsigned port, line::Waveform& wave);
  // What is sent at the user's port, at most so much of it.
  static std::vector<std::uint8_t> reported_octets(std::span<const std::uint16_t> characters,
                                                   std::size_t most);

 protected:
  AttachedCase& attached() { return attached_; }
  void drive(line::Waveform&& wave);
  static void expect_line_port(unsigned port);

 private:
  template <typename Ask>
  bool is_taken(Ask&& ask) {
    is_asking_ = true;
    is_refused_ = false;
    ask();
    is_asking_ = false;
    return !is_refused_;
  }
  void drive_due(kernel::Time now);

  AttachedCase& attached_;
  segment::Port* line_ = nullptr;
  bool is_asking_ = false;
  bool is_refused_ = false;
  kernel::Time driven_until_ = kernel::kStart;
  std::deque<line::Waveform> ahead_;  // whose time has not come yet
};

template <typename Station>
class ServedUserLine : public ServedStation<Station> {
 public:
  Capabilities capabilities() const override { return {.senses_activity = true}; }
  void receive(unsigned, const line::Waveform& reception) override {
    this->act(reception.end(), [&] { this->station().receive(kLinePort, reception); });
  }
  void receive(unsigned, std::span<const Character> characters, kernel::Time now) override {
    std::vector<std::uint8_t> octets;
    for (const Character& one : characters) octets.push_back(static_cast<std::uint8_t>(one.data));
    if (octets.empty()) return;
    this->act(now, [&] {
      if (!asked(octets, now)) refuse(now);
    });
  }

 protected:
  virtual bool asked(const std::vector<std::uint8_t>& request, kernel::Time now) = 0;
  void refuse(kernel::Time now) { this->bench().write(kRefused, 1, now); }
  void report_to_user(const std::vector<std::uint8_t>& octets, kernel::Time when) {
    const kernel::Time now = this->not_past(when);
    this->bench().send(kUserPort, now, std::vector<std::uint16_t>(octets.begin(), octets.end()));
  }
  void report_event(std::uint64_t kind, std::uint64_t about, kernel::Time when) {
    this->bench().write(kEvent, kind | about << 8, this->not_past(when));
  }
};

}  // namespace fieldproof::iut
