#include "protocols/interbus/live_network.hpp"

namespace fieldproof::interbus {

// A cycle is one waveform, and its first data telegram says which kind it is.
void LiveNetwork::Listener::on_wave(const line::Waveform& wave) {
  bool is_first = true;
  code.decode(wave.levels, 0, [&](const line::Telegram& telegram) {
    if (!telegram.is_data() || !is_first) return;
    is_first = false;
    if (telegram.header == kDataCycle.transfer) starts.push_back(wave.time_of(telegram.level));
  });
}

LiveNetwork::LiveNetwork(const NetworkDescription& network, const Ring::MakeSlave& make_slave)
    : master_(master_configuration(network)),
      master_seat_(segment_.attach(master_, "master")),
      ring_(segment_, network, master_seat_, make_slave),
      listener_(network.rules) {
  master_.wire(ring_.out());
  ring_.link_to(1).tap_driven(listener_);
}

bool LiveNetwork::bring_up() {
  constexpr kernel::Duration kStep = 10 * kernel::kMillisecond;
  constexpr int kSteps = 1'000;
  master_.start(segment_.now());
  segment_.refresh(master_seat_);
  for (int step = 0; step < kSteps && status().state != MasterState::run; ++step) segment_.run_for(kStep);
  return status().state == MasterState::run;
}

}  // namespace fieldproof::interbus
