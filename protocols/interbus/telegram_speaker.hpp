#pragma once

#include <array>
#include <memory>
#include <vector>

#include "harness/iut/device.hpp"
#include "protocols/interbus/telegram_front.hpp"

// A device of levels (ServedSlave, ServedMaster) as one of telegrams: the other side of TelegramFront. What
// it is told becomes the levels of these telegrams, and what it drives is told as the telegrams in it.
//
// Limits: what the device drives beside telegrams, at another bit rate or without a stop level, is not said.
namespace fieldproof::interbus {

class TelegramSpeaker final : public iut::Device, private iut::Bench {
 public:
  // Ports from `line_ports` on are told in characters, whatever the unit.
  TelegramSpeaker(std::unique_ptr<iut::Device> of_levels, unsigned line_ports)
      : device_(std::move(of_levels)), line_ports_(line_ports) {}

  iut::UnitKind unit_kind() const override { return iut::UnitKind::telegrams; }
  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;
  void receive(unsigned port, std::span<const iut::Character> characters, kernel::Time now) override;
  void receive(unsigned port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return device_->next_time(); }
  void end() override { device_->end(); }

 private:
  void hand_over(unsigned port);
  // Whether the telegram can stand in the levels that are collected.
  bool goes_on(const iut::Character& telegram);

  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override {
    bench_->send(port, start, characters);
  }
  void transmit(unsigned port, line::Waveform& wave) override;
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;

  std::unique_ptr<iut::Device> device_;
  unsigned line_ports_;
  iut::Bench* bench_ = nullptr;
  kernel::Time now_{};
  const line::TelegramCode* code_ = nullptr;
  line::Waveform heard_;
  std::vector<std::uint16_t> said_;
  // By port: what could not be said when it was meant to be is over. What was meant to overlap overlaps.
  std::array<kernel::Time, TelegramFront::kPorts> pushed_until_{};
};

}  // namespace fieldproof::interbus
