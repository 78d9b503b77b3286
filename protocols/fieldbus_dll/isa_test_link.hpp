#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

// For tests: stations of the profile ISA-D on one link, and somebody who says what the test wants. What is on
// the line is told as text, "@40 EE 21 -> 10, nothing to send", in octet durations from the start.
namespace fieldproof::fieldbus_dll {

class IsaTestLink : private segment::Station {
 public:
  class User final : public IsaUser {
   public:
    void on_data(const IsaDlpdu& dlpdu, kernel::Time) override { told += describe(dlpdu) + "\n"; }
    void on_event(const IsaEvent& event, kernel::Time) override {
      told += std::string(text_of(event.kind)) + " " + std::to_string(event.node) + "\n";
    }
    bool is_reply_coming(Priority, kernel::Time) override { return works_on_reply; }
    std::string take() { return std::exchange(told, {}); }

    std::string told;
    bool works_on_reply = false;
  };

  IsaTestLink() {
    seat_ = segment_.attach(*this, "test");
    place_ = &line_.attach("test/in", seat_, 0, {});
    end_.wire(*place_);
  }

  User& add(IsaDevice& station) {
    const std::size_t seat = segment_.attach(station, "station");
    segment::MediumPort& place = line_.attach("station/in" + std::to_string(seat), seat, 0, {});
    place.sense_activity();
    stations_.push_back({&station, seat});
    User& user = users_.emplace_back();
    station.wire(place, user);
    return user;
  }

  // Something outside of the segment changed a station.
  void refresh() {
    for (const auto& [station, seat] : stations_) segment_.refresh(seat);
  }
  kernel::Time now() const { return segment_.now(); }
  void wait(std::int64_t octet_times) { segment_.run_for(octets(rules_.link, octet_times)); }
  // From now on, and until it is over.
  void say(const IsaDlpdu& dlpdu) {
    const kernel::Time end = end_.transmit(octets_of(dlpdu, rules_), now());
    segment_.run_until(end);
  }
  // What stations have said since the last call.
  std::string heard() { return std::exchange(heard_, {}); }

 private:
  void receive(segment::PortIndex, const line::Waveform& wave) override {
    for (const Arrived& arrived : end_.receive(wave)) {
      const auto dlpdu = isa_dlpdu_of(arrived.octets, rules_);
      heard_ += "@" + std::to_string((arrived.begin - kernel::kStart) / octets(rules_.link, 1)) + " " +
                (dlpdu ? describe(*dlpdu) : "no DLPDU") + "\n";
    }
  }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  IsaRules rules_;
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  LineEnd end_{rules_.link};
  std::size_t seat_ = 0;
  segment::MediumPort* place_ = nullptr;
  std::vector<std::pair<IsaDevice*, std::size_t>> stations_;
  std::deque<User> users_;
  std::string heard_;
};

// Addresses and DLPDUs of tests.
inline constexpr std::uint8_t kNode = 0x21;

inline IsaDlpdu token(IsaType type, Priority least, std::uint8_t node, std::uint16_t duration = 0,
                      std::uint8_t from = 0x10) {
  return {.type = type, .priority = least, .destination = node, .source = from, .duration = duration};
}
inline IsaDlpdu cd(std::uint8_t node, std::uint8_t from) {
  return {.type = IsaType::cd, .priority = Priority::normal, .destination = node, .source = from};
}
inline IsaDlpdu data(IsaType type, std::uint8_t node, std::uint8_t from, Octets octets) {
  return {.type = type,
          .priority = Priority::normal,
          .is_final = type == IsaType::dt,
          .destination = node,
          .source = from,
          .data = std::move(octets)};
}

}  // namespace fieldproof::fieldbus_dll
