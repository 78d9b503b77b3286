#include "conformance/valve_bus/node_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::conformance {
namespace {

using valve_bus::NodeConfiguration;

constexpr std::size_t kSentWaves = 30;          // five or six frames
constexpr std::string_view kValves = "valves";  // that they moved, as an observation
constexpr kernel::Duration kWarmUp = 20 * kernel::kMillisecond;

std::unique_ptr<valve_bus::NodeDevice> made(const NodeSetting& setting,
                                            const NodeConfiguration& configuration) {
  if (setting.make_device) return setting.make_device(configuration);
  return std::make_unique<valve_bus::Node>(configuration);
}

// A driver may come on as soon as the command is over, and has to be off after the answer.
LineWatch watch_of(const valve_bus::Rules& rules) {
  const kernel::Duration answer =
      valve_bus::kResponseOctets * (character_time(rules) + longest_gap(rules)) +
      valve_bus::bits(rules, std::int64_t{rules.driver_on_bits} + rules.driver_off_bits);
  return LineWatch(valve_bus::bits(rules, 1), delimiter(rules) + turnaround_time_span(rules) + answer);
}

bool has_an_id(const valve_bus::NodeConfiguration& node) {
  constexpr unsigned kDigits = 10;
  const bool are_digits = node.address_tens < kDigits && node.address_units < kDigits;
  return are_digits && node.address_tens + node.address_units > 0;
}

// The cases speak to the ID that the node has.
void expect_an_id(const valve_bus::NodeConfiguration& node) {
  if (has_an_id(node)) return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("address switches at {} and {} give no ID, so nothing can be sent to this node; "
                  "declare \"address_tens\" and \"address_units\" of 0 to 9, one of them above 0",
                  node.address_tens, node.address_units));
}

// A command, what follows from it and a wrong frame have to fit within the time after which its valves go
// off.
void expect_time_for_commands(const valve_bus::NodeConfiguration& node) {
  constexpr std::int64_t kExchanges = 40;
  constexpr std::int64_t kFrameBits = 11 * valve_bus::kCommandOctets;
  const valve_bus::Rules& rules = node.rules;
  const kernel::Duration least =
      kExchanges * (valve_bus::bits(rules, kFrameBits) + valve_bus::delimiter(rules) +
                    valve_bus::turnaround_time_span(rules));
  if (rules.loss_limit == kernel::Duration{} || rules.loss_limit >= least) return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format(
          "with a \"loss_limit\" of {} the valves of this node go off within what cases do between two "
          "commands; at {} bit/s it can be judged from {} on",
          kernel::describe(rules.loss_limit), rules.bit_rate, kernel::describe(least)));
}

}  // namespace

void expect_judgeable(const NodeConfiguration& node) {
  expect_an_id(node);
  expect_time_for_commands(node);
}

NodeConfiguration node_configuration(const NodeNeeds& needs, const judge::Pics& pics) {
  NodeConfiguration configuration = node_declared_in(pics).configuration;
  configuration.address_tens = needs.tens.value_or(configuration.address_tens);
  configuration.address_units = needs.units.value_or(configuration.address_units);
  configuration.boards = needs.boards.value_or(configuration.boards);
  valve_bus::Rules& rules = configuration.rules;
  rules.characters = needs.characters.value_or(rules.characters);
  rules.bit_rate = needs.bit_rate.value_or(rules.bit_rate);
  rules.answers_writes = needs.answers_writes.value_or(rules.answers_writes);
  rules.loss_limit = needs.loss_limit.value_or(rules.loss_limit);
  return configuration;
}

NodeBench::NodeBench(const NodeNeeds& needs, const NodeSetting& setting)
    : NodeBench(needs, setting, setting.pics.value_or(judge::Pics{}).completed_by(declared_node())) {}

NodeBench::NodeBench(const NodeNeeds& needs, const NodeSetting& setting, judge::Pics pics)
    : LineBench(setting.seed, setting.volume, setting.stresses,
                watch_of(node_configuration(needs, pics).rules)),
      pics_(std::move(pics)),
      configuration_(node_configuration(needs, pics_)),
      distance_(needs.distance),
      codec_(rules()),
      node_(made(setting, configuration_)),
      driven_(character_format(rules()), rules().bit_rate),
      sent_(character_format(rules()), rules().bit_rate),
      arrived_(rules()) {
  attach_iut(*node_, "node", distance_);
  start_recording(setting, rules());
  if (node_->capabilities().senses_activity) place().sense_activity();
  place().tap_driven(driven_);
  place().tap_arrived(arrived_);
  place().tap_arrived(arrivals_);
  tester().tap_driven(sent_);
  sent_.keep_last(kSentWaves);
  watch(place());
  const trace::Channel valves = segment().trace().add_channel("node/valves");
  boards_.on_change([this, valves](const segment::ProcessWords::Change& change) {
    segment().trace().observe(valves, change.when, kValves, change.after);
    ledger_.add_move({change.when, change.before, change.after});
  });
  install(setting.plan, rules().bit_rate, {std::string(kValves)});
  // A response begins within the span and takes three characters; a bit of slack shows one that is late.
  settling_ = delimiter() + std::max(turnaround_time_span(rules()), actuation_limit(rules())) +
              characters(8) + 2 * distance_ + 500 * kernel::kMicrosecond;
  node_->wire(place(), boards_);
  if (distance_ > kernel::Duration{}) require(&iut::Capabilities::distance);
  if (!needs.is_powered) return;
  power_up();
  wait(kWarmUp);
  clear_observations();
}

