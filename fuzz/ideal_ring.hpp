#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/telegram.hpp"
#include "harness/segment/station.hpp"

// A ring of a few stations in one piece, as a master sees it: what comes back of a cycle is what the
// registers held, last station first, followed by the beginning of what was sent; each station shows the next
// one when its control word says so. Written from the definition, with a check that is computed bit by bit.
//
// Whoever makes it is handed each answer before it leaves and may change it (`Line`).
namespace fieldproof::fuzz {

struct SentTelegram {
  std::uint32_t level = 0;
  std::uint8_t header = 0;
  std::uint8_t data = 0;
};

// What comes back of one cycle; telegram n begins with the level of the one that was sent.
struct Answer {
  kernel::Time start;
  std::vector<SentTelegram> telegrams;
  std::size_t transfer = 0;  // the first ones; the check and the status are the last four
  bool is_id_cycle = false;

  // Puts the check of the transfer octets and a clean status in their places.
  void repair();
};

class Line {
 public:
  virtual ~Line() = default;
  virtual void on_answer(Answer& answer) = 0;
};

class IdealRing final : public segment::Station {
 public:
  static constexpr std::size_t kStations = 2;

  IdealRing(const line::TelegramCode& code, std::int64_t bit_rate, Line& line)
      : code_(code), bit_rate_(bit_rate), line_(line) {}

  void receive(segment::PortIndex port, const line::Waveform& wave) override;
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  // Every station has one word.
  static std::uint16_t id_code(std::size_t station) { return station == 0 ? 0x0103 : 0x0102; }
  void set_input(std::size_t station, std::uint16_t value) { inputs_.at(station) = value; }
  std::uint16_t input(std::size_t station) const { return inputs_.at(station); }
  std::uint16_t output(std::size_t station) const { return outputs_.at(station); }

 private:
  void fill_answer();
  void apply(std::size_t visible);

  const line::TelegramCode& code_;
  std::int64_t bit_rate_;
  Line& line_;
  std::array<std::uint16_t, kStations> inputs_{};
  std::array<std::uint16_t, kStations> outputs_{};
  std::size_t visible_ = 1;
  kernel::Time heard_until_{kernel::Duration::min()};
  Answer answer_;
  std::vector<std::uint8_t> sent_;
};

}  // namespace fieldproof::fuzz
