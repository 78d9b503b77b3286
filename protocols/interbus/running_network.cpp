#include "protocols/interbus/running_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "harness/line/frame_check.hpp"
#include "protocols/interbus/cycle_dissector.hpp"
#include "protocols/interbus/cycle_frame.hpp"
#include "protocols/interbus/latching_slave.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/station_timing.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::Duration;
using kernel::kMillisecond;
using kernel::Time;

// Recognition adds the stations one by one, each with a few ID cycles through all that are known.
constexpr std::int64_t kCyclesPerStation = 8;

std::unique_ptr<MasterDevice> make_master(const RunningStations& stations,
                                          const MasterConfiguration& configuration) {
  if (stations.make_master) return stations.make_master(configuration);
  return std::make_unique<Master>(configuration);
}

MasterConfiguration configuration_of(const NetworkDescription& built, const NetworkDescription* configured) {
  MasterConfiguration configuration = master_configuration(configured != nullptr ? *configured : built);
  configuration.rules = built.rules;
  return configuration;
}

// References latch as the options say.
Ring::MakeSlave slaves_of(const NetworkDescription& network, const RunningStations& stations) {
  if (stations.latch == LatchModel::frame_edges) return stations.make_slave;
  const Duration way = sample_to_latch(network);
  return [make = stations.make_slave, latch = stations.latch, way](
             int position, const SlaveConfiguration& configuration) -> std::unique_ptr<SlaveDevice> {
    if (auto given = make ? make(position, configuration) : nullptr) return given;
    return std::make_unique<LatchingSlave>(configuration, latch, way);
  };
}

Duration longest_cycle_of(const NetworkDescription& network) {
  const auto stations = static_cast<unsigned>(ring_order(network).size());
  const Duration id_cycle =
      frame_time(network.rules, 2 * (stations + 1)) + ring_delay(network) + network.rules.software_time;
  const Duration data_cycle = cycle_time_in_force(network);
  // An ID cycle among data cycles takes a whole number of their times.
  return (id_cycle + data_cycle - kernel::kPicosecond) / data_cycle * data_cycle;
}

}  // namespace

void RunningNetwork::Output::on_wave(const line::Waveform& wave) {
  code.decode(wave.levels, 0, [&](const line::Telegram& telegram) {
    if (!telegram.is_data() || telegram.header == phase) return;
    phase = telegram.header;
    const bool is_data_cycle = phase == kDataCycle.transfer;
    if (!is_data_cycle && (phase & line::kControl) != 0) return;
    const Time start = wave.time_of(telegram.level);
    last_cycle = start;
    if (!is_data_cycle) return;
    has_data_cycle = true;
    if (keeps_starts) starts.push_back(start);
    if (network.watcher_ != nullptr) network.watcher_->on_cycle_begin(0, start);
  });
}

RunningNetwork::RunningNetwork(const NetworkDescription& built, const RunningStations& stations,
                               const NetworkDescription* configured)
    : description_(built),
      latch_(stations.latch),
      master_(make_master(stations, configuration_of(built, configured))),
      master_seat_(segment_.attach(*master_, "master")),
      ring_(segment_, description_, master_seat_, slaves_of(description_, stations)),
      output_(*this, description_.rules),
      longest_cycle_(longest_cycle_of(description_)) {
  master_->wire(ring_.out());
  master_->on_cycle_end(
      [this](Time now, bool is_data, bool accepted) { finish_cycle(now, is_data, accepted); });
  ring_.link_to(1).tap_driven(output_);
  find_places(stations.are_references());
  find_signals();
  cycles_ = {{"cycle", cycle_time_in_force(description_), "structure of the frame, or the requested time"}};
}

void RunningNetwork::find_places(bool are_references) {
  for (int position = 1; position <= static_cast<int>(ring_.size()); ++position) {
    const bool is_local = ring_.configuration(position).is_local;
    for (segment::Link* link : {&ring_.link_to(position), &ring_.link_from(position)}) {
      places_.push_back({.name = link->name(),
                         .receiver = link,
                         .trace_channel = link->trace_channel(),
                         .level_rate = description_.rules.bit_rate,
                         .units = description_.rules.telegram,
                         .has_whole_units = are_references,
                         .is_exposed = !is_local,
                         .why_not = is_local ? "a local bus has no cable that lies in a clamp" : ""});
    }
  }
}