void NodeBench::require(bool iut::Capabilities::* what) const {
  if (capabilities().*what) return;
  if (what == &iut::Capabilities::process_side)
    throw iut::CannotBeDone("the valves of the node cannot be seen without an upper channel");
  if (what == &iut::Capabilities::moving_inputs)
    throw iut::CannotBeDone("the limit switches cannot be moved while the node works");
  if (what == &iut::Capabilities::driver_control)
    throw iut::CannotBeDone("the driver of the node cannot be seen without an upper channel");
  throw iut::CannotBeDone("the node cannot be put farther away");
}

void NodeBench::note_instant(bool is_sure, const iut::TimingUncertainty& doubt) {
  const kernel::Duration all = doubt.earlier + doubt.later;
  instants_.greatest_doubt = std::max(instants_.greatest_doubt, all);
  if (is_sure) {
    ++instants_.sure;
  } else if (instants_.in_doubt++ == 0 || all < instants_.least_doubt_open) {
    instants_.least_doubt_open = all;
  }
}

std::uint8_t NodeBench::address() const {
  return static_cast<std::uint8_t>(10 * configuration_.address_tens + configuration_.address_units);
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
  supply_.add_supply(now(), is_on);
  keep_writes();
  ledger_.forget_writes();
  // Without supply no solenoid is held, whatever the node had driven.
  if (!is_on) boards_.drive_valves(0, now());
  refresh_iut();
}

void NodeBench::power_up() {
  set_power(true);
  wait(node_declared_in(pics_).start_up_time);
}

kernel::Time NodeBench::send(std::span<const std::uint8_t> octets) {
  if (octets.empty()) return now();
  const auto rate = static_cast<std::int64_t>(std::llround(static_cast<double>(rules().bit_rate) * clock_));
  const kernel::Time end = codec_.drive(tester(), octets, now(), {}, rate);
  segment().run_until(end);
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

// An answer with gaps as long as they may be ends late, and sooner than a delimiter after it nothing may
// come.
void NodeBench::await_response_window() {
  wait(settling_);
  const kernel::Time is_free = driven_.until() + delimiter() + kernel::kMicrosecond;
  if (has_driven() && now() < is_free) wait(is_free - now());
}

void NodeBench::ask() {
  read();
  await_response_window();
}

void NodeBench::drive(line::Waveform& wave) {
  wave.start = now();
  drive_to_end(wave);
}

line::Levels NodeBench::levels_of(std::uint8_t octet) const {
  line::Levels levels;
  codec_.append(levels, std::span(&octet, 1));
  return levels;
}

void NodeBench::interject(std::span<const std::uint8_t> octets, kernel::Time start) {
  codec_.drive(tester(), octets, start, {});
}

void NodeBench::wait_after_write() {
  if (rules().answers_writes) await_response_window();
  wait(delimiter() + kernel::kMicrosecond);
}

void NodeBench::keep_writes() {
  if (!has_an_id(configuration_)) return;  // no write is its own
  for (const ArrivedFrame& frame : arrived_.frames()) {
    const bool is_own_write =
        frame.is_command() && frame.octets[0] == address() && frame.octets[1] == rules().write_command;
    if (is_own_write) ledger_.add_write({frame.end, valves_of(frame.octets[2], frame.octets[3])});
  }
}

const ValveLedger& NodeBench::ledger() {
  keep_writes();
  return ledger_;
}

void NodeBench::clear_observations() {
  keep_writes();
  driven_.clear();
  arrived_.clear();
  boards_.forget_changes();
}

std::vector<std::string> NodeBench::decode_lines() {
  DecodedLines happened;
  const auto tell = [&](std::string_view who, const std::vector<Transmission>& all) {
    for (const Transmission& one : all) {
      happened.add(one.driver_on,
                   fmt::format("{} {} to {}: {}", who, kernel::describe(one.driver_on),
                               kernel::describe(one.driver_off), characters_text(one, rules())));
    }
  };
  tell("tester drove", sent_.transmissions());
  tell("node drove", answers());
  happened.add(supply_);
  for (const ValveMove& move : ledger_.moves()) {
    happened.add(move.when, fmt::format("valves {:02X} {:02X} from {} on", move.after & 0xFF, move.after >> 8,
                                        kernel::describe(move.when)));
  }
  std::vector<std::string> lines = happened.last();
  const std::uint16_t valves = this->valves();
  lines.push_back(
      fmt::format("valves {:02X} {:02X} at {}", valves & 0xFF, valves >> 8, kernel::describe(now())));
  return lines;
}

}  // namespace fieldproof::conformance
