#include "conformance/interbus/network_bench.hpp"

#include <algorithm>
#include <utility>

#include "harness/kernel/check.hpp"
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

NetworkBench::NetworkBench(const NoNeeds&, const NetworkSetting& setting)
    : network_(setting.network),
      built_(built_from(network_, setting.parts)),
      places_(interbus::ring_order(network_)),
      volume_(setting.volume),
      random_(setting.seed),
      running_(built_, {.make_master = setting.parts.make_master, .make_slave = setting.parts.make_slave},
               &network_),
      line_watch_(interbus::shortest_telegram(network_.rules)),
      stresses_(setting.stresses) {
  running_.on_cycle_end([this, place = segment().trace().add_channel("master")](
                            kernel::Time now, bool data_cycle, bool accepted) {
    segment().trace().observe(place, now, interbus::observed_cycle_end(data_cycle, accepted), 0);
  });
  running_.watch(*this);
  running_.keep_starts();
  for (segment::Link* link : ring().links()) line_watch_.watch(*link, segment().trace());
  for (std::size_t n = 0; n < ring().remote_links().size(); ++n) stressed_.emplace_back(stresses_);
  install(setting.plan);
  if (setting.make_recorder) {
    segment().trace().set_recorder(setting.make_recorder(segment().trace(), network_.rules));
  }
}

network::ExchangeStatistics& NetworkBench::begin_exchange() {
  FIELDPROOF_CHECK(!exchange_, "a network exchanges words once");
  return exchange_.emplace(running_, random_.split("process data"));
}

void NetworkBench::on_exchange(const network::Exchange& exchange) {
  if (!exchange_) return;
  const std::uint64_t changed = stressed_transmissions();
  exchange_->on_exchange(
      exchange, changed != changed_before_ ? network::LineEffect::changed : network::LineEffect::untouched);
  changed_before_ = changed;
}

void NetworkBench::on_shown(std::size_t signal, std::uint16_t word, kernel::Time when) {
  if (exchange_) exchange_->on_shown(signal, word, when);
}

void NetworkBench::begin_stress(const fault::Stress& stress) {
  const kernel::Random random = random_.split("stress").split(stress_number_++);
  auto stressed = stressed_.begin();
  for (segment::Link* link : ring().remote_links()) {
    (stressed++)
        ->begin(stress, *link,
                {network_.rules.bit_rate, segment().now(), random, segment().trace(), link->trace_channel()});
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
  plan_ = std::make_unique<fault::InstalledPlan>(plan, segment().trace(), random_.split("plan"));
  ring().install(*plan_);
}

void NetworkBench::run_behind_sampling() {
  keep_starts();
  run_cycles(2);
  if (data_cycle_starts().empty()) return;
  // A number that the master has made up is not waited for.
  const kernel::Duration cycle =
      std::clamp<kernel::Duration>(status().cycle_time, kernel::Duration::zero(), kernel::kSecond);
  segment().run_until(data_cycle_starts().back() + cycle + 200 * kernel::kMicrosecond);
}

bool NetworkBench::bring_up() {
  running_.start();
  const kernel::Time end = segment().now() + running_.bring_up_limit();
  while (segment().now() < end) {
    if (status().state == interbus::MasterState::run) return true;
    segment().run_for(10 * kMillisecond);
  }
  return false;
}

}  // namespace fieldproof::conformance
