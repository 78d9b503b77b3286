#include "protocols/valve_bus/running_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "harness/kernel/check.hpp"
#include "protocols/valve_bus/dissector.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/timing.hpp"

namespace fieldproof::valve_bus {
namespace {

using kernel::Duration;
using kernel::Time;
using network::Outcome;

constexpr std::size_t kCommandOfPc = 4;  // octets: ID, COMMAND, DATA0, DATA1
// The PC gives the host so many commands in advance: never a pause between two, and words are fresh.
constexpr std::size_t kCommandsAhead = 4;
constexpr std::string_view kNotSteady =
    "the cycles of this bus are not equally long; its host repeats writes between the commands of its PC";
constexpr std::string_view kAfterRepeater = "it lies after a repeater, on a segment that is not in the clamp";

std::unique_ptr<HostDevice> make_host(const RunningStations& stations,
                                      const HostConfiguration& configuration) {
  auto host = stations.make_host ? stations.make_host(configuration) : nullptr;
  return host ? std::move(host) : std::make_unique<Host>(configuration);
}

std::uint8_t id_of(const NodeDescription& node) {
  return static_cast<std::uint8_t>(node.address);
}

}  // namespace

RunningNetwork::RunningNetwork(const NetworkDescription& description, std::uint64_t seed,
                               const RunningStations& stations)
    : description_(description),
      random_(seed),
      line_(segment_, "line", segment::ContentionRule::noise, random_),
      host_(make_host(stations, {.rules = description.rules, .dip = description.dip})),
      host_number_(segment_.attach(*host_, "host")),
      host_drives_(*this),
      pc_number_(0) {
  const auto violation = violation_of(description_);
  FIELDPROOF_CHECK(!violation, "a network that runs is one within its limits");
  description_.rules.bit_rate = dip_bit_rates()[description_.dip];
  segment::MediumPort& place = line_.attach("host/in", host_number_, 0, {});
  place.tap_driven(host_drives_);
  place.tap_driven(attendance_.expect("host"));
  if (host_->capabilities().senses_activity) place.sense_activity();
  host_->wire(place, *this);
  places_.push_back({.name = place.name(),
                     .receiver = &place,
                     .trace_channel = place.trace_channel(),
                     .level_rate = description_.rules.bit_rate});
  for (const NodeDescription& node : description_.nodes) add_node(node, stations);
  pc_number_ = segment_.attach(*this, "PC");
  find_signals();
  plan_steps();
  find_cycle();
  find_turnaround_times();
}

Rules RunningNetwork::rules_on_line() const {
  Rules rules = description_.rules;
  rules.bit_rate = dip_bit_rates()[description_.dip];
  return rules;
}

void RunningNetwork::add_node(const NodeDescription& node, const RunningStations& stations) {
  const NodeConfiguration configuration{
      .rules = description_.rules, .address_tens = node.address / 10, .address_units = node.address % 10};
  const std::size_t position = seats_.size() + 1;
  Seat& seat = seats_.emplace_back();
  seat.description = node;
  seat.way = distance_to(description_, position - 1);
  seat.device = stations.make_node ? stations.make_node(position, configuration) : nullptr;
  const bool is_under_test = seat.device != nullptr;
  if (!is_under_test) seat.device = std::make_unique<Node>(configuration);
  seat.number = segment_.attach(*seat.device, fmt::format("node@{}", position));
  segment::MediumPort& place = line_.attach(fmt::format("node@{}/in", position), seat.number, 0, seat.way);
  place.tap_driven(node_drives_);
  if (seat.device->capabilities().senses_activity) place.sense_activity();
  if (is_under_test) {
    place.tap_driven(attendance_.expect(fmt::format("node@{}", position)));
    seat.turnaround.emplace(network::AnswerBegin::start_level, [this, &seat](Time asked, Time answered) {
      if (watcher_ != nullptr) watcher_->on_delay(seat.turnaround_kind, asked, answered);
    });
    place.tap_driven(*seat.turnaround);
  }
  seat.device->wire(place, seat.block);
  const bool is_exposed = repeaters_before(description_.rules, position - 1) == 0;
  places_.push_back({.name = place.name(),
                     .receiver = &place,
                     .trace_channel = place.trace_channel(),
                     .level_rate = description_.rules.bit_rate,
                     .is_exposed = is_exposed,
                     .why_not = is_exposed ? "" : kAfterRepeater});
}

bool RunningNetwork::is_copied_to(unsigned address) const {
  return std::ranges::find(description_.copy, address, &CopyRule::to) != description_.copy.end();
}

std::size_t RunningNetwork::index_of(unsigned address) const {
  const auto at = std::ranges::find(description_.nodes, address, &NodeDescription::address);
  return static_cast<std::size_t>(at - description_.nodes.begin());
}

void RunningNetwork::find_signals() {
  for (std::size_t n = 0; n < seats_.size(); ++n) {
    Seat& seat = seats_[n];
    seat.first_signal = signals_.size();
    seat.is_written = description_.writes || is_copied_to(seat.description.address);
    const std::string place = fmt::format("node@{} (address {})", n + 1, seat.description.address);
    if (seat.is_written) {
      // A refresh may repeat the write before while the next one waits for its turn.
      signals_.push_back({.name = "valves of " + place,
                          .is_output = true,
                          .safe_value = std::uint16_t{0},
                          .admissible_words = 2});
    }
    signals_.push_back({.name = "limit switches of " + place});
    if (!seat.is_written) continue;
    seat.block.on_change([this, signal = seat.first_signal](const ValveBlock::Change& change) {
      if (watcher_ != nullptr) watcher_->on_shown(signal, change.after, change.when);
    });
  }
}

void RunningNetwork::plan_steps() {
  for (std::size_t n = 0; n < seats_.size(); ++n) {
    const unsigned address = seats_[n].description.address;
    if (description_.writes && !is_copied_to(address)) steps_.push_back({n, true});
    steps_.push_back({n, false});
    for (const CopyRule& rule : description_.copy) {
      if (rule.from == address) steps_.push_back({index_of(rule.to), true, n});
    }
  }
}

// A host that refreshes writes between the PC's commands takes longer: then the form is for a cycle without,
// and is left open by what is measured.
void RunningNetwork::find_cycle() {
  const Rules& rules = description_.rules;
  std::vector<PolledNode> nodes;
  for (const Seat& seat : seats_) nodes.push_back({seat.way, seat.is_written});
  steady_cycle_ = poll_cycle(rules, steps_, nodes);
  const bool is_refreshed =
      steady_cycle_.longest >= rules.refresh && std::ranges::any_of(steps_, &PollStep::is_write);
  if (is_refreshed) steady_cycle_.is_steady = false;
  Duration time = steady_cycle_.is_steady ? steady_cycle_.time : steady_cycle_.longest;
  // Between any two commands a refresh may come.
  if (is_refreshed)
    time += static_cast<std::int64_t>(steps_.size()) * reference_write_time(rules, seats_.back().way);
  cycles_ = {{"poll cycle", time,
              is_refreshed ? "the polls and writes of one cycle, and a refresh in front of each of them"
                           : "the polls and writes of one cycle, each by its frames and silences, after what "
                             "it waits for",
              !steady_cycle_.is_steady}};
}

// Of those under test: the others are as their rules have it.
void RunningNetwork::find_turnaround_times() {
  const Rules rules = rules_on_line();
  for (std::size_t n = 0; n < seats_.size(); ++n) {
    if (!seats_[n].turnaround) continue;
    seats_[n].turnaround_kind = cycles_.size();
    cycles_.push_back({.name = fmt::format("turnaround time of node@{}", n + 1),
                       .theory = delimiter(rules) + turnaround_time_span(rules),
                       .form = "from the last stop bit of a read to the start bit of its answer; at most a "
                               "delimiter and turnaround_time_span",
                       .is_bound = true,
                       .is_delay = true});
  }
}

// ---- the installation ----

void RunningNetwork::start() {
  const Time now = segment_.now();
  started_ = now;
  has_response_ = false;
  attendance_.begin();
  for (Seat& seat : seats_) {
    seat.device->set_power(false, now);
    if (seat.block.valves() != 0) seat.block.drive_valves(0, now);
    seat.device->set_power(true, now);
    segment_.refresh(seat.number);
    seat.is_open = seat.is_read = seat.is_closing = false;
    seat.reads = 0;
    if (seat.turnaround) seat.turnaround->forget();
  }
  host_->set_power(false, now);
  host_->set_dip(description_.dip);
  host_->set_power(true, now);
  segment_.refresh(host_number_);
  closings_.clear();
  next_step_ = 0;
  is_on_ = true;
  wake();
}

void RunningNetwork::stop() {
  const Time now = segment_.now();
  host_->set_power(false, now);
  segment_.refresh(host_number_);
  is_on_ = false;
  wakes_at_ = kernel::kNever;
}

network::State RunningNetwork::state() const {
  const Time now = segment_.now();
  if (has_response_ && node_drives_.last && attendance_.is_complete()) {
    return now - *node_drives_.last > longest_silence() ? network::State::stopped
                                                        : network::State::exchanging;
  }
  return !is_on_ || now - started_ > bring_up_limit() ? network::State::stopped : network::State::coming_up;
}

// A poll that fails in each attempt.
Duration RunningNetwork::longest_exchange() const {
  const Rules& rules = description_.rules;
  const PollTime poll = reference_poll_time(rules, seats_.back().way);
  const Duration attempt = poll.total() + response_time_out(rules) + poll.silence;
  const Duration write = rules.answers_writes ? rules.read_attempts * attempt : reference_write_time(rules);
  return 2 * write + rules.read_attempts * attempt;
}

// Until a read is answered that waits after others, each with a refresh in front of it.
Duration RunningNetwork::longest_queue() const {
  return 2 * static_cast<std::int64_t>(kCommandsAhead + 1) * longest_exchange();
}

Duration RunningNetwork::longest_silence() const {
  const network::AcceptanceRules rules = acceptance();
  return std::max(rules.least_silence,
                  rules.silence_cycles * static_cast<std::int64_t>(seats_.size()) * longest_exchange());
}

Duration RunningNetwork::bring_up_limit() const {
  return acceptance().least_bring_up + longest_silence();
}

network::RecoveryLimit RunningNetwork::recovery_limit() const {
  const unsigned cycles = acceptance().recovery_cycles;
  return {cycles * seats_.size(), cycles * cycles_.front().theory, "recovery_cycles, each a poll cycle",
          judge::Standing::own};
}

network::ExchangeWords RunningNetwork::exchange_words() const {
  return {"polls", "", "polls without a right response"};
}

std::vector<measure::Condition> RunningNetwork::conditions() const {
  const Rules& rules = description_.rules;
  const PollTime poll = reference_poll_time(rules, seats_.front().way);
  return {
      {"nodes", fmt::format("{} on {:g} m", seats_.size(), description_.length_m)},
      {"bit rate", fmt::format("{} bit/s, position {} of the switches", rules.bit_rate, description_.dip)},
      {"characters", std::string(text_of(rules.characters))},
      {"poll of the first node",
       fmt::format("{}: command {}, turnaround time {}, response {}, silence {}, way {}",
                   kernel::describe(poll.total()), kernel::describe(poll.command),
                   kernel::describe(poll.turnaround_time), kernel::describe(poll.response),
                   kernel::describe(poll.silence), kernel::describe(poll.way))},
      {"write to the first node", kernel::describe(reference_write_time(rules, seats_.front().way))}};
}

std::shared_ptr<const trace::Dissector> RunningNetwork::dissector() const {
  return std::make_shared<FrameDissector>(rules_on_line());
}

std::vector<network::ProtectedFrame> RunningNetwork::protected_frames() const {
  const Duration cycle = cycles_.front().theory / static_cast<std::int64_t>(seats_.size());
  return {{"response", "", 8 * kResponseOctets, cycle}, {"command", "", 8 * kCommandOctets, cycle}};
}

void RunningNetwork::set_source(std::size_t signal, std::uint16_t word) {
  const auto seat = std::ranges::find_if(
      seats_, [signal](const Seat& one) { return signal - one.first_signal < (one.is_written ? 2U : 1U); });
  FIELDPROOF_CHECK(seat != seats_.end(), "a signal of the network is set");
  if (signals_[signal].is_output) {
    seat->valves = word;
    seat->is_given = true;
  } else {
    seat->block.set_input(0, word);
  }
}

void RunningNetwork::set_source_function(std::size_t signal, std::function<std::uint16_t(Time)> word) {
  const auto seat = std::ranges::find_if(
      seats_, [signal](const Seat& one) { return signal - one.first_signal < (one.is_written ? 2U : 1U); });
  FIELDPROOF_CHECK(seat != seats_.end() && !signals_[signal].is_output,
                   "a signal in time is one of an input");
  seat->block.set_signal(0, std::move(word));
}

std::uint16_t RunningNetwork::image(std::size_t) const {
  FIELDPROOF_CHECK(false, "no signal of a valve bus has an image");
  return 0;
}

// From the sample, when the node is sure of the command, to the valves, when the other node is sure of the
// write: both are equally long and end with equally long silences.
Duration RunningNetwork::begin_of(const PollStep& step) const {
  return steady_cycle_.begins.at(static_cast<std::size_t>(std::ranges::find(steps_, step) - steps_.begin()));
}

std::vector<network::CopiedPath> RunningNetwork::paths() const {
  std::vector<network::CopiedPath> paths;
  for (const CopyRule& rule : description_.copy) {
    const Seat& from = seats_[index_of(rule.from)];
    const Seat& to = seats_[index_of(rule.to)];
    std::optional<network::PathTheory> theory;
    if (steady_cycle_.is_steady) {
      const Duration read = begin_of({.node = index_of(rule.from)});
      const Duration write = begin_of({index_of(rule.to), true, index_of(rule.from)});
      theory = {steady_cycle_.time, write - read + to.way - from.way};
    }
    paths.push_back({.name = fmt::format("limit switches of {} to valves of {}", rule.from, rule.to),
                     .from = static_cast<int>(index_of(rule.from)) + 1,
                     .to = static_cast<int>(index_of(rule.to)) + 1,
                     .source = from.first_signal + (from.is_written ? 1 : 0),
                     .sink = to.first_signal,
                     .theory = theory,
                     .why_open = theory ? "" : kNotSteady});
  }
  return paths;
}

void RunningNetwork::end() {
  host_->end();
  for (Seat& seat : seats_) seat.device->end();
}

// ---- the lower tester ----

RunningNetwork::HostDrives::HostDrives(RunningNetwork& network)
    : network_(network), codec_(network.rules_on_line()), collector_(network.rules_on_line()) {}

// A frame is known to have ended when the next one begins, or when somebody asks. What the host sends has
// left its FIFO: there is room for the PC.
void RunningNetwork::HostDrives::on_wave(const line::Waveform& wave) {
  codec_.decode(wave, [this](const line::UartCharacter& character) {
    if (character.start >= collector_.ends_at()) take_frame();
    collector_.add(character);
    end_ = character.start + character_time(network_.rules_on_line());
    if (collector_.frame().count == kCommandOctets) take_frame();
  });
  if (network_.is_held_back_) network_.wake();
}

void RunningNetwork::HostDrives::take_frame() {
  const auto octets = collector_.frame().whole(kCommandOctets);
  if (octets && (*octets)[1] == network_.description_.rules.read_command) {
    if (Seat* const seat = network_.seat_of((*octets)[0])) {
      ++seat->reads;
      if (seat->turnaround) seat->turnaround->ask(end_ + seat->way);
    }
  }
  collector_.clear();
}

// ---- the PC ----

RunningNetwork::Seat* RunningNetwork::seat_of(std::uint8_t id) {
  const std::size_t n = index_of(id);
  return n < seats_.size() ? &seats_[n] : nullptr;
}

void RunningNetwork::wake() {
  wakes_at_ = segment_.now();
  segment_.refresh(pc_number_);
}

void RunningNetwork::on_response(const HostResponse& response, Time when) {
  Seat* const seat = seat_of(response.id);
  // An old response says again what was known.
  if (seat == nullptr || response.is_old) return;
  has_response_ = true;
  seat->switches = static_cast<std::uint16_t>(response.data0 | response.data1 << 8);
  if (watcher_ != nullptr) {
    watcher_->on_shown(seat->first_signal + (seat->is_written ? 1 : 0), seat->switches, when);
    if (seat == &seats_.front()) watcher_->on_cycle_begin(0, when);
  }
  close_later(*seat, Outcome::served);
}

void RunningNetwork::on_error(const HostError& error, Time) {
  Seat* const seat = seat_of(error.id);
  if (seat == nullptr) return;
  if (error.kind == HostErrorKind::not_acknowledged || error.kind == HostErrorKind::readback_mismatch) {
    seat->outcome = Outcome::rejected;
    return;
  }
  close_later(*seat, error.kind == HostErrorKind::no_response ? Outcome::missing : Outcome::rejected);
}

void RunningNetwork::close_later(Seat& seat, Outcome outcome) {
  seat.is_read = false;
  if (!seat.is_open || seat.is_closing) return wake();
  if (outcome != Outcome::served) seat.outcome = outcome;
  seat.is_closing = true;
  const Time at = segment_.now() + (seat.is_written ? rest_of_exchange(description_.rules) : Duration{});
  const auto node = static_cast<std::size_t>(
      std::ranges::find_if(seats_, [&](const Seat& one) { return &one == &seat; }) - seats_.begin());
  const auto after = std::ranges::find_if(closings_, [at](const Closing& other) { return other.at > at; });
  closings_.insert(after, {at, node});
  wake();
}

void RunningNetwork::close(std::size_t node, Time now) {
  Seat& seat = seats_[node];
  // What nobody has asked for on the line is no answer, whatever the host reports.
  if (seat.outcome == Outcome::served && seat.reads == 0) seat.outcome = Outcome::missing;
  const network::Exchange exchange{.end = now,
                                   .kind = network::ExchangeKind::data,
                                   .outcome = seat.outcome,
                                   .retries = std::max(seat.reads, 1U) - 1U,
                                   .first_signal = seat.first_signal,
                                   .signal_count = seat.is_written ? 2U : 1U};
  seat.reads = 0;
  seat.is_open = seat.is_closing = seat.is_read = false;
  seat.outcome = Outcome::served;
  if (watcher_ != nullptr) watcher_->on_exchange(exchange);
}

void RunningNetwork::on_time(Time now) {
  if (!is_on_) return;
  while (!closings_.empty() && closings_.front().at <= now) {
    const std::size_t node = closings_.front().node;
    closings_.pop_front();
    close(node, now);
  }
  give_up_lost(now);
  ask_next(now);
  wakes_at_ = closings_.empty() ? kernel::kNever : closings_.front().at;
  for (const Seat& seat : seats_) {
    if (seat.is_read && !seat.is_closing) wakes_at_ = std::min(wakes_at_, seat.asked + longest_queue());
  }
}

// What the host reports nothing about was lost within it.
void RunningNetwork::give_up_lost(Time now) {
  for (Seat& seat : seats_) {
    if (seat.is_read && !seat.is_closing && seat.asked + longest_queue() <= now)
      close_later(seat, Outcome::missing);
  }
}

bool RunningNetwork::may_ask(const PollStep& step) const {
  const Seat& seat = seats_[step.node];
  if (seat.is_read || seat.is_closing) return false;
  return !step.copied_from || !seats_[*step.copied_from].is_read;
}

void RunningNetwork::ask_next(Time now) {
  const std::size_t all_room = description_.rules.fifo_octets;
  is_held_back_ = false;
  for (std::size_t n = 0; n < steps_.size(); ++n) {
    const std::size_t room = host_->fifo_room();
    const std::size_t waiting = all_room - std::min(all_room, room);
    is_held_back_ = room < kCommandOfPc || waiting >= kCommandsAhead * kCommandOfPc;
    if (is_held_back_) break;
    const PollStep& step = steps_[next_step_];
    if (!may_ask(step)) break;
    Seat& seat = seats_[step.node];
    if (step.copied_from && !seat.is_given) seat.valves = seats_[*step.copied_from].switches;
    const auto word = step.is_write ? seat.valves : std::uint16_t{0};
    const std::array<std::uint8_t, kCommandOfPc> command{
        id_of(seat.description),
        static_cast<std::uint8_t>(step.is_write ? description_.rules.write_command
                                                : description_.rules.read_command),
        static_cast<std::uint8_t>(word & 0xFF), static_cast<std::uint8_t>(word >> 8)};
    seat.is_open = true;
    seat.is_read = !step.is_write;
    if (seat.is_read) seat.asked = now;
    next_step_ = (next_step_ + 1) % steps_.size();
    host_->write(command, now);
  }
  segment_.refresh(host_number_);
}

}  // namespace fieldproof::valve_bus
