#include "fuzz/valve_node_model.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::fuzz {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr std::size_t kCommand = 5;
// Positions on the line are rounded to picoseconds, each for itself.
constexpr Duration kRounded = kernel::kNanosecond;

}  // namespace

ValveNodeModel::ValveNodeModel(const valve_bus::NodeConfiguration& configuration)
    : configuration_(configuration),
      receiver_(character_format(configuration.rules), configuration.rules.bit_rate),
      answer_receiver_(receiver_) {}

void ValveNodeModel::set_power(bool is_on, Time now) {
  is_on_ = is_on;
  frame_.clear();
  has_gap_ = false;
  due_.reset();
  valves_ = 0;
  last_command_ = now;
}

Time ValveNodeModel::known_at() const {
  if (frame_.empty()) return kernel::kNever;
  return busy_until_ + delimiter(configuration_.rules) + character_notice(configuration_.rules);
}

Time ValveNodeModel::loss_at() const {
  const Duration limit = configuration_.rules.loss_limit;
  return limit > Duration{} ? last_command_ + limit : kernel::kNever;
}

void ValveNodeModel::run_until(Time now) {
  while (is_on_ && std::min(known_at(), loss_at()) <= now) {
    if (known_at() <= loss_at()) {
      end_frame(known_at());
    } else {
      let_go(loss_at());
    }
  }
}

void ValveNodeModel::let_go(Time when) {
  last_command_ = when;
  if (valves_ == 0) return;
  valves_ = 0;
  writes_.push_back({when, 0});
}

void ValveNodeModel::on_wave(const line::Waveform& wave) {
  // What is due at the very end of it comes behind it.
  run_until(wave.end() - Duration{1});
  if (!is_on_) return;
  std::vector<line::CharacterReceiver::Received> received;
  receiver_.receive(wave, received);
  for (const auto& one : received) on_character(one, wave.end());
}

void ValveNodeModel::on_character(const line::CharacterReceiver::Received& one, Time now) {
  if (!frame_.empty()) {
    const Duration silence = one.start - busy_until_;
    if (silence >= delimiter(configuration_.rules)) {
      end_frame(now);
    } else if (silence > longest_gap(configuration_.rules)) {
      has_gap_ = true;
    }
  }
  due_.reset();
  const bool is_deaf = one.start < driving_until_;
  frame_.push_back({static_cast<std::uint8_t>(one.character.data), one.character.is_good() && !is_deaf});
  busy_until_ = one.busy_until;
}

void ValveNodeModel::end_frame(Time now) {
  unsigned sum = 0;
  for (const Heard& one : frame_) sum ^= one.octet;
  const bool is_command = frame_.size() == kCommand && !has_gap_ && sum == 0 &&
                          std::ranges::all_of(frame_, [](const Heard& one) { return one.is_good; });
  if (is_command) on_command(now);
  frame_.clear();
  has_gap_ = false;
}

void ValveNodeModel::on_command(Time now) {
  const unsigned address = 10 * configuration_.tens + configuration_.units;
  const bool is_address = configuration_.tens < 10 && configuration_.units < 10 && address != 0;
  if (!is_address || frame_[0].octet != address) return;
  last_command_ = now;
  const unsigned second = configuration_.boards == 1 ? 0U : 0xFFU;
  std::array<std::uint8_t, 3> octets{};
  if (frame_[1].octet == 0) {
    valves_ = static_cast<std::uint16_t>(frame_[2].octet | (frame_[3].octet & second) << 8);
    writes_.push_back({now, valves_});
    if (!configuration_.rules.answers_writes) return;
    octets = {frame_[2].octet, frame_[3].octet, 0};
  } else if (frame_[1].octet == 1) {
    octets = {static_cast<std::uint8_t>(switches_), static_cast<std::uint8_t>(switches_ >> 8 & second), 0};
  } else {
    return;
  }
  octets[2] = octets[0] ^ octets[1];
  const Time least = busy_until_ + delimiter(configuration_.rules);
  // One that was told late, in one piece with what followed, may be answered as late.
  const Time most =
      std::max(least + turnaround_time_span(configuration_.rules), now + bits(configuration_.rules, 2));
  due_ = Due{octets, least - kRounded, most + kRounded};
}

void ValveNodeModel::on_driven(const line::Waveform& wave, Time now) {
  run_until(now);
  FIELDPROOF_CHECK(is_on_, "a node without supply does not drive");
  std::vector<line::CharacterReceiver::Received> received;
  answer_receiver_.receive(wave, received);
  FIELDPROOF_CHECK(received.size() == 1, "a node drives a character at a time");
  const auto& one = received.front();
  if (saying_.empty()) {
    FIELDPROOF_CHECK(due_.has_value(), "a node drives only when it has been asked");
    FIELDPROOF_CHECK(one.start >= due_->earliest, "a node leaves the line silent for a delimiter");
    FIELDPROOF_CHECK(one.start <= due_->latest, "a node answers within its turn-round");
    saying_.assign(due_->octets.begin(), due_->octets.end());
    due_.reset();
  }
  FIELDPROOF_CHECK(one.character.is_good(), "a node sends good characters");
  FIELDPROOF_CHECK(static_cast<std::uint8_t>(one.character.data) == saying_.front(),
                   "an answer says what it must");
  saying_.pop_front();
  driving_until_ = wave.end();
}

}  // namespace fieldproof::fuzz
