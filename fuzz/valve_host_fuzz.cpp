// A host module of the valve bus whose PC orders and whose nodes answer what a script says.
//
// Input: a script. Its first octet chooses the host (characters, bit rate, whether it hears itself), then
// each step is an octet that chooses what comes, and its parameters: orders of the PC, parts of orders, the
// next request awaited, responses, octets with gaps, levels at the bit rate and at others, all of them with a
// level flipped if the step says so, silence, power. Invariants: the model (valve_host_model.hpp); every
// order ends when the line falls silent; then a read is answered.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fuzz/octet_reader.hpp"
#include "fuzz/script.hpp"
#include "fuzz/valve_host_model.hpp"
#include "fuzz/valve_line.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/valve_bus/host.hpp"

namespace {

using fieldproof::fuzz::OctetReader;
using fieldproof::fuzz::ValveHostModel;
using fieldproof::fuzz::ValveLine;
using fieldproof::kernel::Duration;
using fieldproof::kernel::kMillisecond;
using fieldproof::kernel::Time;
using fieldproof::line::Waveform;
using fieldproof::valve_bus::Command;
using fieldproof::valve_bus::Host;
using fieldproof::valve_bus::HostConfiguration;

constexpr unsigned kMostSteps = 48;
// What an order takes at most: three attempts at the slowest of the bit rates, refreshes between them.
constexpr Duration kLongestOrder = 60 * kMillisecond;

HostConfiguration host_configuration(std::uint8_t choice) {
  HostConfiguration made;
  made.rules.characters = fieldproof::fuzz::character_profile(choice);
  made.dip = choice >> 2U & 1U;
  made.receives_own_echo = (choice & 8U) != 0;
  made.rules.bit_rate = fieldproof::valve_bus::dip_bit_rates()[made.dip];
  return made;
}

// The nodes are all in the one place from which the input drives.
class World final : private ValveLine {
 public:
  explicit World(std::uint8_t choice)
      : ValveLine(host_configuration(choice).rules, choice),
        configuration_(host_configuration(choice)),
        host_(configuration_),
        model_(rules()),
        driven_(model_) {
    seat_ = segment().attach(host_, "host");
    auto& place = medium().attach("host/in", seat_, 0, {}, configuration_.receives_own_echo);
    place.tap_arrived(model_);
    place.tap_driven(driven_);
    host_.wire(place, model_);
    set_power(true);
  }

  void step(OctetReader& input);
  void recover();

 private:
  class Driven final : public fieldproof::segment::Tap {
   public:
    explicit Driven(ValveHostModel& model) : model_(model) {}
    void on_wave(const Waveform& wave) override { model_.on_driven(wave); }

   private:
    ValveHostModel& model_;
  };

  void follow(Time now) override { model_.run_until(now); }
  void set_power(bool is_on);
  void order(const Command& command);
  void order_part(OctetReader& input);
  void await_request();
  void await(Duration longest);

  HostConfiguration configuration_;
  Host host_;
  ValveHostModel model_;
  Driven driven_;
  std::size_t seat_ = 0;
  bool is_on_ = false;
  bool has_part_ = false;
  unsigned ordered_ = 0;
};

void World::set_power(bool is_on) {
  is_on_ = is_on;
  has_part_ = false;
  model_.set_power(is_on);
  host_.set_power(is_on, segment().now());
  segment().refresh(seat_);
}

void World::order(const Command& command) {
  // Behind a part it would be other orders; without supply it is none.
  if (!is_on_ || has_part_) return;
  ++ordered_;
  model_.order(command);
  const std::array<std::uint8_t, 4> octets{command.id, command.command, command.data0, command.data1};
  host_.write(octets, segment().now());
  segment().refresh(seat_);
}

void World::order_part(OctetReader& input) {
  const auto octets = input.take(input.octet() % 3U + 1);
  if (!is_on_ || has_part_ || octets.empty()) return;
  has_part_ = true;
  model_.order_part();
  host_.write(octets, segment().now());
  segment().refresh(seat_);
  pass(rules().partial_command_limit + kMillisecond);
  has_part_ = false;
}

// Until the host has sent something more.
void World::await_request() {
  const std::uint64_t before = model_.requests();
  const Time most = segment().now() + 5 * kMillisecond;
  while (model_.requests() == before && segment().now() < most) pass(100 * fieldproof::kernel::kMicrosecond);
}

void World::await(Duration longest) {
  const Time most = segment().now() + longest;
  while (!model_.is_done() && segment().now() < most) pass(kMillisecond);
}

void World::step(OctetReader& input) {
  const auto [kind, flip] = read_choice(input, 12);
  switch (kind) {
    case 0:
      return order({static_cast<std::uint8_t>(input.octet() % 99U + 1), 1, 0, 0});
    case 1: {
      const auto id = static_cast<std::uint8_t>(input.octet() % 99U + 1);
      const std::uint16_t data = input.word();
      return order({id, 0, static_cast<std::uint8_t>(data >> 8), static_cast<std::uint8_t>(data & 0xFF)});
    }
    case 2: {
      const std::uint8_t id = input.octet();
      return order({id, input.octet(), 0x12, 0x34});
    }
    case 3:
      return order_part(input);
    case 4:
      return await_request();
    case 5:
      return respond(input.word(), flip);
    case 6:
      return octets_with_gaps(input, flip);
    case 7:
      return levels(input, rules().bit_rate, flip);
    case 8:
      return levels(input, read_rate(input), flip);
    case 9:
      return pass(bits(rules(), input.octet()));
    case 10:
      return pass((std::int64_t{input.octet()} % 64) * kMillisecond);
    default:
      return set_power(!is_on_);
  }
}

void World::recover() {
  if (!is_on_) set_power(true);
  await((ordered_ + 1) * kLongestOrder);
  FIELDPROOF_CHECK(model_.is_done(), "every order ends");
  const std::uint64_t before = model_.responses();
  order({7, 1, 0, 0});
  // Refreshes may come first.
  for (int n = 0; n < 100 && !model_.is_reading(); ++n) await_request();
  FIELDPROOF_CHECK(model_.is_reading(), "a host sends what is ordered");
  // The request is over, and the delimiter behind it.
  pass(fieldproof::valve_bus::half_characters(rules(), 20) + fieldproof::valve_bus::delimiter(rules()));
  respond(0x5AA5, 0);
  pass(2 * kMillisecond);
  FIELDPROOF_CHECK(model_.responses() == before + 1, "a host takes a response");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fieldproof::fuzz::play_script<World>(data, size, kMostSteps);
}
