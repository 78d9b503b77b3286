#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

// For tests: stations on one link, and somebody who says what the test wants. What stations say is told as
// text, "@40 EE 21 -> 10, nothing to send", in octet durations from the start.
namespace fieldproof::fieldbus_dll {

class TestLink : private segment::Station {
 public:
  // Something outside of the segment changed a station.
  void refresh() {
    for (const std::size_t seat : seats_) segment_.refresh(seat);
  }
  kernel::Time now() const { return segment_.now(); }
  void wait(std::int64_t octet_times) { segment_.run_for(octets(rules_, octet_times)); }
  // Until so many octet durations from the start.
  void run_to(std::int64_t octet_times) { segment_.run_until(kernel::kStart + octets(rules_, octet_times)); }
  // What stations have said since the last call.
  std::string heard() { return std::exchange(heard_, {}); }
  // The place of a station, by the order in which they were added.
  segment::MediumPort& place(std::size_t n) { return *places_[n]; }

 protected:
  explicit TestLink(const LinkRules& rules) : rules_(rules), end_(rules) {
    place_ = &line_.attach("test/in", segment_.attach(*this, "test"), 0, {});
    end_.wire(*place_);
  }

  segment::MediumPort& attach(segment::Station& station) {
    seats_.push_back(segment_.attach(station, "station"));
    segment::MediumPort& place =
        line_.attach("station/in" + std::to_string(seats_.back()), seats_.back(), 0, {});
    place.sense_activity();
    places_.push_back(&place);
    return place;
  }
  // From now on, and until it is over.
  void say_octets(const Octets& octets) { segment_.run_until(end_.transmit(octets, now())); }
  virtual std::string told(const Octets& octets) const = 0;

 private:
  void receive(segment::PortIndex, const line::Waveform& wave) override {
    for (const Arrived& arrived : end_.receive(wave)) {
      heard_ += "@" + std::to_string((arrived.begin - kernel::kStart) / octets(rules_, 1)) + " " +
                told(arrived.octets) + "\n";
    }
  }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  LinkRules rules_;
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  LineEnd end_;
  segment::MediumPort* place_ = nullptr;
  std::vector<std::size_t> seats_;
  std::vector<segment::MediumPort*> places_;
  std::string heard_;
};

// ---- ISA-D ----

class IsaTestLink final : public TestLink {
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

  IsaTestLink() : TestLink(IsaRules{}.link) {}

  User& add(IsaDevice& station) {
    User& user = users_.emplace_back();
    station.wire(attach(station), user);
    return user;
  }
  void say(const IsaDlpdu& dlpdu) { say_octets(octets_of(dlpdu, {})); }

 private:
  std::string told(const Octets& octets) const override {
    const auto dlpdu = isa_dlpdu_of(octets, {});
    return dlpdu ? describe(*dlpdu) : "no DLPDU";
  }
  std::deque<User> users_;
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

// ---- FF-P ----

class FfTestLink final : public TestLink {
 public:
  class User final : public FfUser {
   public:
    void on_data(const FfDlpdu& dlpdu, kernel::Time) override { told += describe(dlpdu) + "\n"; }
    void on_published(const FfDlpdu& dlpdu, kernel::Time) override { told += describe(dlpdu) + "\n"; }
    void on_event(const FfEvent& event, kernel::Time) override {
      told += std::string(text_of(event.kind)) + " " + std::to_string(event.node) + "\n";
    }
    std::string take() { return std::exchange(told, {}); }

    std::string told;
  };

  explicit FfTestLink(const FfRules& rules = {}) : TestLink(rules.link), rules_(rules) {}

  User& add(FfDevice& station) {
    User& user = users_.emplace_back();
    station.wire(attach(station), user);
    station.start(now());
    refresh();
    return user;
  }
  void say(const FfDlpdu& dlpdu) { say_octets(octets_of(dlpdu, rules_)); }

 private:
  std::string told(const Octets& octets) const override {
    const auto dlpdu = ff_dlpdu_of(octets, rules_);
    return dlpdu ? describe(*dlpdu) : "no DLPDU";
  }
  FfRules rules_;
  std::deque<User> users_;
};

inline FfDlpdu pt(std::uint8_t node, Priority least, std::uint16_t duration) {
  return {.type = FfType::pt, .priority = least, .node = node, .duration = duration};
}
inline FfDlpdu activation(std::uint8_t node) {
  return {.type = FfType::dt1,
          .priority = Priority::normal,
          .destination = address_of(node),
          .source = address_of(0x10),
          .data = {static_cast<std::uint8_t>(SpduKind::activation)}};
}

}  // namespace fieldproof::fieldbus_dll
