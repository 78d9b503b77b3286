// A local node of the valve bus on a line, fed with arbitrary content.
//
// Input: a script. Its first octet chooses the node (characters, boards, options, address), then each step is
// an octet that chooses what comes, and its parameters: writes, reads, commands of any kind with a check that
// fits, octets with gaps, levels at the bit rate and at others, responses of other nodes, all of them with a
// level flipped if the step says so, silence, other switches, power. Invariants: the valves are written when
// the model (valve_node_model.hpp) says so, and with its values, and never otherwise; the node drives the
// answers that are due, and nothing else; when the line is clean again, a write and a read are served.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fuzz/octet_reader.hpp"
#include "fuzz/script.hpp"
#include "fuzz/valve_line.hpp"
#include "fuzz/valve_node_model.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/valve_bus/node.hpp"

namespace {

using fieldproof::fuzz::OctetReader;
using fieldproof::fuzz::ValveLine;
using fieldproof::fuzz::ValveNodeModel;
using fieldproof::fuzz::ValveWrite;
using fieldproof::kernel::kMillisecond;
using fieldproof::kernel::Time;
using fieldproof::line::Waveform;
using fieldproof::valve_bus::Node;
using fieldproof::valve_bus::NodeConfiguration;

constexpr unsigned kMostSteps = 48;
constexpr std::uint8_t kWrite = 0;
constexpr std::uint8_t kRead = 1;

NodeConfiguration configuration(std::uint8_t choice) {
  NodeConfiguration made;
  made.rules.characters = fieldproof::fuzz::character_profile(choice);
  made.rules.answers_writes = (choice & 4U) != 0;
  if ((choice & 8U) != 0) made.rules.loss_limit = 20 * kMillisecond;
  made.boards = (choice & 16U) != 0 ? 1 : 2;
  // 05, 99, and two positions at which a node has no address.
  constexpr std::array<std::array<unsigned, 2>, 4> kSwitches{{{0, 5}, {9, 9}, {0, 0}, {2, 12}}};
  made.tens = kSwitches.at(choice >> 6U)[0];
  made.units = kSwitches.at(choice >> 6U)[1];
  return made;
}

class Boards final : public fieldproof::valve_bus::NodeBoards {
 public:
  std::uint16_t limit_switches(Time) override { return switches; }
  void drive_valves(std::uint16_t valves, Time when) override { writes.push_back({when, valves}); }

  std::uint16_t switches = 0x0F3C;
  std::vector<ValveWrite> writes;
};

class World final : private ValveLine {
 public:
  explicit World(std::uint8_t choice)
      : ValveLine(configuration(choice).rules, choice),
        configuration_(configuration(choice)),
        node_(configuration_),
        model_(configuration_),
        driven_(*this) {
    seat_ = segment().attach(node_, "node");
    auto& place = medium().attach("node/in", seat_, 0, {});
    place.tap_arrived(model_);
    place.tap_driven(driven_);
    node_.wire(place, boards_);
    model_.set_switches(boards_.switches);
    set_power(true);
  }

  void step(OctetReader& input);
  void recover();

 private:
  // What the node drives, with the instant at which it gives it to the line.
  class Driven final : public fieldproof::segment::Tap {
   public:
    explicit Driven(World& world) : world_(world) {}
    void on_wave(const Waveform& wave) override { world_.model_.on_driven(wave, world_.segment().now()); }

   private:
    World& world_;
  };

  bool has_address() const { return configuration_.units < 10 && address() != 0; }
  std::uint8_t address() const {
    return static_cast<std::uint8_t>(10 * configuration_.tens + configuration_.units);
  }
  void follow(Time now) override { model_.run_until(now); }
  void set_power(bool is_on);
  void command(std::uint8_t id, std::uint8_t kind, std::uint16_t data, std::uint8_t flip);
  void act(OctetReader& input);
  void compare();

  NodeConfiguration configuration_;
  Boards boards_;
  Node node_;
  ValveNodeModel model_;
  Driven driven_;
  std::size_t seat_ = 0;
  bool is_on_ = false;
};

void World::set_power(bool is_on) {
  model_.run_until(segment().now());
  is_on_ = is_on;
  model_.set_power(is_on, segment().now());
  node_.set_power(is_on, segment().now());
  segment().refresh(seat_);
}

void World::command(std::uint8_t id, std::uint8_t kind, std::uint16_t data, std::uint8_t flip) {
  const auto data0 = static_cast<std::uint8_t>(data >> 8);
  const auto data1 = static_cast<std::uint8_t>(data & 0xFF);
  const std::array<std::uint8_t, 5> octets{id, kind, data0, data1,
                                           static_cast<std::uint8_t>(id ^ kind ^ data0 ^ data1)};
  send(octets, flip);
}

void World::act(OctetReader& input) {
  const auto [kind_of_step, flip] = read_choice(input, 12);
  switch (kind_of_step) {
    case 0:
      return command(address(), kWrite, input.word(), flip);
    case 1:
      return command(address(), kRead, input.word(), flip);
    case 2: {
      const std::uint8_t id = input.octet();
      const std::uint8_t kind = input.octet();
      return command(id, kind, input.word(), flip);
    }
    case 3:
      return octets_with_gaps(input, flip);
    case 4:
      return levels(input, rules().bit_rate, flip);
    case 5:
      return levels(input, read_rate(input), flip);
    case 6:
      return respond(input.word(), flip);
    case 7:
      return pass(bits(rules(), input.octet()));
    case 8:
      return pass(fieldproof::valve_bus::delimiter(rules()) + bits(rules(), 14));
    case 9:
      return pass((std::int64_t{input.octet()} % 32) * kMillisecond);
    case 10:
      boards_.switches = input.word();
      return model_.set_switches(boards_.switches);
    default:
      return set_power(!is_on_);
  }
}

void World::compare() {
  model_.run_until(segment().now());
  FIELDPROOF_CHECK(boards_.writes == model_.writes(), "valves are written as what arrived says");
}

void World::step(OctetReader& input) {
  act(input);
  compare();
}

void World::recover() {
  if (!is_on_) set_power(true);
  pass(10 * kMillisecond);
  const auto before = static_cast<std::ptrdiff_t>(boards_.writes.size());
  command(address(), kWrite, 0x5AA5, 0);
  pass(5 * kMillisecond);
  compare();
  const std::uint16_t wanted = configuration_.boards == 1 ? 0x005A : 0xA55A;
  const bool is_served = std::any_of(boards_.writes.begin() + before, boards_.writes.end(),
                                     [&](const ValveWrite& write) { return write.valves == wanted; });
  FIELDPROOF_CHECK(is_served == has_address(), "a node serves a write");
  command(address(), kRead, 0, 0);
  pass(5 * kMillisecond);
  compare();
  FIELDPROOF_CHECK(!model_.owes_answer(), "a node answers a read");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fieldproof::fuzz::play_script<World>(data, size, kMostSteps);
}
