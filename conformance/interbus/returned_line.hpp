#pragma once

#include <cstdint>
#include <vector>

#include "conformance/interbus/ring_emulator.hpp"
#include "harness/line/telegram_receiver.hpp"
#include "harness/segment/station.hpp"

// What arrives at a master, cycle by cycle, and whether it is the cycle that was sent: judged from the
// definition of a cycle, with a check that is computed from the polynomial, by nothing that a master has.
namespace fieldproof::conformance {

enum class Arrival : std::uint8_t {
  right,   // the telegrams of the cycle and no others, with their check, a clean status, the loopback word
  wrong,   // something else
  unsure,  // right, and a telegram or the verdict later more: nobody must wait for that
};

class ReturnedLine final : public segment::Tap {
 public:
  explicit ReturnedLine(const interbus::Rules& rules)
      : rules_(rules),
        receiver_(line::shared_telegram_code(rules.telegram), rules.bit_rate),
        check_(line::frame_check_named(rules.frame_check)) {}

  void on_wave(const line::Waveform& wave) override;

  // The next cycle: what is received from now on belongs to it.
  void begin();
  // Of this cycle of the master, whose verdict it took at that instant.
  Arrival judge(const interbus::SeenCycle& sent, kernel::Time verdict);
  // The n-th word that came back.
  std::uint16_t word(std::size_t n) const;

 private:
  struct Received {
    std::uint8_t header;
    std::uint8_t data;
    kernel::Time start;
  };
  void add(const line::Waveform& wave, const line::Telegram& telegram);
  void flush();
  bool is_cycle(std::size_t transfer, bool is_id_cycle) const;

  interbus::Rules rules_;
  line::TelegramReceiver receiver_;
  BitwiseCheck check_;
  std::vector<Received> received_;
};

}  // namespace fieldproof::conformance
