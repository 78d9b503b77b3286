#include "fuzz/slave_model.hpp"

#include <algorithm>

#include "fuzz/reference_line.hpp"

namespace fieldproof::fuzz {
namespace {
constexpr std::size_t kTrailer = 4;
}  // namespace

SlaveModel::SlaveModel(unsigned words, std::int64_t bit_rate, kernel::Duration silence_limit)
    : words_(words), bit_rate_(bit_rate), silence_limit_(silence_limit), receiver_(code_, bit_rate) {}

void SlaveModel::on_wave(const line::Waveform& wave) {
  run_until(wave.start);
  receiver_.receive(wave,
                    [this](const line::Waveform& heard, const line::Telegram& t) { on_telegram(heard, t); });
  // What had begun may have been no telegram.
  end_silence(wave.start, wave.start);
}

void SlaveModel::run_until(kernel::Time now) {
  end_silence(now, silent_from_);
  const kernel::Time pending = receiver_.pending_until();
  if (pending > now) return;
  receiver_.flush([this](const line::Waveform& heard, const line::Telegram& t) { on_telegram(heard, t); });
  // What had begun before the limit may have been no telegram.
  end_silence(now, std::max(silent_from_, pending));
}

void SlaveModel::end_silence(kernel::Time now, kernel::Time when) {
  if (silent_from_ <= now && receiver_.pending_from() >= silent_from_) silence(when);
}

FIELDPROOF_UNINSTRUMENTED void SlaveModel::on_telegram(const line::Waveform& wave,
                                                       const line::Telegram& telegram) {
  const kernel::Time end = kernel::level_time(wave.time_of(telegram.level), telegram.levels(), bit_rate_);
  silent_from_ = end + silence_limit_;
  if (!telegram.is_data()) return;
  const bool is_id = (telegram.header & line::kSelect) != 0;
  const bool is_check = (telegram.header & line::kControl) != 0;
  const Class kind = is_check ? (is_id ? Class::id_check : Class::data_check)
                              : (is_id ? Class::id_transfer : Class::data_transfer);
  on_data(kind, telegram, end);
}

FIELDPROOF_UNINSTRUMENTED void SlaveModel::on_data(Class kind, const line::Telegram& telegram,
                                                   kernel::Time end) {
  const bool is_id = kind == Class::id_transfer || kind == Class::id_check;
  const bool is_check = kind == Class::data_check || kind == Class::id_check;
  const bool goes_on = is_in_cycle_ && is_id == is_id_cycle_ && (is_check || trailer_.empty());
  if (!goes_on) {
    is_in_cycle_ = !is_check;  // a check without a transfer belongs to no cycle
    is_id_cycle_ = is_id;
    is_broken_ = false;
    transfer_.clear();
    trailer_.clear();
    if (is_check) return;
  }
  if (telegram.is_stop_missing()) is_broken_ = true;
  (is_check ? trailer_ : transfer_).push_back(telegram.data);
  if (trailer_.size() == kTrailer) finish_cycle(end);
}

FIELDPROOF_UNINSTRUMENTED bool SlaveModel::is_cycle_good() const {
  const std::uint16_t check = check_bit_by_bit(transfer_);
  // A ring is never shorter than the slave's own register and the loopback word.
  const std::size_t shortest = (is_id_cycle_ ? 2U : 2U * words_) + 2U;
  return !is_broken_ && transfer_.size() >= shortest && trailer_[0] == check >> 8 &&
         trailer_[1] == (check & 0xFF) && trailer_[2] == 0 && trailer_[3] == 0;
}

FIELDPROOF_UNINSTRUMENTED void SlaveModel::finish_cycle(kernel::Time end) {
  is_in_cycle_ = false;
  if (is_cycle_good()) {
    if (is_id_cycle_) is_active_ = true;
    if (!is_id_cycle_ && is_active_) write_outputs(end);
  }
  transfer_.clear();
  trailer_.clear();
}

// The register holds the last words of what was shifted in.
FIELDPROOF_UNINSTRUMENTED void SlaveModel::write_outputs(kernel::Time end) {
  const std::size_t first = transfer_.size() - std::size_t{words_} * 2;
  const auto octet = [&](std::size_t n)
                         FIELDPROOF_UNINSTRUMENTED { return static_cast<unsigned>(transfer_[first + n]); };
  for (unsigned word = 0; word < words_; ++word) {
    writes_.push_back({end, word, static_cast<std::uint16_t>(octet(2U * word) << 8 | octet(2U * word + 1))});
  }
}

void SlaveModel::write_all(std::uint16_t value, kernel::Time when) {
  for (unsigned word = 0; word < words_; ++word) writes_.push_back({when, word, value});
}

void SlaveModel::silence(kernel::Time now) {
  silent_from_ = kernel::kNever;
  is_active_ = false;
  is_in_cycle_ = false;
  write_all(0, now);
}

}  // namespace fieldproof::fuzz
