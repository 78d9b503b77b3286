#include "conformance/valve_bus/node_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/iut/misbehaviour.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::conformance {
namespace {

using valve_bus::CharacterProfile;
using valve_bus::NodeConfiguration;
using valve_bus::Rules;

constexpr unsigned kAddress = 5;
constexpr std::int64_t kLeastBitRate = 1'200;
constexpr std::int64_t kMostBitRate = 1'000'000;
constexpr std::size_t kSentWaves = 30;  // five or six frames
constexpr kernel::Duration kWarmUp = 20 * kernel::kMillisecond;

CharacterProfile profile_named(const std::string& name) {
  for (const auto profile : {CharacterProfile::ninth_bit_one, CharacterProfile::even_parity}) {
    if (name == text_of(profile)) return profile;
  }
  return CharacterProfile::eight_bits;
}

std::string characters_text(const Transmission& transmission) {
  std::string text;
  for (const DrivenCharacter& character : transmission.characters) {
    text += fmt::format(" {:02X}{}", character.octet(), character.is_good ? "" : "!");
  }
  return text.empty() ? " no character" : text;
}

std::unique_ptr<valve_bus::NodeDevice> made(const NodeSetting& setting,
                                            const NodeConfiguration& configuration) {
  if (setting.make_node) return setting.make_node(configuration);
  return std::make_unique<valve_bus::Node>(configuration);
}

}  // namespace

std::vector<judge::PicsItem> node_pics_items() {
  using enum judge::PicsKind;
  return {
      {"address", number, "what the address switches are set to, 1 to 99", 99, {}, 1},
      {"address_switches_can_be_set", truth, "the bench can give the node another address"},
      {"boards", number, "drive boards, 1 or 2", 2, {}, 1},
      {"bit_rate", number, "bit/s on the line", kMostBitRate, {}, kLeastBitRate},
      {"characters", text, "character format", 0, {"P0", "P1", "P2"}},
      {"acknowledges_writes", truth, "a write is answered with what was taken"},
      {"valves_off_without_host", truth, "valves go off when no command has come for 500 ms"},
      {"power_can_be_switched", truth, "the bench can switch the supply of the node"},
  };
}

judge::Pics declared_node() {
  const Rules rules;
  judge::Pics pics;
  pics.declare("address", std::int64_t{kAddress});
  pics.declare("address_switches_can_be_set", true);
  pics.declare("boards", std::int64_t{2});
  pics.declare("bit_rate", rules.bit_rate);
  pics.declare("characters", std::string(text_of(rules.characters)));
  pics.declare("acknowledges_writes", false);
  pics.declare("valves_off_without_host", false);
  pics.declare("power_can_be_switched", true);
  return pics;
}

NodeConfiguration node_configuration(const NodeNeeds& needs, const judge::Pics& pics) {
  NodeConfiguration configuration;
  const auto address = static_cast<unsigned>(pics.number("address", kAddress));
  configuration.tens = needs.tens.value_or(address / 10);
  configuration.units = needs.units.value_or(address % 10);
  configuration.boards = needs.boards.value_or(static_cast<unsigned>(pics.number("boards", 2)));
  Rules& rules = configuration.rules;
  rules.bit_rate = pics.number("bit_rate", rules.bit_rate);
  rules.characters = needs.characters.value_or(profile_named(pics.text("characters", "P0")));
  rules.answers_writes = pics.supports("acknowledges_writes");
  if (pics.supports("valves_off_without_host")) rules.loss_limit = 500 * kernel::kMillisecond;
  return configuration;
}

NodeBench::NodeBench(const NodeNeeds& needs, const NodeSetting& setting)
    : pics_(setting.pics.value_or(judge::Pics{}).completed_by(declared_node())),
      configuration_(node_configuration(needs, pics_)),
      distance_(needs.distance),
      volume_(setting.volume),
      random_(setting.seed),
      line_(segment_, "line", segment::ContentionRule::noise, random_),
      codec_(rules()),
      node_(made(setting, configuration_)),
      tester_seat_(segment_.attach(*this, "tester")),
      node_seat_(segment_.attach(*node_, "node")),
      driven_(character_format(rules()), rules().bit_rate),
      sent_(character_format(rules()), rules().bit_rate),
      arrived_(rules()),
      line_watch_(bits(1)),
      stressed_(setting.stresses) {
  tester_ = &line_.attach("tester/in", tester_seat_, 0, {});
  place_ = &line_.attach("node/in", node_seat_, 0, distance_);
  if (setting.make_recorder) segment_.trace().set_recorder(setting.make_recorder(segment_.trace(), rules()));
  place_->tap_driven(driven_);
  place_->tap_arrived(arrived_);
  tester_->tap_driven(sent_);
  sent_.keep_last(kSentWaves);
  line_watch_.watch(*place_, segment_.trace());
  const trace::Channel valves = segment_.trace().add_channel("node/valves");
  boards_.on_change([this, valves](const segment::ProcessWords::Change& change) {
    segment_.trace().observe(valves, change.when, "valves", change.after);
  });
  if (!setting.plan.empty()) {
    plan_ = std::make_unique<fault::InstalledPlan>(setting.plan, segment_.trace(), random_.split("plan"));
    place_->set_channel(plan_->channel_for({"node/in", place_->trace_channel(), rules().bit_rate}));
  }
  // A response begins within the span and takes three characters; a bit of slack shows one that is late.
  settling_ = delimiter() + std::max(turnaround_time_span(rules()), actuation_limit(rules())) +
              characters(8) + 2 * distance_ + 500 * kernel::kMicrosecond;
  node_->wire(*place_, boards_);
  if (distance_ > kernel::Duration{}) require(&valve_bus::NodeCapabilities::distance);
  if (!needs.is_powered) return;
  set_power(true);
  wait(kWarmUp);
  clear_observations();
}

