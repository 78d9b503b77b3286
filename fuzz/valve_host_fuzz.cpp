// A host module of the valve bus whose PC orders and whose nodes answer what a script says.
//
// Input: a script. Its first octet chooses the host (characters, bit rate, whether it hears itself), then
// each step is an octet that chooses what comes, and its parameters: orders of the PC, parts of orders, the
// next request awaited, responses, octets with gaps, levels at the bit rate and at others, all of them with a
// level flipped if the step says so, silence, power. Invariants: the model (valve_host_model.hpp); every
// order ends when the line falls silent; then a read is answered.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fuzz/octet_reader.hpp"
#include "fuzz/valve_host_model.hpp"
#include "harness/kernel/check.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/valve_bus/host.hpp"

namespace {

using fieldproof::fuzz::OctetReader;
using fieldproof::fuzz::ValveHostModel;
using fieldproof::kernel::Duration;
using fieldproof::kernel::kMillisecond;
using fieldproof::kernel::Random;
using fieldproof::kernel::Time;
using fieldproof::line::Waveform;
using fieldproof::valve_bus::CharacterProfile;
using fieldproof::valve_bus::Command;
using fieldproof::valve_bus::Host;
using fieldproof::valve_bus::HostConfiguration;
using fieldproof::valve_bus::Rules;

constexpr std::size_t kLargestInput = 512;
constexpr unsigned kMostSteps = 48;
// What an order takes at most: three attempts at the slowest of the bit rates, refreshes between them.
constexpr Duration kLongestOrder = 60 * kMillisecond;

HostConfiguration host_configuration(std::uint8_t choice) {
  constexpr std::array kProfiles{CharacterProfile::ninth_bit_one, CharacterProfile::even_parity,
                                 CharacterProfile::eight_bits};
  HostConfiguration made;
  made.rules.characters = kProfiles.at(choice % 3U);
  made.dip = choice >> 2U & 1U;
  made.hears_itself = (choice & 8U) != 0;
  made.rules.bit_rate = fieldproof::valve_bus::dip_bit_rates()[made.dip];
  return made;
}

// The nodes, all in one place, from which the input drives.
class Nodes final : public fieldproof::segment::Station {
 public:
  void receive(fieldproof::segment::PortIndex, const Waveform&) override {}
  void on_time(Time) override {}
  Time next_time() const override { return fieldproof::kernel::kNever; }
};

class Line {
 public:
  explicit Line(std::uint8_t choice)
      : configuration_(host_configuration(choice)),
        line_(segment_, "line", fieldproof::segment::ContentionRule::noise, Random(choice)),
        host_(configuration_),
        model_(rules()),
        codec_(rules()),
        driven_(model_) {
    const std::size_t nodes_seat = segment_.attach(nodes_, "nodes");
    seat_ = segment_.attach(host_, "host");
    place_of_nodes_ = &line_.attach("nodes/in", nodes_seat, 0, {});
    auto& place = line_.attach("host/in", seat_, 0, {}, configuration_.hears_itself);
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

  const Rules& rules() const { return configuration_.rules; }
  void set_power(bool is_on);
  void order(const Command& command);
  void order_part(OctetReader& input);
  void await_request();
  void await(Duration longest);
  void pass(Duration duration);
  void drive(Waveform& wave, std::uint8_t flip);
  void send(std::span<const std::uint8_t> octets, std::uint8_t flip);
  void respond(std::uint16_t data, std::uint8_t flip);
  void octets_with_gaps(OctetReader& input, std::uint8_t flip);
  void levels(OctetReader& input, std::int64_t rate, std::uint8_t flip);

  fieldproof::segment::Segment segment_;
  HostConfiguration configuration_;
  fieldproof::segment::Medium line_;
  Nodes nodes_;
  Host host_;
  ValveHostModel model_;
  fieldproof::valve_bus::CharacterCodec codec_;
  Driven driven_;
  fieldproof::segment::MediumPort* place_of_nodes_ = nullptr;
  std::size_t seat_ = 0;
  bool is_on_ = false;
  bool has_part_ = false;
  unsigned ordered_ = 0;
};

void Line::set_power(bool is_on) {
  is_on_ = is_on;
  has_part_ = false;
  model_.set_power(is_on);
  host_.set_power(is_on, segment_.now());
  segment_.refresh(seat_);
}

void Line::pass(Duration duration) {
  segment_.run_for(duration);
  model_.run_until(segment_.now());
}

void Line::order(const Command& command) {
  // Behind a part it would be other orders; without supply it is none.
  if (!is_on_ || has_part_) return;
  ++ordered_;
  model_.order(command);
  const std::array<std::uint8_t, 4> octets{command.id, command.command, command.data0, command.data1};
  host_.write(octets, segment_.now());
  segment_.refresh(seat_);
}

void Line::order_part(OctetReader& input) {
  const auto octets = input.take(input.octet() % 3U + 1);
  if (!is_on_ || has_part_ || octets.empty()) return;
  has_part_ = true;
  model_.order_part();
  host_.write(octets, segment_.now());
  segment_.refresh(seat_);
  pass(rules().partial_command_limit + kMillisecond);
  has_part_ = false;
}

// Until the host has sent something more.
void Line::await_request() {
  const std::uint64_t before = model_.requests();
  const Time most = segment_.now() + 5 * kMillisecond;
  while (model_.requests() == before && segment_.now() < most) pass(100 * fieldproof::kernel::kMicrosecond);
}

void Line::await(Duration longest) {
  const Time most = segment_.now() + longest;
  while (!model_.is_done() && segment_.now() < most) pass(kMillisecond);
}

void Line::drive(Waveform& wave, std::uint8_t flip) {
  if (wave.levels.empty()) return;
  if (flip != 0) wave.levels.flip(flip % wave.levels.size());
  wave.start = segment_.now();
  const Time end = wave.end();
  place_of_nodes_->drive(wave);
  segment_.run_until(end);
}

// Each character on its own, as stations of the bus drive them.
void Line::send(std::span<const std::uint8_t> octets, std::uint8_t flip) {
  const std::size_t hit = flip % std::max<std::size_t>(octets.size(), 1);
  for (std::size_t n = 0; n < octets.size(); ++n) {
    Waveform wave{segment_.now(), rules().bit_rate, {}};
    codec_.append(wave.levels, octets.subspan(n, 1));
    drive(wave, n == hit ? flip : std::uint8_t{0});
  }
}

void Line::respond(std::uint16_t data, std::uint8_t flip) {
  const auto data0 = static_cast<std::uint8_t>(data >> 8);
  const auto data1 = static_cast<std::uint8_t>(data & 0xFF);
  const std::array<std::uint8_t, 3> octets{data0, data1, static_cast<std::uint8_t>(data0 ^ data1)};
  send(octets, flip);
}

void Line::octets_with_gaps(OctetReader& input, std::uint8_t flip) {
  const std::uint8_t choice = input.octet();
  for (const std::uint8_t octet : input.take(choice % 8U + 1)) {
    send(std::span(&octet, 1), flip);
    if ((choice & 0xF0U) != 0) pass(bits(rules(), choice >> 3));
  }
}

void Line::levels(OctetReader& input, std::int64_t rate, std::uint8_t flip) {
  Waveform wave{segment_.now(), rate, {}};
  for (const std::uint8_t octet : input.take(input.octet() % 32U + 1)) wave.levels.append(octet, 8);
  drive(wave, flip);
}

// One step: what comes in the low bits of its octet, whether a level is flipped in the highest one.
void Line::step(OctetReader& input) {
  const std::uint8_t choice = input.octet();
  const std::uint8_t flip = (choice & 0x80) != 0 ? input.octet() : std::uint8_t{0};
  switch ((choice & 0x7F) % 12) {
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
      return levels(input, (std::int64_t{input.octet()} + 1) * 31'250, flip);
    case 9:
      return pass(bits(rules(), input.octet()));
    case 10:
      return pass((std::int64_t{input.octet()} % 64) * kMillisecond);
    default:
      return set_power(!is_on_);
  }
}

void Line::recover() {
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
  if (size > kLargestInput) return -1;
  OctetReader input(data, size);
  Line line(input.octet());
  for (unsigned steps = 0; steps < kMostSteps && !input.is_empty(); ++steps) line.step(input);
  line.recover();
  return 0;
}
