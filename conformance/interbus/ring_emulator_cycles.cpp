// What the emulated ring does with a cycle, and what it remembers of it.
#include <fmt/format.h>

#include <algorithm>

#include "conformance/interbus/ring_emulator.hpp"
#include "harness/iut/attached_case.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::interbus {

namespace {

constexpr std::size_t kCheckOctets = 4;
constexpr std::uint8_t kJunk = 0xFF;  // shifted out of register places that hold nothing

std::uint8_t octet_of(std::uint16_t word, std::size_t n) {
  return static_cast<std::uint8_t>(n == 0 ? word >> 8 : word & 0xFF);
}

}  // namespace

void RingEmulator::begin_cycle(const line::Waveform& wave, const line::Telegram& telegram) {
  const kernel::Time when = wave.time_of(telegram.level);
  phase_ = Phase::transfer;
  is_id_cycle_ = (telegram.header & line::kSelect) != 0;
  own_error_ = is_marked_ = false;
  transferred_ = checked_ = 0;
  load_register(when);
  if (is_faulted_) faults_ = {};
  is_faulted_ = false;
  if (script_) {
    script_({cycle_count_, statistics_.data_cycles, is_id_cycle_, register_octets_, when}, faults_);
    is_faulted_ = !faults_.is_none();
  }
  if (is_id_cycle_) {
    ++statistics_.id_cycles;
    last_data_start_.reset();
  } else {
    ++statistics_.data_cycles;
    if (last_data_start_) {
      statistics_.shortest_cycle = std::min(statistics_.shortest_cycle, when - *last_data_start_);
      statistics_.longest_cycle = std::max(statistics_.longest_cycle, when - *last_data_start_);
    }
    last_data_start_ = when;
  }
  if (cycle_count_ == 1) first_ = open_cycle();
  ++cycle_count_;
  SeenCycle& seen = open_cycle();
  seen.number = cycle_count_ - 1;
  seen.is_id_cycle = is_id_cycle_;
  seen.in_phase = true;
  seen.check_good = seen.status_clean = false;
  seen.start = seen.end = when;
  seen.octets.clear();
  seen.transfer_octets = 0;
}

// The last station's register leaves first.
void RingEmulator::load_register(kernel::Time when) {
  stream_.clear();
  returned_.clear();
  const auto put = [this](std::uint16_t word) {
    stream_.push_back(octet_of(word, 0));
    stream_.push_back(octet_of(word, 1));
  };
  if (is_id_cycle_) {
    for (auto n = active_.rbegin(); n != active_.rend(); ++n) {
      put(static_cast<std::uint16_t>(stations_[*n].id_code | steady_messages_[*n] | error_messages_[*n]));
    }
  } else {
    for (const unsigned word : word_order_) put(signal_ ? signal_(word, when) : inputs_[word]);
  }
  register_octets_ = stream_.size();
}

// The octet that leaves with telegram `index`: eight bits of the stream, from a place that depends on how
// many bits the register has.
std::uint8_t RingEmulator::shifted_octet(std::size_t index) const {
  if (!is_faulted_ || faults_.longer_bits == 0) return stream_[index];
  const auto bit = 8 * static_cast<std::int64_t>(index) - faults_.longer_bits;
  unsigned octet = 0;
  for (std::int64_t n = bit; n < bit + 8; ++n) {
    unsigned value = 1;
    if (n >= 0 && static_cast<std::size_t>(n / 8) < stream_.size()) {
      const unsigned source = stream_[static_cast<std::size_t>(n / 8)];
      value = (source >> (7 - n % 8)) & 1U;
    }
    octet = octet << 1 | value;
  }
  return static_cast<std::uint8_t>(octet);
}

