#include "conformance/interbus/slave_deviants.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace fieldproof::conformance::slave_deviants {

void ExpectsTheUsualLoopbackWord::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (port == interbus::kFromUpstream && reception.rate == rules().bit_rate) {
    const line::TelegramCode code(rules().telegram);
    has_word_.clear();
    std::size_t transfer = 0;
    std::size_t checks = 0;
    std::uint8_t before = 0;
    bool has_word = false;
    code.decode(reception.levels, 0, [&](const line::Telegram& telegram) {
      if (!telegram.is_data()) return;
      if ((telegram.header & line::kControl) != 0) {
        if (++checks == 4) has_word_.push_back(has_word);
        return;
      }
      if (checks > 0) {
        transfer = checks = 0;
        has_word = false;
      }
      const auto word = static_cast<std::uint16_t>(before << 8 | telegram.data);
      if (transfer++ % 2 == 1 && word == rules().loopback_word) has_word = true;
      before = telegram.data;
    });
  }
  Slave::receive(port, reception);
}

bool ExpectsTheUsualLoopbackWord::accepts_cycle(bool own_check_good, bool upstream_clean) const {
  bool has_word = true;
  if (!has_word_.empty()) {
    has_word = has_word_.front();
    has_word_.pop_front();
  }
  return has_word && Slave::accepts_cycle(own_check_good, upstream_clean);
}

void IgnoresSelectInsideACycle::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (port != interbus::kFromUpstream) return Slave::receive(port, reception);
  const auto found = std::find(layout_.header.begin(), layout_.header.end(), line::HeaderLevel::select);
  const auto select = 1 + static_cast<std::size_t>(found - layout_.header.begin());
  line::Waveform patched = reception;
  bool is_in_cycle = false;
  std::uint8_t first = 0;
  code_.decode(reception.levels, 0, [&](const line::Telegram& telegram) {
    if (!telegram.is_data()) return;
    const bool is_check = (telegram.header & line::kControl) != 0;
    if (!is_in_cycle) first = telegram.header;
    is_in_cycle = !is_check;
    if (((telegram.header ^ first) & line::kSelect) != 0) patched.levels.flip(telegram.level + select);
  });
  Slave::receive(port, patched);
}

void NeedsIdleBetweenTelegrams::receive(segment::PortIndex port, const line::Waveform& reception) {
  line::Waveform heard = reception;
  std::size_t end = 0;
  code_.decode(reception.levels, 0, [&](const line::Telegram& telegram) {
    const std::size_t begin = telegram.level;
    if (end > 0 && begin == end) {
      for (std::size_t n = begin; n < begin + telegram.levels(); ++n) heard.levels.set(n, true);
    }
    end = begin + telegram.levels();
  });
  Slave::receive(port, heard);
}

void FollowsAnyRate::receive(segment::PortIndex port, const line::Waveform& reception) {
  const std::int64_t own = rules().bit_rate;
  if (reception.rate == own || std::abs(reception.rate - own) > own / 10)
    return Slave::receive(port, reception);
  line::Waveform adapted = reception;
  adapted.rate = own;
  Slave::receive(port, adapted);
}

void TearsInputs::sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) {
  const kernel::Duration telegram = kernel::levels_duration(line::kDataTelegramLevels, rules().bit_rate);
  for (unsigned word = 0; word < octets.size() / 2; ++word) {
    octets[2 * word] = static_cast<std::uint8_t>(terminals().input(word, when) >> 8);
    octets[2 * word + 1] = static_cast<std::uint8_t>(terminals().input(word, when + telegram) & 0xFF);
  }
}

void TearsBetweenInputWords::sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) {
  const kernel::Duration telegram = kernel::levels_duration(line::kDataTelegramLevels, rules().bit_rate);
  for (unsigned word = 0; word < octets.size() / 2; ++word, when += telegram) {
    const std::uint16_t input = terminals().input(word, when);
    octets[2 * word] = static_cast<std::uint8_t>(input >> 8);
    octets[2 * word + 1] = static_cast<std::uint8_t>(input & 0xFF);
  }
}

void IdRegisterInDataCycle::sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) {
  const std::uint16_t id = configuration().id_code;
  octets[0] = static_cast<std::uint8_t>(id >> 8);
  octets[1] = static_cast<std::uint8_t>(id & 0xFF);
  Slave::sample_inputs(when, octets.subspan(2));
}

void GlitchesOutputsOnRejectedCycle::on_cycle_rejected(kernel::Time when, bool own_error) {
  Slave::on_cycle_rejected(when, own_error);
  if (configuration().words == 0) return;
  const std::uint16_t held = remembering_.first;
  terminals().output(0, 0, when);
  terminals().output(0, held, when + 2 * kernel::kMicrosecond);
}

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

void InterfaceSwitchesInsideCycle::on_control_octet(kernel::Time when) {
  const auto octets = register_octets();
  const auto word = static_cast<std::uint16_t>(octets[0] << 8 | octets[1]);
  // As soon as the register holds what can be a control word.
  if ((word & ~unsigned{heeded_control_bits()}) == 0) apply_control(word, when);
}

void OutgoingResetClearsOutputs::on_id_read(std::uint16_t messages_read) {
  Slave::on_id_read(messages_read);
  const auto octets = register_octets();
  const auto control = static_cast<std::uint16_t>(octets[0] << 8 | octets[1]);
  if ((control & rules().control_reset) != 0) clear_outputs(last_octet_);
}

void SwitchesWithTheBridge::set_next_present(bool on_branch, bool present) {
  Slave::set_next_present(on_branch, present);
  apply_control(present ? rules().control_local_off : rules().control_remote_off, kernel::kStart);
}

}  // namespace fieldproof::conformance::slave_deviants