void NodeBench::require(bool valve_bus::NodeCapabilities::* what) const {
  using valve_bus::NodeCapabilities;
  if (reach().*what) return;
  if (what == &NodeCapabilities::boards)
    throw iut::CannotBeDone("the valves of the node cannot be seen without an upper channel");
  if (what == &NodeCapabilities::moving_switches)
    throw iut::CannotBeDone("the limit switches cannot be moved while the node works");
  if (what == &NodeCapabilities::driver)
    throw iut::CannotBeDone("the driver of the node cannot be seen without an upper channel");
  throw iut::CannotBeDone("the node cannot be put farther away");
}

void NodeBench::note_instant(bool is_sure, const valve_bus::TimingUncertainty& doubt) {
  const kernel::Duration all = doubt.earlier + doubt.later;
  instants_.greatest_doubt = std::max(instants_.greatest_doubt, all);
  if (is_sure) {
    ++instants_.sure;
  } else if (instants_.in_doubt++ == 0 || all < instants_.least_doubt_open) {
    instants_.least_doubt_open = all;
  }
}

std::uint8_t NodeBench::address() const {
  return static_cast<std::uint8_t>(10 * configuration_.tens + configuration_.units);
}

kernel::Duration NodeBench::characters(double count) const {
  const auto one = static_cast<double>(character_time(rules()).count());
  return kernel::Duration{std::llround(count * one)};
}

std::uint16_t NodeBench::valves_of(std::uint8_t data0, std::uint8_t data1) const {
  return configuration_.boards == 1 ? data0 : static_cast<std::uint16_t>(data0 | data1 << 8);
}

void NodeBench::set_power(bool is_on) {
  node_->set_power(is_on, now());
  // Without supply no solenoid is held, whatever the node had driven.
  if (!is_on) boards_.drive_valves(0, now());
  segment_.refresh(node_seat_);
}

kernel::Time NodeBench::send(std::span<const std::uint8_t> octets) {
  if (octets.empty()) return now();
  const auto rate = static_cast<std::int64_t>(std::llround(static_cast<double>(rules().bit_rate) * clock_));
  const kernel::Time end = codec_.drive(*tester_, octets, now(), {}, rate);
  segment_.run_until(end);
  return end;
}

std::array<std::uint8_t, valve_bus::kCommandOctets> NodeBench::telling_write() {
  const std::uint16_t valves = this->valves();
  return octets_of(valve_bus::Command{address(), static_cast<std::uint8_t>(rules().write_command),
                                      static_cast<std::uint8_t>(~valves),
                                      static_cast<std::uint8_t>(~valves >> 8)});
}

kernel::Time NodeBench::write(std::uint8_t data0, std::uint8_t data1) {
  return send(valve_bus::Command{address(), static_cast<std::uint8_t>(rules().write_command), data0, data1});
}

kernel::Time NodeBench::read() {
  return send(valve_bus::Command{address(), static_cast<std::uint8_t>(rules().read_command), random_octet(),
                                 random_octet()});
}

void NodeBench::wait(kernel::Duration duration) {
  segment_.run_for(duration);
}

void NodeBench::drive(line::Waveform& wave) {
  wave.start = now();
  const kernel::Time end = wave.end();
  tester_->drive(wave);
  segment_.run_until(end);
}

line::Levels NodeBench::levels_of(std::uint8_t octet) const {
  line::Levels levels;
  codec_.append(levels, std::span(&octet, 1));
  return levels;
}

void NodeBench::interject(std::span<const std::uint8_t> octets, kernel::Time start) {
  codec_.drive(*tester_, octets, start, {});
}

void NodeBench::clear_observations() {
  driven_.clear();
  arrived_.clear();
  boards_.forget_changes();
}

void NodeBench::begin_stress(const fault::Stress& stress) {
  stressed_.begin(stress, *place_,
                  {rules().bit_rate, now(), random_.split("stress").split(stress_number_++), segment_.trace(),
                   place_->trace_channel()});
}

std::vector<std::string> NodeBench::decode_lines() {
  constexpr std::size_t kMostLines = 12;
  std::vector<std::string> lines;
  const auto tell = [&](std::string_view who, const std::vector<Transmission>& all) {
    const std::size_t first = all.size() - std::min(all.size(), kMostLines);
    for (const Transmission& one : std::span(all).subspan(first)) {
      lines.push_back(fmt::format("{} {} to {}:{}", who, kernel::describe(one.driver_on),
                                  kernel::describe(one.driver_off), characters_text(one)));
    }
  };
  tell("tester drove", sent_.transmissions());
  tell("node drove", answers());
  const std::uint16_t valves = boards_.valves();
  lines.push_back(fmt::format("valves {:02X} {:02X}", valves & 0xFF, valves >> 8));
  return lines;
}

}  // namespace fieldproof::conformance
