#include "fuzz/ideal_ring.hpp"

#include <algorithm>

#include "fuzz/reference_line.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::fuzz {
namespace {

constexpr kernel::Duration kSilence = 25 * kernel::kMillisecond;
constexpr std::int64_t kDelayBits = 3;
constexpr std::size_t kTrailer = 4;

FIELDPROOF_UNINSTRUMENTED std::uint16_t check_of(const std::vector<SentTelegram>& telegrams,
                                                 std::size_t count) {
  std::uint16_t check = 0xFFFF;
  for (std::size_t n = 0; n < count; ++n) check = check_bit_by_bit({&telegrams[n].data, 1}, check);
  return check;
}

}  // namespace

void Answer::repair() {
  if (telegrams.size() < transfer + kTrailer) return;
  const std::uint16_t check = check_of(telegrams, transfer);
  telegrams[transfer].data = static_cast<std::uint8_t>(check >> 8);
  telegrams[transfer + 1].data = static_cast<std::uint8_t>(check & 0xFF);
  telegrams[transfer + 2].data = telegrams[transfer + 3].data = 0;
}

void IdealRing::receive(segment::PortIndex, const line::Waveform& wave) {
  if (heard_until_ != kernel::Time{kernel::Duration::min()} && wave.start - heard_until_ >= kSilence) {
    visible_ = 1;
    outputs_.fill(0);
  }
  heard_until_ = wave.end();
  answer_.telegrams.clear();
  code_.decode(wave.levels, 0, [this](const line::Telegram& t) {
    if (t.is_data()) answer_.telegrams.push_back({t.level, t.header, t.data});
  });
  if (answer_.telegrams.empty()) return;
  answer_.start =
      wave.start + kernel::levels_duration(kDelayBits * static_cast<std::int64_t>(visible_), bit_rate_);
  fill_answer();
  line_.on_answer(answer_);
}

void IdealRing::fill_answer() {
  auto& telegrams = answer_.telegrams;
  FIELDPROOF_CHECK(telegrams.size() > kTrailer, "a master sends whole cycles");
  answer_.transfer = telegrams.size() - kTrailer;
  answer_.is_id_cycle = (telegrams.front().header & line::kSelect) != 0;
  const std::uint16_t check = check_of(telegrams, answer_.transfer);
  FIELDPROOF_CHECK(telegrams[answer_.transfer].data == check >> 8 &&
                       telegrams[answer_.transfer + 1].data == (check & 0xFF),
                   "a master sends the check of what it sent");
  sent_.clear();
  for (std::size_t n = 0; n < visible_; ++n) {
    const std::size_t station = visible_ - 1 - n;
    const std::uint16_t word = answer_.is_id_cycle ? id_code(station) : inputs_[station];
    sent_.push_back(static_cast<std::uint8_t>(word >> 8));
    sent_.push_back(static_cast<std::uint8_t>(word & 0xFF));
  }
  for (std::size_t n = 0; n < answer_.transfer; ++n) {
    sent_.push_back(telegrams[n].data);
    telegrams[n].data = sent_[n];
  }
  answer_.repair();
  apply(visible_);
}

// The registers hold what was sent last: the word of the first station is the last one.
void IdealRing::apply(std::size_t visible) {
  const auto word_of = [this](std::size_t station) {
    const std::size_t at = sent_.size() - 2 * station - 2;
    return static_cast<std::uint16_t>(sent_[at] << 8 | sent_[at + 1]);
  };
  for (std::size_t station = 0; station < visible; ++station) {
    if (!answer_.is_id_cycle) outputs_[station] = word_of(station);
  }
  if (!answer_.is_id_cycle) return;
  // Only the remote interface of the first station has something after it.
  visible_ = (word_of(0) & 1) == 0 ? kStations : 1;
}

}  // namespace fieldproof::fuzz
