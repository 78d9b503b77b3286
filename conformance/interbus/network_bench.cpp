#include "conformance/interbus/network_bench.hpp"

#include <utility>

#include "harness/kernel/check.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/observation.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::conformance {
namespace {

using kernel::kMillisecond;

interbus::NetworkDescription built_from(const interbus::NetworkDescription& network,
                                        const NetworkParts& parts) {
  interbus::NetworkDescription built = network;
  if (parts.change_network) parts.change_network(built);
  return built;
}

}  // namespace

void NetworkBench::Listener::on_wave(const line::Waveform& wave) {
  code.decode(wave.levels, 0, [&](const line::Telegram& telegram) {
    if (!telegram.is_data()) return;
    const bool is_transfer = (telegram.header & (line::kSelect | line::kControl)) == 0;
    if (is_transfer && !is_in_transfer) starts.push_back(wave.time_of(telegram.level));
    is_in_transfer = is_transfer;
  });
}

NetworkBench::NetworkBench(interbus::NetworkDescription network, const NetworkParts& parts,
                           const fault::Plan& plan, std::uint64_t seed, Volume volume,
                           std::span<const fault::Stress> stresses)
    : network_(std::move(network)),
      built_(built_from(network_, parts)),
      places_(interbus::ring_order(network_)),
      volume_(volume),
      random_(seed),
      listener_(network_.rules),
      line_watch_(interbus::shortest_telegram(network_.rules)),
      stresses_(stresses) {
  interbus::MasterConfiguration configuration = interbus::master_configuration(network_);
  configuration.rules = built_.rules;
  if (parts.make_master) {
    master_ = parts.make_master(configuration);
  } else {
    master_ = std::make_unique<interbus::Master>(configuration);
  }
  master_seat_ = segment_.attach(*master_, "master");
  ring_ = std::make_unique<interbus::Ring>(segment_, built_, master_seat_, parts.make_slave);
  master_->wire(ring_->out());
  master_->on_cycle_end([this, place = segment_.trace().add_channel("master")](
                            kernel::Time now, bool data_cycle, bool accepted) {
    segment_.trace().observe(place, now, interbus::observed_cycle_end(data_cycle, accepted), 0);
    on_cycle_end(now, data_cycle, accepted);
  });
  ring_->link_to(1).tap_driven(listener_);
  for (segment::Link* link : ring_->links()) line_watch_.watch(*link, segment_.trace());
  for (std::size_t n = 0; n < ring_->remote_links().size(); ++n) stressed_.emplace_back(stresses_);
  install(plan);
}

interbus::ExchangeOracle& NetworkBench::begin_exchange() {
  FIELDPROOF_CHECK(!exchange_, "a network exchanges words once");
  return exchange_.emplace(*master_, *ring_, random_.split("process data"));
}

void NetworkBench::on_cycle_end(kernel::Time now, bool is_data, bool accepted) {
  if (!exchange_) return;
  const std::uint64_t changed = stressed_transmissions();
  exchange_->on_cycle_end(now, is_data, accepted, changed != changed_before_);
  changed_before_ = changed;
}

void NetworkBench::begin_stress(const fault::Stress& stress) {
  const kernel::Random random = random_.split("stress").split(stress_number_++);
  auto stressed = stressed_.begin();
  for (segment::Link* link : ring_->remote_links()) {
    (stressed++)
        ->begin(stress, *link,
                {network_.rules.bit_rate, segment_.now(), random, segment_.trace(), link->trace_channel()});
  }
}

void NetworkBench::end_stress() {
  for (StressedReceiver& one : stressed_) one.end();
}

std::uint64_t NetworkBench::stressed_transmissions() const {
  std::uint64_t sum = 0;
  for (const StressedReceiver& one : stressed_) sum += one.changed();
  return sum;
}

void NetworkBench::install(const fault::Plan& plan) {
  if (plan.empty()) return;
  plan_ = std::make_unique<fault::InstalledPlan>(plan, segment_.trace(), random_.split("plan"));
  ring_->install(*plan_);
}

void NetworkBench::run_behind_sampling() {
  forget_starts();
  run_cycles(2);
  if (listener_.starts.empty()) return;
  segment_.run_until(listener_.starts.back() + status().cycle_time + 200 * kernel::kMicrosecond);
}

bool NetworkBench::bring_up() {
  master_->start(segment_.now());
  segment_.refresh(master_seat_);
  const kernel::Time end = segment_.now() + longest_recognition();
  while (segment_.now() < end) {
    if (status().state == interbus::MasterState::run) return true;
    segment_.run_for(10 * kMillisecond);
  }
  return false;
}

// Recognition adds the stations one by one, each with a few ID cycles through all that are known.
kernel::Duration NetworkBench::longest_recognition() const {
  constexpr std::int64_t kCyclesPerStation = 8;
  const auto stations = static_cast<std::int64_t>(places_.size());
  const kernel::Duration longest_cycle =
      interbus::structural_cycle_time(built_) +
      interbus::frame_time(built_.rules, static_cast<unsigned>(2 * stations)) + kMillisecond;
  return 10 * kernel::kSecond + kCyclesPerStation * stations * longest_cycle;
}

}  // namespace fieldproof::conformance