void RunningNetwork::find_signals() {
  for (int position = 1; position <= static_cast<int>(ring_.size()); ++position) {
    const SlaveConfiguration& station = ring_.configuration(position);
    for (unsigned word = 0; word < station.words; ++word) {
      words_.push_back({position, word});
      const std::string place = fmt::format("{} word {} (slave@{})", station.name, word, position);
      signals_.push_back({.name = "output to " + place, .is_output = true, .safe_value = std::uint16_t{0}});
      signals_.push_back({.name = "input of " + place, .is_image = true});
    }
    ring_.terminals(position).on_change(
        [this, first = ring_.first_word(position)](const TerminalBlock::Change& change) {
          if (watcher_ != nullptr) watcher_->on_shown(2 * (first + change.word), change.after, change.when);
        });
  }
}

void RunningNetwork::start() {
  started_ = segment_.now();
  output_.last_cycle.reset();
  output_.has_data_cycle = false;
  output_.phase = 0;
  master_->start(segment_.now());
  segment_.refresh(master_seat_);
}

void RunningNetwork::stop() {
  master_->stop(segment_.now());
}

network::State RunningNetwork::state() const {
  const Time now = segment_.now();
  const Duration silence = acceptance().silence_cycles * longest_cycle_;
  if (output_.has_data_cycle) {
    return now - *output_.last_cycle > silence ? network::State::stopped : network::State::exchanging;
  }
  // A recognition pauses for the silence in which stations fall into reset and for as long as a master shows
  // status telegrams in front of it: some 50 ms together.
  if (now - output_.last_cycle.value_or(started_) > acceptance().least_silence + silence ||
      now - started_ > bring_up_limit()) {
    return network::State::stopped;
  }
  return network::State::coming_up;
}

Duration RunningNetwork::bring_up_limit() const {
  const auto stations = static_cast<std::int64_t>(ring_.size());
  const Duration id_cycle = frame_time(description_.rules, static_cast<unsigned>(2 * stations));
  return acceptance().least_bring_up +
         kCyclesPerStation * stations * (structural_cycle_time(description_) + id_cycle + 2 * kMillisecond);
}

network::AcceptanceRules RunningNetwork::acceptance() const {
  network::AcceptanceRules rules;
  rules.recovery_cycles = description_.rules.published_recovery_cycles;
  return rules;
}

network::RecoveryLimit RunningNetwork::recovery_limit() const {
  const unsigned cycles = acceptance().recovery_cycles;
  return {cycles, cycles * cycle_time_in_force(description_), "published number of cycles",
          judge::Standing::searched};
}

std::vector<measure::Condition> RunningNetwork::conditions() const {
  const auto time = [](Duration duration) { return kernel::describe(duration); };
  const NetworkDescription& network = description_;
  return {{"latch model", fmt::format("{}: {}", interbus::name(latch_), describe(latch_))},
          {fmt::format("cycle time by {}", interbus::name(network.formula)),
           time(cycle_time(network.formula, timing_input(network)))},
          {"cycle time by the structure of the frame", time(structural_cycle_time(network))},
          {"cycle time requested", network.cycle_time ? time(*network.cycle_time) : "the shortest"}};
}

std::shared_ptr<const trace::Dissector> RunningNetwork::dissector() const {
  return std::make_shared<CycleDissector>(description_.rules);
}

std::vector<network::ProtectedFrame> RunningNetwork::protected_frames() const {
  constexpr unsigned kLoopbackBits = 16;
  const std::string& check = description_.rules.frame_check;
  return {{"data cycle", check,
           kLoopbackBits + 8 * timing_input(description_).user_octets + line::frame_check_named(check).width,
           cycle_time_in_force(description_)}};
}

