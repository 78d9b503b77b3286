// A basic device of the profile FF-P on a link, fed with arbitrary content.
//
// Input: a script. Its first octet chooses the link and the device (silence between frames, preamble, slot
// time, long addresses), then each step is an octet that chooses what comes, and its parameters: tokens, CD,
// probes, activations, times and data with a check that fits, any octets in a frame, several frames in one
// transmission, levels as wide as half bits or otherwise, all of them with a half bit flipped if the step
// says so, silence, what the user submits and writes. Invariants: the device says what the model
// (ff_device_model.hpp) says, octet by octet, at its instants, and nothing else; so it tells its user; when
// the line is clean again, all that was submitted is sent and the token is returned.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fuzz/ff_device_model.hpp"
#include "fuzz/link_line.hpp"
#include "fuzz/octet_reader.hpp"
#include "fuzz/script.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/fieldbus_dll/ff_station.hpp"

namespace {

using fieldproof::fieldbus_dll::FfConfiguration;
using fieldproof::fieldbus_dll::FfDlpdu;
using fieldproof::fieldbus_dll::FfEvent;
using fieldproof::fieldbus_dll::FfEventKind;
using fieldproof::fieldbus_dll::FfStation;
using fieldproof::fieldbus_dll::Priority;
using fieldproof::fuzz::FfDeviceModel;
using fieldproof::fuzz::FfIndication;
using fieldproof::fuzz::LinkEar;
using fieldproof::fuzz::LinkLine;
using fieldproof::fuzz::LinkOctets;
using fieldproof::fuzz::OctetReader;
using fieldproof::kernel::Time;

constexpr unsigned kMostSteps = 48;
constexpr std::uint8_t kFfNode = 0x21;
// What it publishes, what it does not, and what is of others.
constexpr std::array<std::uint32_t, 8> kAddresses{0x2120, 0x2121, 0x00072130, 0x2122,
                                                  0x2220, 0x2230, 0x00092240, 0xFFFF};

FfConfiguration ff_configuration(std::uint8_t choice) {
  FfConfiguration made;
  made.node = kFfNode;
  made.published = {kAddresses[0], kAddresses[1], kAddresses[2]};
  made.subscribed = {kAddresses[4], kAddresses[6]};
  auto& link = made.rules.link;
  constexpr std::array<unsigned, 4> kSilences{8, 0, 1, 24};
  link.inter_pdu_delay_octets = kSilences.at(choice % 4U);
  link.preamble_octets = (choice & 4U) != 0 ? 8 : 1;
  link.response_delay_slots = (choice & 8U) != 0 ? 11 : 4;
  made.supports_long_addresses = (choice & 16U) == 0;
  if ((choice & 32U) != 0) link.bit_rate = 2'500'000;
  return made;
}

class FfUserLog final : public fieldproof::fieldbus_dll::FfUser {
 public:
  explicit FfUserLog(const FfConfiguration& configuration) : configuration_(configuration) {}
  void on_data(const FfDlpdu& dlpdu, Time when) override { add(FfIndication::Kind::data, dlpdu, when); }
  void on_published(const FfDlpdu& dlpdu, Time when) override {
    add(FfIndication::Kind::published, dlpdu, when);
  }
  void on_event(const FfEvent& event, Time when) override {
    const bool is_activated = event.kind == FfEventKind::activated && event.node == configuration_.node;
    FIELDPROOF_CHECK(is_activated, "a basic device tells of nothing but its activation");
    told.push_back({FfIndication::Kind::activated, when, {}});
  }

  std::vector<FfIndication> told;

