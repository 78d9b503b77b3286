#include "fuzz/ff_device_model.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::fuzz {
namespace {

using kernel::Time;

constexpr unsigned kPriority = 0x03;
constexpr unsigned kFinal = 0x04;
constexpr unsigned kLong = 0x08;
constexpr unsigned kMostUrgent = 3;
constexpr std::uint32_t kToAll = 0xFFFF;

std::uint64_t number_at(std::span<const std::uint8_t> octets, std::size_t at, std::size_t count) {
  std::uint64_t number = 0;
  for (std::size_t n = at; n < at + count; ++n) number = number << 8 | octets[n];
  return number;
}

void append_number(LinkOctets& octets, std::uint32_t number, std::size_t count) {
  for (std::size_t n = count; n > 0; --n)
    octets.push_back(static_cast<std::uint8_t>(number >> (8 * (n - 1))));
}

std::size_t address_size(unsigned control) {
  return (control & kLong) != 0 ? 4 : 2;
}

std::uint32_t address_at(std::span<const std::uint8_t> octets, std::size_t at) {
  return static_cast<std::uint32_t>(number_at(octets, at, address_size(octets[0])));
}

// An address has the long form if and only if it is on a link with a number.
bool is_address_at(std::span<const std::uint8_t> octets, std::size_t at) {
  const std::size_t size = address_size(octets[0]);
  return octets.size() >= at + size && (size == 2 || number_at(octets, at, 2) != 0);
}

bool is_kind(unsigned control, unsigned kind) {
  return (control & 0xF0U) == kind && (control & kPriority) != 0;
}

bool is_pass_token(unsigned control) {
  return (control & 0xF8U) == 0x30 && (control & kPriority) != 0;
}

bool is_from_scheduler(unsigned control) {
  return is_kind(control, 0xA0) || is_pass_token(control) || control == 0x26 || control == 0x11 ||
         control == 0x01 || control == 0x06;
}

}  // namespace

FfDeviceModel::FfDeviceModel(const fieldbus_dll::FfConfiguration& configuration)
    : configuration_(configuration) {
  for (const std::uint32_t address : configuration.published) buffers_[address] = {};
}

std::size_t FfDeviceModel::most_data(unsigned priority) const {
  return configuration_.rules.link.most_data[priority - 1];
}

bool FfDeviceModel::submit(unsigned priority, std::uint32_t destination, const LinkOctets& data) {
  if (data.size() > most_data(priority)) return false;
  queues_.at(priority).push_back({priority, destination, data});
  return true;
}

bool FfDeviceModel::write(std::uint32_t address, const LinkOctets& data) {
  const auto found = buffers_.find(address);
  if (found == buffers_.end() || data.size() > most_data(kMostUrgent)) return false;
  found->second = {data, found->second.writes + 1, true};
  return true;
}

// ---- when ----

Time FfDeviceModel::may_begin() const {
  if (is_line_busy_) return kernel::kNever;
  return std::max(heard_until_, driven_until_) +
         octets(configuration_.rules.link, configuration_.rules.link.inter_pdu_delay_octets);
}

Time FfDeviceModel::next_action() const {
  if (answer_) return std::min(may_begin(), answer_->until);
  if (token_) return std::min(may_begin(), token_->ends);
  return kernel::kNever;
}

void FfDeviceModel::run_until(Time now) {
  for (Time at = next_action(); at <= now; at = next_action()) act(at);
}

void FfDeviceModel::act(Time now) {
  if (!answer_) return use_token(now);
  const Answer answer = *std::exchange(answer_, std::nullopt);
  if (may_begin() <= now) say(answer.octets, now);
}

std::uint64_t FfDeviceModel::link_time(Time now) const {
  return told_time_ + static_cast<std::uint64_t>((now - told_at_) / fieldbus_dll::kTick);
}

// ---- the token ----

Time FfDeviceModel::end_of(const LinkOctets& said, Time begin) const {
  constexpr std::size_t kCheckAndDelimiters = 4;
  const auto& link = configuration_.rules.link;
  return begin +
         octets(link, static_cast<std::int64_t>(said.size() + kCheckAndDelimiters + link.preamble_octets));
}

std::deque<FfDeviceModel::Request>* FfDeviceModel::next_queue() {
  for (unsigned priority = kMostUrgent; priority >= token_->least; --priority) {
    if (!queues_.at(priority).empty()) return &queues_.at(priority);
  }
  return nullptr;
}

LinkOctets FfDeviceModel::dt1_of(const Request& request, bool is_last) const {
  const bool is_long = request.destination > 0xFFFF;
  const std::size_t size = is_long ? 4 : 2;
  LinkOctets said{
      static_cast<std::uint8_t>(0xD0U | request.priority | (is_long ? kLong : 0U) | (is_last ? kFinal : 0U))};
  append_number(said, request.destination, size);
  // Selector 1 of its own node, on the link of the destination.
  append_number(said, (request.destination >> 16) << 16 | configuration_.node * 0x100U | 1U, size);
  said.insert(said.end(), request.data.begin(), request.data.end());
  return said;
}

void FfDeviceModel::use_token(Time now) {
  const Time ends = token_->ends;
  if (ends <= now) return token_.reset();
  std::deque<Request>* const queue = next_queue();
  const LinkOctets first = queue == nullptr ? LinkOctets{} : dt1_of(queue->front(), false);
  if (queue == nullptr || end_of(first, now) > ends) {
    token_.reset();
    const LinkOctets rt{0x34};
    if (end_of(rt, now) <= ends) say(rt, now);
    return;
  }
  const Request request = queue->front();
  queue->pop_front();
  const std::deque<Request>* const behind = next_queue();
  const Time again = end_of(first, now) +
                     octets(configuration_.rules.link, configuration_.rules.link.inter_pdu_delay_octets);
  const bool is_last = behind == nullptr || end_of(dt1_of(behind->front(), false), again) > ends;
  if (is_last) token_.reset();
  say(dt1_of(request, is_last), now);
}