void RingEmulator::on_transfer(const line::Telegram& telegram) {
  stream_.push_back(telegram.data);
  std::uint8_t octet = shifted_octet(transferred_);
  if (is_faulted_) {
    for (const CycleFaults::Flip& flip : faults_.flips) {
      if (flip.telegram == transferred_ && flip.check_fits) octet ^= flip.mask;
    }
  }
  returned_.push_back(octet);
  emit(telegram, octet);
  ++transferred_;
}

void RingEmulator::on_check(const line::Waveform& wave, const line::Telegram& telegram) {
  SeenCycle& seen = open_cycle();
  if (phase_ == Phase::transfer) {
    phase_ = Phase::check;
    seen.transfer_octets = transferred_;
    received_check_ = check_of({stream_.data() + register_octets_, transferred_});
    sent_check_ = check_of(returned_);
  }
  std::uint8_t octet = telegram.data;
  const std::size_t n = checked_++;
  if (n < 2) {
    if (telegram.data != octet_of(received_check_, n)) own_error_ = true;
    octet = octet_of(sent_check_, n);
  } else if (n < kCheckOctets) {
    if (telegram.data != octet_of(rules_.status_clean, n - 2)) is_marked_ = true;
    const bool is_marked_here = is_faulted_ && faults_.marked_by >= 0;
    const std::uint16_t mark =
        is_marked_here ? faults_.mark.value_or(rules_.status_marked) : rules_.status_marked;
    if (own_error_ || is_marked_here) octet |= octet_of(mark, n - 2);
  }
  emit(telegram, octet);
  if (n + 1 != kCheckOctets) return;
  seen.end = kernel::level_time(wave.time_of(telegram.level), telegram.levels(), rules_.bit_rate);
  finish_cycle();
}

void RingEmulator::finish_cycle() {
  SeenCycle& seen = open_cycle();
  seen.check_good = !own_error_;
  seen.status_clean = !is_marked_;
  phase_ = Phase::pause;
  expects_status_ = true;
  if (own_error_) {
    ++statistics_.bad_checks;
    if (!active_.empty()) error_messages_[active_.front()] |= rules_.message_check_error;
    return;
  }
  if (is_faulted_ && faults_.marked_by >= 0) {
    error_messages_.at(static_cast<std::size_t>(faults_.marked_by)) |= rules_.message_check_error;
    if (faults_.also_marked_by >= 0)
      error_messages_.at(static_cast<std::size_t>(faults_.also_marked_by)) |= rules_.message_check_error;
    return;
  }
  if (is_marked_) return;
  if (is_id_cycle_) {
    apply_control_words();
  } else {
    latch(seen.end);
  }
}

// The register holds the last octets that came in; what it cannot be filled with stays as it was.
void RingEmulator::latch(kernel::Time when) {
  const std::size_t first = stream_.size() - register_octets_;
  for (std::size_t n = 0; n < word_order_.size(); ++n) {
    outputs_[word_order_[n]] =
        static_cast<std::uint16_t>(stream_[first + 2 * n] << 8 | stream_[first + 2 * n + 1]);
  }
  if (on_outputs_) on_outputs_(outputs_, when);
}

void RingEmulator::apply_control_words() {
  const auto interface_bits =
      static_cast<std::uint16_t>(rules_.control_remote_off | rules_.control_local_off);
  std::size_t at = stream_.size() - register_octets_;
  for (auto n = active_.rbegin(); n != active_.rend(); ++n, at += 2) {
    const auto control = static_cast<std::uint16_t>(stream_[at] << 8 | stream_[at + 1]);
    interfaces_[*n] = control & interface_bits;
    error_messages_[*n] = 0;  // read
  }
  close_ring();
}

