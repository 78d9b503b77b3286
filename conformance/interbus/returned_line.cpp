#include "conformance/interbus/returned_line.hpp"

#include <algorithm>

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kCheckAndStatus = 4;

}  // namespace

void ReturnedLine::on_wave(const line::Waveform& wave) {
  receiver_.receive(wave, [this](const line::Waveform& of, const line::Telegram& one) { add(of, one); });
}

void ReturnedLine::add(const line::Waveform& wave, const line::Telegram& telegram) {
  if (telegram.is_data()) received_.push_back({telegram.header, telegram.data, wave.time_of(telegram.level)});
}

void ReturnedLine::flush() {
  receiver_.flush([this](const line::Waveform& of, const line::Telegram& one) { add(of, one); });
}

void ReturnedLine::begin() {
  flush();
  received_.clear();
}

std::uint16_t ReturnedLine::word(std::size_t n) const {
  return static_cast<std::uint16_t>(received_.at(2 * n).data << 8 | received_.at(2 * n + 1).data);
}

Arrival ReturnedLine::judge(const interbus::SeenCycle& sent, kernel::Time verdict) {
  if (receiver_.pending_until() <= verdict) flush();
  const std::size_t count = sent.transfer_octets + kCheckAndStatus + rules_.end_telegrams;
  if (sent.transfer_octets < 2 || received_.size() < count) return Arrival::wrong;
  if (!is_cycle(sent.transfer_octets, sent.is_id_cycle)) return Arrival::wrong;
  if (received_.size() == count) return Arrival::right;
  constexpr std::int64_t kOwnAndOneMore = 2 * line::kDataTelegramLevels;
  const kernel::Time certain =
      received_[count - 1].start + kernel::levels_duration(kOwnAndOneMore, rules_.bit_rate);
  return received_[count].start < std::min(verdict, certain) ? Arrival::wrong : Arrival::unsure;
}

// The loopback word comes back last; in an ID cycle, where the register ends.
bool ReturnedLine::is_cycle(std::size_t transfer, bool is_id_cycle) const {
  std::vector<std::uint8_t> octets;
  for (std::size_t n = 0; n < transfer + kCheckAndStatus + rules_.end_telegrams; ++n) {
    unsigned header = line::kDataTelegram;
    if (is_id_cycle) header |= line::kSelect;
    if (n >= transfer) header |= line::kControl;
    if (received_[n].header != header) return false;
    octets.push_back(received_[n].data);
  }
  const std::size_t words = transfer / 2;
  if (word(words) != check_.of({octets.data(), transfer})) return false;
  if (word(words + 1) != rules_.status_clean) return false;
  for (std::size_t n = is_id_cycle ? 0 : words - 1; n < words; ++n) {
    if (word(n) == rules_.loopback_word) return true;
  }
  return false;
}

}  // namespace fieldproof::conformance
