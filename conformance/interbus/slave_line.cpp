#include "conformance/interbus/slave_line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "protocols/interbus/cycle_frame.hpp"

namespace fieldproof::conformance {

void LineView::on_wave(const line::Waveform& wave) {
  waves_.add(wave);
}

void LineView::clear() {
  decode();
  waves_.drop_first(decoded_);
  decoded_ = 0;
  origins_.clear();
  telegrams_.clear();
  data_telegrams_.clear();
  status_count_ = sorted_ = 0;
}

// Nearly always all of them: looked for from the end.
std::size_t LineView::begun() const {
  std::size_t count = waves_.size();
  while (count > 0 && waves_[count - 1].start > segment_.now()) --count;
  return count;
}

void LineView::decode() {
  const auto sink = [this](const line::Waveform& wave, const line::Telegram& telegram) {
    keep(wave, telegram);
  };
  for (const std::size_t count = begun(); decoded_ < count; ++decoded_) {
    origin_of_ = nullptr;
    receiver_.receive(waves_[decoded_], sink);
  }
  origin_of_ = nullptr;
  if (receiver_.pending_until() != kernel::kNever) receiver_.flush(sink);
}

void LineView::add_origin(const line::Waveform& wave) {
  origins_.push_back({wave.start, wave.rate});
  origin_of_ = &wave;
}

std::span<const SeenTelegram> LineView::telegrams() {
  decode();
  return telegrams_;
}

std::span<const SeenTelegram> LineView::data_telegrams() {
  decode();
  if (status_count_ == 0) return telegrams_;
  for (; sorted_ < telegrams_.size(); ++sorted_) {
    if (telegrams_[sorted_].is_data()) data_telegrams_.push_back(telegrams_[sorted_]);
  }
  return data_telegrams_;
}

kernel::Time LineView::start_of(const SeenTelegram& telegram) const {
  const Origin& origin = origins_[telegram.origin];
  return kernel::level_time(origin.start, telegram.level, origin.rate);
}

kernel::Time LineView::end_of(const SeenTelegram& telegram) const {
  return kernel::level_time(start_of(telegram),
                            telegram.is_data() ? line::kDataTelegramLevels : line::kStatusTelegramLevels,
                            bit_rate_);
}

TrainWriter::TrainWriter(const interbus::Rules& rules)
    : layout_(rules.telegram),
      code_(rules.telegram),
      is_msb_first_(rules.telegram.most_significant_first),
      status_pitch_(std::max(rules.status_pitch_bits, line::kStatusTelegramLevels + 1)) {}

void TrainWriter::clear() {
  levels_.clear();
  cycles_.clear();
  data_telegrams_ = 0;
}

void TrainWriter::telegram(std::uint8_t header, std::uint8_t data) {
  const unsigned length =
      (header & line::kDataTelegram) != 0 ? line::kDataTelegramLevels : line::kStatusTelegramLevels;
  data_telegrams_ += length == line::kDataTelegramLevels ? 1 : 0;
  // Telegram and gap are one piece as long as they fit a word.
  const unsigned together = std::min(gap_, 64 - line::kDataTelegramLevels);
  levels_.append(code_.levels_of(header, data) | ~std::uint64_t{0} << length, length + together);
  if (gap_ > together) levels_.append_idle(gap_ - together);
}

void TrainWriter::status(std::size_t count) {
  for (; count > 0; --count) {
    code_.append(levels_, 0, 0);
    levels_.append_idle(status_pitch_ - line::kStatusTelegramLevels);
  }
}

const CyclePlace& TrainWriter::cycle(bool is_id_cycle, std::span<const std::uint8_t> octets,
                                     std::uint16_t check, std::uint16_t status_word) {
  const auto [transfer, trailer] = interbus::cycle_headers(is_id_cycle);
  const std::size_t pitch = line::kDataTelegramLevels + gap_ + status_between_ * status_pitch_;
  cycles_.push_back({levels_.size(), pitch, octets.size(), data_telegrams_, is_id_cycle});
  const auto put = [this](std::uint8_t header, int octet) {
    telegram(header, static_cast<std::uint8_t>(octet & 0xFF));
    if (status_between_ > 0) status(status_between_);
  };
  for (const std::uint8_t octet : octets) put(transfer, octet);
  put(trailer, check >> 8);
  put(trailer, check & 0xFF);
  put(trailer, status_word >> 8);
  put(trailer, status_word & 0xFF);
  return cycles_.back();
}

unsigned TrainWriter::header_level(line::HeaderLevel which) const {
  const auto found = std::find(layout_.header.begin(), layout_.header.end(), which);
  return 1 + static_cast<unsigned>(found - layout_.header.begin());
}

std::string describe(const LineView& view, const SeenTelegram& telegram, kernel::Time from) {
  const kernel::Duration offset = view.start_of(telegram) - from;
  std::string text = fmt::format("{}{}: ", offset < kernel::Duration{} ? "" : "+", kernel::describe(offset));
  if (!telegram.is_data()) {
    text += fmt::format("status telegram SL={} CR={}", telegram.header & 1, telegram.header >> 1 & 1);
  } else {
    text += fmt::format("data telegram SL={} CR={} octet {:02X}h", telegram.header & 1,
                        telegram.header >> 1 & 1, telegram.data);
  }
  if (telegram.is_stop_missing()) text += ", stop level missing";
  return text;
}

}  // namespace fieldproof::conformance