void RingEmulator::emit(const line::Telegram& telegram, std::uint8_t octet) {
  const auto header = static_cast<std::uint8_t>(telegram.header & 7);
  std::uint64_t levels = code_.levels_of(header, octet);
  if (!is_faulted_) return emit_levels(telegram_bit_, levels, line::kDataTelegramLevels);
  const auto index =
      static_cast<int>((header & line::kControl) != 0 ? transferred_ + checked_ - 1 : transferred_);
  for (const CycleFaults::Flip& flip : faults_.flips) {
    if (static_cast<int>(flip.telegram) == index && !flip.check_fits) octet ^= flip.mask;
  }
  levels = code_.levels_of(header, octet);
  for (const CycleFaults::LevelFlip& flip : faults_.level_flips) {
    if (static_cast<int>(flip.telegram) == index) levels ^= std::uint64_t{1} << flip.level;
  }
  if (faults_.stop_missing == index) levels &= ~(std::uint64_t{1} << (line::kDataTelegramLevels - 1));
  if (faults_.flag_flipped == index) levels ^= std::uint64_t{1} << flag_level_;
  if (faults_.header_flipped == index) levels ^= std::uint64_t{1} << (flag_level_ == 1 ? 2 : 1);
  if (faults_.dropped == index) return;
  if (faults_.inserted == index) {
    emit_levels(telegram_bit_, code_.levels_of(header, kJunk), line::kDataTelegramLevels);
  }
  emit_levels(telegram_bit_, levels, line::kDataTelegramLevels);
  if (faults_.duplicated == index) emit_levels(0, levels, line::kDataTelegramLevels);
  // At its place after any gap, however long the usual ones are: a master need not wait for a later one.
  const bool is_last = checked_ == kCheckOctets + rules_.end_telegrams;
  if (faults_.trailing_telegram && is_last) {
    emit_levels(telegram_bit_ + line::kDataTelegramLevels + faults_.trailing_gap_bits,
                code_.levels_of(line::kDataTelegram | line::kControl, 0), line::kDataTelegramLevels);
  }
}

// ---- the log ----

void RingEmulator::forget_statistics() {
  const kernel::Time first = statistics_.first_telegram;
  statistics_ = {};
  statistics_.first_telegram = first;
  last_data_start_.reset();
}

bool RingEmulator::has_cycle(std::uint64_t number) const {
  return number < cycle_count_ && number + kKept >= cycle_count_;
}

const SeenCycle& RingEmulator::first_cycle() const {
  if (cycle_count_ == 0) iut::refuse_impossible("reports cycles, and the ring has seen none on its line");
  return cycle_count_ > kKept ? first_ : kept_.front();
}

const SeenCycle& RingEmulator::cycle(std::uint64_t number) const {
  // By the master's own count there was one.
  if (number >= cycle_count_) {
    iut::refuse_impossible("reports the end of a cycle that the ring has not seen on its line");
  }
  FIELDPROOF_CHECK(has_cycle(number), "a cycle is asked for that the emulator has not kept");
  return kept_[number % kKept];
}

std::vector<std::string> RingEmulator::describe_last(std::size_t count) const {
  std::vector<std::string> lines;
  const std::uint64_t from = cycle_count_ - std::min<std::uint64_t>({count, kKept, cycle_count_});
  for (std::uint64_t n = from; n < cycle_count_; ++n) lines.push_back(kept_[n % kKept].describe());
  return lines;
}

std::string SeenCycle::describe_word(std::size_t octet) const {
  const auto value = word(octet);
  return value ? fmt::format("{:04X}h", *value)
               : fmt::format("the cycle ends after {} telegrams", octets.size());
}

std::string SeenCycle::describe() const {
  constexpr std::size_t kShown = 24;
  std::string text =
      fmt::format("{} {} cycle {}:", kernel::describe(start), is_id_cycle ? "ID" : "data", number);
  for (std::size_t n = 0; n < std::min(octets.size(), kShown); ++n) {
    text += fmt::format("{}{:02X}", n == transfer_octets && n > 0 ? " | " : " ", octets[n]);
  }
  if (octets.size() > kShown) text += fmt::format(" ... ({} telegrams)", octets.size());
  text += check_good ? ", check good" : ", check bad";
  if (!status_clean) text += ", status marked";
  return text;
}

}  // namespace fieldproof::interbus
