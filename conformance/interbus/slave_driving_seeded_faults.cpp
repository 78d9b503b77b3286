#include "conformance/interbus/slave_driving_seeded_faults.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace fieldproof::conformance::slave_seeded_faults {

void ChangesWhatItDrives::wire(const SlavePorts& ports, Terminals& terminals) {
  const auto changing = [this](line::Waveform& wave) { change(wave); };
  changing_[0].attach(ports.upstream, changing);
  changing_[1].attach(ports.branch, changing);
  changing_[2].attach(ports.remote, changing);
  Slave::wire({.upstream = changing_[0].port(), .branch = changing_[1].port(), .remote = changing_[2].port()},
              terminals);
}

void SwallowsStatusTelegrams::change(line::Waveform& wave) {
  const line::Levels before = wave.levels;
  code().decode(before, 0, [&](const line::Telegram& telegram) {
    if (telegram.is_data()) return;
    for (std::size_t n = telegram.level; n < telegram.level + telegram.levels(); ++n)
      wave.levels.set(n, true);
  });
}

void SelectBitInStatusTelegrams::change(line::Waveform& wave) {
  const line::Levels before = wave.levels;
  const std::uint64_t select = code().levels_of(0, 0) ^ code().levels_of(line::kSelect, 0);
  code().decode(before, 0, [&](const line::Telegram& telegram) {
    if (!telegram.is_data())
      wave.levels.flip(telegram.level + static_cast<std::size_t>(std::countr_zero(select)));
  });
}

void FallsSilent::change(line::Waveform& wave) {
  const line::Levels before = wave.levels;
  code().decode(before, 0, [&](const line::Telegram& telegram) {
    const bool is_silent = check_telegrams_left_ == 0;
    if (telegram.is_data() && (telegram.header & line::kControl) != 0 && !is_silent) --check_telegrams_left_;
    if (!is_silent) return;
    for (std::size_t n = telegram.level; n < telegram.level + telegram.levels(); ++n)
      wave.levels.set(n, true);
  });
}

void ChangesAnOctet::change(line::Waveform& wave) {
  const line::Levels before = wave.levels;
  // The level of the least significant bit, found by encoding it.
  const std::uint64_t bit =
      code().levels_of(line::kDataTelegram, 0) ^ code().levels_of(line::kDataTelegram, 1);
  code().decode(before, 0, [&](const line::Telegram& telegram) {
    if (!telegram.is_data()) return;
    if ((telegram.header & line::kControl) != 0) {
      transfer_ = 0;
      return;
    }
    if (is_meant((telegram.header & line::kSelect) != 0, transfer_, before_, telegram.data))
      wave.levels.flip(telegram.level + static_cast<std::size_t>(std::countr_zero(bit)));
    before_ = telegram.data;
    ++transfer_;
  });
}

void DoesNotRetime::change(line::Waveform& wave) {
  constexpr std::size_t kPerBit = 20;
  constexpr std::size_t kLonger = 2;  // each low pulse
  line::Levels distorted;
  std::size_t idle_owed = 0;
  for (std::size_t n = 0; n < wave.levels.size(); ++n) {
    const bool level = wave.levels[n];
    const bool rises_next = !level && (n + 1 == wave.levels.size() || wave.levels[n + 1]);
    distorted.append_fill(level, kPerBit + (rises_next ? kLonger : 0) - idle_owed);
    idle_owed = rises_next ? kLonger : 0;
  }
  wave.levels = distorted;
  wave.rate *= static_cast<std::int64_t>(kPerBit);
}

namespace {

constexpr std::int64_t kFinePerBit = 100;
constexpr std::int64_t kLate = 24;  // of these

}  // namespace

void SamplesLate::receive(segment::PortIndex port, const line::Waveform& reception) {
  told_ = reception.start;
  if ((port != interbus::kFromUpstream) != on_the_way_back_) return Slave::receive(port, reception);
  const std::int64_t bit_rate = rules().bit_rate;
  const auto factor = static_cast<std::size_t>(
      std::max<std::int64_t>(1, (kFinePerBit * bit_rate + reception.rate / 2) / reception.rate));
  line::Waveform fine{reception.start, reception.rate * static_cast<std::int64_t>(factor), {}};
  for (std::size_t n = 0; n < reception.levels.size(); ++n)
    fine.levels.append_fill(reception.levels[n], factor);
  finder_.receive(reception, [&](const line::Waveform& wave, const line::Telegram& telegram) {
    if (&wave != &reception) return;
    for (std::size_t n = 0; n < kLate; ++n) fine.levels.set(telegram.level * factor + n, true);
  });
  Slave::receive(port, fine);
}

void SamplesLate::change(line::Waveform& wave) {
  wave.start = std::max(told_, wave.start - kernel::levels_duration(kLate, rules().bit_rate * kFinePerBit));
}

void TakesGlitchesOnTheWayBack::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (port == interbus::kFromUpstream) return Slave::receive(port, reception);
  const auto bit = static_cast<std::size_t>(reception.rate / rules().bit_rate);
  line::Waveform widened = reception;
  std::size_t low = 0;
  for (std::size_t n = 0; n < reception.levels.size(); ++n) {
    if (!reception.levels[n]) {
      ++low;
      continue;
    }
    if (low > 0 && 2 * low < bit) {
      for (std::size_t more = 0; more < bit - low; ++more) widened.levels.set(n + more, false);
    }
    low = 0;
  }
  Slave::receive(port, widened);
}

void DropsACutTelegram::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (port != interbus::kFromUpstream) return Slave::receive(port, reception);
  finder_.receive(reception, [](const line::Waveform&, const line::Telegram&) {});
  const kernel::Time cut = finder_.pending_from();
  line::Waveform whole = reception;
  for (std::size_t n = 0; n < whole.levels.size(); ++n)
    if (whole.time_of(n) >= cut) whole.levels.set(n, true);
  Slave::receive(port, whole);
}

void LosesTheRestOfACutTelegram::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (port != interbus::kFromUpstream) return Slave::receive(port, reception);
  const bool has_cut = finder_.pending_from() != kernel::kNever;
  const kernel::Time until = finder_.pending_until();
  finder_.receive(reception, [](const line::Waveform&, const line::Telegram&) {});
  if (!has_cut || until <= reception.start) return Slave::receive(port, reception);
  line::Waveform rest = reception;
  for (std::size_t n = 0; n < rest.levels.size() && rest.time_of(n) < until; ++n) rest.levels.set(n, true);
  Slave::receive(port, rest);
}

void SendsDataAtPowerUp::on_time(kernel::Time now) {
  if (greeting_ <= now) {
    greeting_ = kernel::kNever;
    line::Waveform wave{now, rules().bit_rate, {}};
    line::TelegramCode(rules().telegram).append(wave.levels, line::kDataTelegram, 0x00);
    upstream_->drive(wave);
  }
  Slave::on_time(now);
}

void DrivesOverItself::receive(segment::PortIndex port, const line::Waveform& reception) {
  Slave::receive(port, reception);
  if (port != interbus::kFromUpstream) return;
  line::Waveform wave{reception.end(), rules().bit_rate, {}};
  line::shared_telegram_code(rules().telegram).append(wave.levels, 0, 0x00);
  upstream_->drive(wave);
}

kernel::Time SendsDataAtPowerUp::next_time() const {
  return std::min(greeting_, Slave::next_time());
}

}  // namespace fieldproof::conformance::slave_seeded_faults