void FfDeviceModel::say(const LinkOctets& octets, Time now) {
  said_.push_back({now, octets});
  driven_until_ = end_of(octets, now);
}

// ---- what is heard ----

void FfDeviceModel::on_begin(Time now) {
  run_until(now);
  is_line_busy_ = true;
}

void FfDeviceModel::on_wave(const line::Waveform& wave) {
  run_until(wave.end());
  if (wave.start >= driven_until_) {
    for (const LinkOctets& octets : link_frames_in(wave, configuration_.rules.link)) {
      if (is_dlpdu(octets)) hear(octets, wave.end());
    }
  }
  is_line_busy_ = false;
  heard_until_ = wave.end();
}

bool FfDeviceModel::is_dlpdu(std::span<const std::uint8_t> octets) const {
  const unsigned control = octets[0];
  const std::size_t size = octets.size();
  const std::size_t address = address_size(control);
  if (is_kind(control, 0xA0)) return is_address_at(octets, 1) && size == 1 + address;
  if (is_kind(control, 0xD0)) {
    return is_address_at(octets, 1) && is_address_at(octets, 1 + address) &&
           size - 1 - 2 * address <= most_data(control & kPriority);
  }
  if (is_kind(control, 0x50)) {
    return is_address_at(octets, 1) && size >= 2 + address &&
           size - 2 - address <= most_data(control & kPriority);
  }
  if (is_pass_token(control)) return size == 4 && number_at(octets, 2, 2) != 0;
  switch (control) {
    case 0x13:
    case 0x17:  // SR
      return size == 2 && octets[1] <= 1;
    case 0x20:  // RI
      return size == 3 && number_at(octets, 1, 2) != 0;
    case 0x11:  // TD
      return size == 7;
    case 0x06:  // TL
      return size == 4;
    case 0x01:  // CL
    case 0x14:  // CT
    case 0x26:  // PN
    case 0x27:  // PR
      return size == 2;
    case 0x10:  // IDLE
    case 0x34:  // RT
      return size == 1;
    default:
      return false;
  }
}

void FfDeviceModel::hear(const LinkOctets& octets, Time end) {
  const unsigned control = octets[0];
  answer_.reset();
  if (is_from_scheduler(control)) token_.reset();
  const Time until = end + response_delay(configuration_.rules.link);
  if (control == 0x26 && octets[1] == configuration_.node) {
    answer_ = Answer{{0x27, configuration_.node}, until};
  } else if (is_pass_token(control) && is_live_ && octets[1] == configuration_.node) {
    const auto duration = static_cast<std::int64_t>(number_at(octets, 2, 2));
    token_ = Token{control & kPriority, end + fieldbus_dll::octets(configuration_.rules.link, duration)};
  } else if (is_kind(control, 0xA0) && is_live_) {
    hear_cd(octets, until);
  } else if (control == 0x11) {
    told_time_ = number_at(octets, 1, 6);
    told_at_ = end;
  } else if (is_kind(control, 0xD0)) {
    hear_dt1(octets, end);
  } else if (is_kind(control, 0x50)) {
    const auto& wanted = configuration_.subscribed;
    if (std::ranges::count(wanted, address_at(octets, 1)) != 0)
      told_.push_back({FfIndication::Kind::published, end, octets});
  }
}

void FfDeviceModel::hear_cd(const LinkOctets& octets, Time until) {
  const std::uint32_t address = address_at(octets, 1);
  if ((address >> 8 & 0xFFU) != configuration_.node) return;
  const auto found = buffers_.find(address);
  if (found == buffers_.end() || !found->second.is_written) {
    answer_ = Answer{{0x17, static_cast<std::uint8_t>(found == buffers_.end() ? 0 : 1)}, until};
    return;
  }
  LinkOctets dt3{
      static_cast<std::uint8_t>(0x50U | kFinal | (octets[0] & kPriority) | (address > 0xFFFF ? kLong : 0U))};
  append_number(dt3, address, address > 0xFFFF ? 4 : 2);
  dt3.push_back(static_cast<std::uint8_t>(found->second.writes & 0xFFU));
  dt3.insert(dt3.end(), found->second.data.begin(), found->second.data.end());
  answer_ = Answer{dt3, until};
}

void FfDeviceModel::hear_dt1(const LinkOctets& octets, Time end) {
  const std::size_t address = address_size(octets[0]);
  const std::uint32_t to = address_at(octets, 1);
  const std::uint32_t from = address_at(octets, 1 + address);
  if (to != kToAll && (to >> 8 & 0xFFU) != configuration_.node) return;
  if (address == 4 && !configuration_.supports_long_addresses) return;
  const std::size_t header = 1 + 2 * address;
  const bool is_among_entities = (to == kToAll || (to & 0xFFU) == 0) && (from & 0xFFU) == 0;
  if (!is_among_entities || octets.size() == header) {
    told_.push_back({FfIndication::Kind::data, end, octets});
  } else if (octets[header] == 1 && to != kToAll && !is_live_) {
    is_live_ = true;
    told_.push_back({FfIndication::Kind::activated, end, {}});
  }
}

}  // namespace fieldproof::fuzz