 private:
  void add(FfIndication::Kind kind, const FfDlpdu& dlpdu, Time when) {
    told.push_back({kind, when, octets_of(dlpdu, configuration_.rules)});
  }
  FfConfiguration configuration_;
};

class FfDeviceWorld final : private LinkLine {
 public:
  explicit FfDeviceWorld(std::uint8_t choice)
      : LinkLine(ff_configuration(choice).rules.link, choice),
        configuration_(ff_configuration(choice)),
        user_(configuration_),
        device_(configuration_),
        model_(configuration_),
        ear_(configuration_.rules.link) {
    seat_ = segment().attach(device_, "device");
    auto& place = medium().attach("device/in", seat_, 0, {});
    place.sense_activity();
    place.tap_arrived(model_);
    place.tap_driven(ear_);
    device_.wire(place, user_);
    FIELDPROOF_CHECK(device_.start(now()), "these rules are possible");
    segment().refresh(seat_);
    if ((choice & 64U) == 0) activate(0);
  }

  void step(OctetReader& input) {
    act(input);
    compare();
  }
  void recover();

 private:
  void follow(Time now) override { model_.run_until(now); }
  void on_begin(Time now) override { model_.on_begin(now); }

  static LinkOctets data_of(std::size_t size) { return LinkOctets(size, static_cast<std::uint8_t>(size)); }
  // `kind` with its address bits, and the address, of which there may be two.
  static void append_address(LinkOctets& octets, std::uint32_t address, bool is_long) {
    for (int shift = is_long ? 24 : 8; shift >= 0; shift -= 8)
      octets.push_back(static_cast<std::uint8_t>(address >> shift));
  }
  static std::uint8_t control(unsigned kind, unsigned choice, bool is_long) {
    const unsigned priority = choice % 3U + 1;
    return static_cast<std::uint8_t>(kind | priority | (choice & 4U) | (is_long ? 8U : 0U));
  }

  void activate(std::uint8_t flip) { send(LinkOctets{0xD2, kFfNode, 0, 0x10, 0, 1}, flip); }
  void pass_token(std::uint8_t least, std::uint16_t duration, std::uint8_t flip);
  void compel(OctetReader& input, std::uint8_t flip);
  void data(OctetReader& input, std::uint8_t flip);
  void publish(OctetReader& input, std::uint8_t flip);
  void submit(unsigned priority, std::uint32_t destination, const LinkOctets& data);
  void write(std::uint32_t address, const LinkOctets& data);
  void act(OctetReader& input);
  void compare();