void RunningNetwork::set_source(std::size_t signal, std::uint16_t word) {
  const WordPlace& place = words_[signal / 2];
  if (signal % 2 == 0) {
    master_->write_output(static_cast<unsigned>(signal / 2), word, segment_.now());
  } else {
    ring_.terminals(place.position).set_input(place.word, word);
  }
}

void RunningNetwork::set_source_function(std::size_t signal, std::function<std::uint16_t(Time)> word) {
  const WordPlace& place = words_[signal / 2];
  ring_.terminals(place.position).set_signal(place.word, std::move(word));
}

std::vector<network::CopiedPath> RunningNetwork::paths() const {
  const auto position_of = [this](const std::string& station) {
    int position = 1;
    while (ring_.configuration(position).name != station) ++position;
    return position;
  };
  std::vector<network::CopiedPath> paths;
  for (const CopyRule& rule : description_.copy) {
    const int from = position_of(rule.from);
    const int to = position_of(rule.to);
    paths.push_back({.name = fmt::format("{} word {} to {} word {}", rule.from, rule.input_word, rule.to,
                                         rule.output_word),
                     .from = from,
                     .to = to,
                     .source = 2 * std::size_t{ring_.first_word(from) + rule.input_word} + 1,
                     .sink = 2 * std::size_t{ring_.first_word(to) + rule.output_word},
                     .theory = network::PathTheory{cycle_time_in_force(description_),
                                                   path_delay(description_, from, to, latch_).min}});
  }
  return paths;
}

std::uint16_t RunningNetwork::image(std::size_t signal) const {
  return master_->input(static_cast<unsigned>(signal / 2));
}

void RunningNetwork::end() {
  master_->end();
  ring_.end();
}

void RunningNetwork::finish_cycle(Time now, bool is_data, bool accepted) {
  if (hook_) hook_(now, is_data, accepted);
  if (watcher_ == nullptr) return;
  watcher_->on_exchange({.end = now,
                         .kind = is_data ? network::ExchangeKind::data : network::ExchangeKind::service,
                         .outcome = accepted ? network::Outcome::served : network::Outcome::rejected,
                         .retries = 0,
                         .first_signal = 0,
                         .signal_count = signals_.size()});
}

bool RunningNetwork::bring_up() {
  constexpr Duration kStep = 10 * kMillisecond;
  start();
  const Time end = segment_.now() + bring_up_limit();
  while (segment_.now() < end && state() != network::State::exchanging) segment_.run_for(kStep);
  return state() == network::State::exchanging;
}

std::string_view name(LatchModel model) {
  constexpr std::array<std::string_view, 3> kNames = {"M1", "M2", "M3"};
  return kNames.at(static_cast<std::size_t>(model));
}

std::string_view describe(LatchModel model) {
  constexpr std::array<std::string_view, 3> kTexts = {
      "inputs and outputs at one instant (a bound that no station reaches)",
      "inputs at the start of the frame, outputs at its end",
      "inputs at the end of the frame before, outputs at the end of the frame"};
  return kTexts.at(static_cast<std::size_t>(model));
}

Duration frame_between(const NetworkDescription& network, int from, int to) {
  const std::vector<Duration> arrivals = arrival_delays(network);
  const auto arrival = [&](int position) { return arrivals.at(static_cast<std::size_t>(position - 1)); };
  return sample_to_latch(network) + arrival(to) - arrival(from);
}

EdgeDelay path_delay(const NetworkDescription& network, int from, int to, LatchModel model) {
  const Duration frame = sample_to_latch(network);
  const Duration way = frame_between(network, from, to) - frame;
  EdgeDelay delay = edge_delay(model, cycle_time_in_force(network), frame);
  for (Duration* part : {&delay.min, &delay.mean, &delay.max}) *part += way;
  return delay;
}

Duration cycle_time_in_force(const NetworkDescription& network) {
  return std::max(structural_cycle_time(network), network.cycle_time.value_or(Duration::zero()));
}

}  // namespace fieldproof::interbus