  FfConfiguration configuration_;
  FfUserLog user_;
  FfStation device_;
  FfDeviceModel model_;
  LinkEar ear_;
  std::size_t seat_ = 0;
};

void FfDeviceWorld::pass_token(std::uint8_t least, std::uint16_t duration, std::uint8_t flip) {
  send(LinkOctets{control(0x30, least, false), kFfNode, static_cast<std::uint8_t>(duration >> 8),
                  static_cast<std::uint8_t>(duration & 0xFF)},
       flip);
}

void FfDeviceWorld::compel(OctetReader& input, std::uint8_t flip) {
  const std::uint8_t choice = input.octet();
  const std::uint32_t address = kAddresses.at(choice % kAddresses.size());
  LinkOctets octets{control(0xA0, choice >> 3, address > 0xFFFF)};
  append_address(octets, address, address > 0xFFFF);
  send(octets, flip);
}

void FfDeviceWorld::data(OctetReader& input, std::uint8_t flip) {
  const std::uint8_t choice = input.octet();
  constexpr std::array<std::uint32_t, 6> kDestinations{0x2100, 0x2120,     0xFFFF,
                                                       0x2200, 0x00032100, 0x0001FFFF};
  const std::uint32_t to = kDestinations.at((choice >> 3) % kDestinations.size());
  const bool is_long = to > 0xFFFF;
  LinkOctets octets{control(0xD0, choice, is_long)};
  append_address(octets, to, is_long);
  const std::uint8_t from = input.octet();
  append_address(octets, (is_long ? 0x00031000U : 0x1000U) | (from & 1U), is_long);
  const auto content = input.take((from >> 1) % 8U);
  octets.insert(octets.end(), content.begin(), content.end());
  send(octets, flip);
}

void FfDeviceWorld::publish(OctetReader& input, std::uint8_t flip) {
  const std::uint8_t choice = input.octet();
  const std::uint32_t address = kAddresses.at(choice % kAddresses.size());
  LinkOctets octets{control(0x50, choice >> 3, address > 0xFFFF)};
  append_address(octets, address, address > 0xFFFF);
  const LinkOctets content = data_of(input.octet());
  octets.push_back(choice);
  octets.insert(octets.end(), content.begin(), content.end());
  send(octets, flip);
}

void FfDeviceWorld::submit(unsigned priority, std::uint32_t destination, const LinkOctets& data) {
  const bool is_taken = device_.submit({static_cast<Priority>(priority), destination, data}, now());
  FIELDPROOF_CHECK(is_taken == model_.submit(priority, destination, data), "data is taken when it fits");
  segment().refresh(seat_);
}

void FfDeviceWorld::write(std::uint32_t address, const LinkOctets& data) {
  const bool is_taken = device_.write(address, data, now());
  FIELDPROOF_CHECK(is_taken == model_.write(address, data), "a buffer of its own is taken when it fits");
  segment().refresh(seat_);
}

void FfDeviceWorld::act(OctetReader& input) {
  const auto [kind_of_step, flip] = fieldproof::fuzz::read_choice(input, 16);
  switch (kind_of_step) {
    case 0: {
      const std::uint8_t least = input.octet();
      return pass_token(least, input.word(), flip);
    }
    case 1:
      return compel(input, flip);
    case 2: {
      const std::uint8_t node = input.octet();
      return send(LinkOctets{0x26, (node & 1U) != 0 ? node : kFfNode}, flip);
    }
    case 3:
      return activate(flip);
    case 4: {
      LinkOctets octets{0x11};
      for (int n = 0; n < 6; ++n) octets.push_back(input.octet());
      return send(octets, flip);
    }
    case 5:
      return data(input, flip);
    case 6:
      return publish(input, flip);
    case 7:
      return send(input.take(input.octet() % 32U), flip);
    case 8:
      return send_together(input, flip);
    case 9:
      return levels(input, 2 * configuration_.rules.link.bit_rate, flip);
    case 10:
      return levels(input, fieldproof::fuzz::read_rate(input), flip);
    case 11:
      return pass(octet_times(input.octet()));
    case 12:
      return pass(octet_times(std::int64_t{input.octet()} * 64));
    case 13:
      // Parts of an octet, so that an instant of the device is met, or just missed.
      return pass(octet_times(input.octet()) / 16);
    case 14: {
      const std::uint8_t choice = input.octet();
      return submit(choice % 3U + 1, kAddresses.at((choice >> 2) % kAddresses.size()),
                    data_of(input.octet() + (choice >> 7)));
    }
    default: {
      const std::uint8_t choice = input.octet();
      return write(kAddresses.at(choice % kAddresses.size()), data_of(input.octet()));
    }
  }
}

void FfDeviceWorld::compare() {
  FIELDPROOF_CHECK(ear_.said() == model_.said(),
                   "a device says what it must, when it must, and nothing else");
  FIELDPROOF_CHECK(user_.told == model_.told(), "a user is told what arrived for it");
  FIELDPROOF_CHECK(device_.link_time(now()) == model_.link_time(now()),
                   "a device keeps the time it was told");
}

void FfDeviceWorld::recover() {
  constexpr std::uint16_t kLongest = 0xFFFF;
  pass(octet_times(kLongest));
  compare();
  activate(0);
  pass(octet_times(64));
  FIELDPROOF_CHECK(model_.is_live(), "a device that is activated is live");
  const LinkOctets last{0x5A, 0xA5};
  submit(1, kAddresses[5], last);
  pass_token(0, kLongest, 0);
  pass(octet_times(kLongest));
  compare();
  const LinkOctets& said = ear_.said().back().octets;
  FIELDPROOF_CHECK(said[0] == 0xD5 && std::equal(last.rbegin(), last.rend(), said.rbegin()),
                   "under a long token a device sends all that it has, and returns it");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fieldproof::fuzz::play_script<FfDeviceWorld>(data, size, kMostSteps);
}
