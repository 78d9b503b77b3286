#include "protocols/interbus/attached_master.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::interbus {
namespace {

constexpr std::size_t kTextOctets = 8;  // of an item

constexpr std::uint64_t kMostPackedStation = (std::uint64_t{1} << 49) - 1;

unsigned words_of_packed(std::uint64_t value) {
  return value >> 16 & 0xFFFF;
}

std::uint64_t packed(const FaultLocation& location) {
  const auto place = [](int station) { return static_cast<std::uint64_t>(station + 1) & 0xFFFF; };
  return std::uint64_t{1} << 32 | place(location.from) | place(location.to) << 16;
}

std::uint64_t packed(MasterOrder order, std::span<const std::uint16_t> operands) {
  std::uint64_t value = static_cast<std::uint64_t>(order);
  for (std::size_t n = 0; n < operands.size(); ++n) value |= std::uint64_t{operands[n]} << 16 * (n + 1);
  return value;
}

bool is_within(iut::Item item, iut::Item first, unsigned count = kMostMasterWords) {
  return item >= first && item < first + count;
}

// The greatest value that an item can have; nothing for an item that there is not.
std::optional<std::uint64_t> most_of(iut::Item item) {
  constexpr std::uint64_t kAny = std::numeric_limits<std::uint64_t>::max();
  if (item == kMasterState) return static_cast<std::uint64_t>(MasterState::bus_stop);
  if (item >= kDataCycles && item <= kRejectedDataCycles) return kAny;
  if (item == kConsecutiveBad) return std::numeric_limits<std::uint32_t>::max();
  if (item == kQualityBit) return 1;
  if (item == kCycleTime) return static_cast<std::uint64_t>(kLongestCycle.count());
  if (item == kFaultPlace) return 0x1'FFFF'FFFF;
  if (item == kStationCount) return kMostMasterWords;
  if (item == kCycleEnd) return 3;
  if (is_within(item, kErrorText, kMostErrorTexts)) return kAny;
  if (is_within(item, kFoundStation)) return kMostPackedStation;
  if (is_within(item, kStationMessages)) return 3;
  if (is_within(item, kInputImage) || is_within(item, kOutputImage)) return 0xFFFF;
  return std::nullopt;
}

}  // namespace

AttachedMaster::AttachedMaster(iut::Attachment attachment, const MasterConfiguration& configuration,
                               const std::string& case_id, std::uint64_t seed)
    : kept_(kMasterItems) {
  attached_.emplace(std::move(attachment));
  front_ = front_of(*attached_, configuration.rules, "master");
  attached_->begin({case_id, seed, master_settings(configuration)}, *this);
}

// ---- what the bench does ----

template <typename Call>
void AttachedMaster::call(kernel::Time now, Call&& call) {
  if (!attached_ || !is_supplied_) return;
  is_called_ = true;
  attached_->call(now, call);
  is_called_ = false;
}

template <typename Call>
void AttachedMaster::call_and_order(kernel::Time now, Call&& call) {
  this->call(now, call);
  // An order ends no cycle, so nothing new is ordered meanwhile.
  while (!orders_.empty()) {
    const Order order = std::move(orders_.front());
    orders_.pop_front();
    tell(order);
  }
}

void AttachedMaster::start(kernel::Time now) {
  if (attached_ && !is_supplied_) {
    is_supplied_ = is_ordered_ = true;  // nor does a cycle end before the first order
    attached_->set_power(true, now);
  }
  order({MasterOrder::start, {}, now});
}

void AttachedMaster::write_output(unsigned word, std::uint16_t value, kernel::Time now) {
  if (word >= kMostMasterWords) return;
  order({MasterOrder::output, {static_cast<std::uint16_t>(word), value}, now});
}

void AttachedMaster::order(Order order) {
  if (is_called_) {
    orders_.push_back(std::move(order));
  } else {
    tell(order);
  }
}

void AttachedMaster::tell(const Order& order) {
  std::vector<iut::Character> characters{{order.now, order.now, static_cast<std::uint16_t>(order.order)}};
  for (const std::uint16_t operand : order.operands) characters.push_back({order.now, order.now, operand});
  is_ordered_ = true;
  call(order.now, [&](iut::Device& device) { device.receive(kApplicationPort, characters, order.now); });
  is_ordered_ = false;
}

void AttachedMaster::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (!front_) {
    return call_and_order(reception.start, [&](iut::Device& device) { device.receive(port, reception); });
  }
  front_->hear(port, reception, [&](auto telegrams) { tell(telegrams, reception.start); });
}

void AttachedMaster::tell(std::span<const iut::Character> telegrams, kernel::Time now) {
  call_and_order(now, [&](iut::Device& device) { device.receive(0, telegrams, now); });
}

void AttachedMaster::on_time(kernel::Time now) {
  if (front_) front_->complete(now, [&](unsigned, auto telegrams) { tell(telegrams, now); });
  if (front_ && attached_ && attached_->next_time() > now) return;
  call_and_order(now, [&](iut::Device& device) { attached_->tell_time(device, now); });
}

kernel::Time AttachedMaster::next_time() const {
  if (!attached_) return kernel::kNever;
  return std::min(attached_->next_time(), front_ ? front_->next_time() : kernel::kNever);
}

void AttachedMaster::end() {
  if (attached_) attached_->end();
  attached_.reset();
}

std::uint16_t AttachedMaster::image(iut::Item first, unsigned word) const {
  return word < kMostMasterWords ? static_cast<std::uint16_t>(kept_[first + word]) : std::uint16_t{0};
}

std::string AttachedMaster::error_text() const {
  std::string text;
  for (unsigned n = 0; n < kMostErrorTexts * kTextOctets; ++n) {
    const auto octet = static_cast<char>(kept_[kErrorText + n / kTextOctets] >> 8 * (n % kTextOctets));
    if (octet == '\0') break;
    text += octet;
  }
  return kernel::escaped_line(text);
}

MasterStatus AttachedMaster::status() const {
  MasterStatus status;
  status.state = static_cast<MasterState>(kept_[kMasterState]);
  status.configuration_error = error_text();
  status.data_cycles = kept_[kDataCycles];
  status.id_cycles = kept_[kIdCycles];
  status.rejected_cycles = kept_[kRejectedCycles];
  status.rejected_data_cycles = kept_[kRejectedDataCycles];
  status.consecutive_bad = static_cast<unsigned>(kept_[kConsecutiveBad]);
  status.quality_bit = kept_[kQualityBit] != 0;
  status.cycle_time = kernel::Duration{static_cast<std::int64_t>(kept_[kCycleTime])};
  const std::uint64_t fault = kept_[kFaultPlace];
  status.has_fault_location = fault >> 32 != 0;
  if (status.has_fault_location) {
    status.fault_location = {static_cast<int>(fault & 0xFFFF) - 1,
                             static_cast<int>(fault >> 16 & 0xFFFF) - 1};
  }
  for (unsigned n = 0; n < kept_[kStationCount]; ++n) {
    status.stations.push_back(found_station_of(kept_[kFoundStation + n]));
    const std::uint64_t messages = kept_[kStationMessages + n];
    if ((messages & 1) != 0) status.peripheral_faults.push_back(static_cast<int>(n));
    if ((messages & 2) != 0) status.reconfigurations.push_back(static_cast<int>(n));
  }
  return status;
}

// ---- what the implementation does ----

void AttachedMaster::send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) {
  if (!front_) iut::refuse_impossible("sends characters; this master has announced levels");
  drive(port, front_->levels_of(start, characters));
}

void AttachedMaster::transmit(unsigned port, line::Waveform& wave) {
  if (front_) iut::refuse_impossible("drives levels; this master has announced telegrams");
  drive(port, wave);
}

void AttachedMaster::drive(unsigned port, line::Waveform& wave) {
  attached_->expect_drive(wave);
  if (port != 0) iut::refuse_impossible(fmt::format("drives port {}; a master has its line, port 0", port));
  has_driven_ = true;
  out_->drive(wave);
}

// The application sees each word at once, so none can be told ahead.
void AttachedMaster::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  attached_->expect_ahead(when, "reports something to its application");
  if (when > attached_->now()) {
    iut::refuse_impossible(
        fmt::format("reports to its application at {} what is so at {}; ask for a call then",
                    kernel::describe(attached_->now()), kernel::describe(when)));
  }
  const auto most = most_of(item);
  if (!most) iut::refuse_impossible(fmt::format("writes item {}, which a master does not have", item));
  if (value > *most) {
    iut::refuse_impossible(fmt::format("writes {} to item {}, which goes up to {}", value, item, *most));
  }
  if (item == kCycleEnd) return end_cycle(value, when);
  keep(item, value);
}

void AttachedMaster::keep(iut::Item item, std::uint64_t value) {
  kept_[item] = value;
  if (item != kStationCount && !is_within(item, kFoundStation)) return;
  std::uint64_t words = 0;
  for (unsigned n = 0; n < kept_[kStationCount]; ++n) words += words_of_packed(kept_[kFoundStation + n]);
  if (words > kMostMasterWords) {
    iut::refuse_impossible(
        fmt::format("finds stations with {} words; a ring has at most {}", words, kMostMasterWords));
  }
}

void AttachedMaster::end_cycle(std::uint64_t value, kernel::Time when) {
  if (is_ordered_) iut::refuse_impossible("ends a cycle while its application orders something");
  if (!std::exchange(has_driven_, false)) {
    iut::refuse_impossible("ends a cycle, and has driven nothing since the one before");
  }
  if (hook_) hook_(when, (value & 1) != 0, (value & 2) != 0);
}

std::uint64_t AttachedMaster::read(iut::Item item, kernel::Time) {
  if (item != kNextOrder) {
    iut::refuse_impossible(fmt::format("reads item {}; a master has {} to read", item, kNextOrder));
  }
  if (orders_.empty()) return 0;
  const Order order = std::move(orders_.front());
  orders_.pop_front();
  return packed(order.order, order.operands);
}

// ---- a master of ours ----

bool ServedMaster::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  told_.assign(kMasterItems, 0);
  play(make_(master_configuration_of(begin)), bench);
  station().wire(port(0));
  station().on_cycle_end([this](kernel::Time, bool is_data, bool is_accepted) {
    tell();
    this->bench().write(kCycleEnd, (is_data ? 1U : 0U) | (is_accepted ? 2U : 0U), now());
    while (const std::uint64_t order = this->bench().read(kNextOrder, now())) {
      obey(static_cast<MasterOrder>(order & 0xFFFF), static_cast<unsigned>(order >> 16 & 0xFFFF),
           static_cast<std::uint16_t>(order >> 32), now());
    }
  });
  return true;
}

void ServedMaster::receive(unsigned, std::span<const iut::Character> characters, kernel::Time now) {
  const auto order = static_cast<MasterOrder>(characters.empty() ? 0 : characters.front().data);
  const std::size_t operands = order == MasterOrder::output ? 2 : 0;
  const bool is_known = order >= MasterOrder::start && order <= MasterOrder::output;
  if (!is_known || characters.size() != 1 + operands) {
    throw kernel::Error(kernel::ErrorKind::implementation, "the bench orders what no master can do");
  }
  const unsigned word = operands > 0 ? characters[1].data : 0U;
  const std::uint16_t value = operands > 0 ? characters[2].data : std::uint16_t{0};
  act(now, [&] { obey(order, word, value, now); });
}

void ServedMaster::obey(MasterOrder order, unsigned word, std::uint16_t value, kernel::Time now) {
  if (order == MasterOrder::start) station().start(now);
  if (order == MasterOrder::stop) station().stop(now);
  if (order == MasterOrder::id_cycle) station().request_id_cycle(now);
  if (order == MasterOrder::output) station().write_output(word, value, now);
}

void ServedMaster::keep(unsigned item, std::uint64_t value) {
  std::uint64_t& told = told_.at(item);
  if (value == told) return;
  told = value;
  bench().write(static_cast<iut::Item>(item), value, now());
}

void ServedMaster::tell() {
  const MasterStatus status = station().status();
  keep(kMasterState, static_cast<std::uint64_t>(status.state));
  keep(kDataCycles, status.data_cycles);
  keep(kIdCycles, status.id_cycles);
  keep(kRejectedCycles, status.rejected_cycles);
  keep(kRejectedDataCycles, status.rejected_data_cycles);
  keep(kConsecutiveBad, status.consecutive_bad);
  keep(kQualityBit, status.quality_bit ? 1 : 0);
  keep(kCycleTime, static_cast<std::uint64_t>(status.cycle_time.count()));
  keep(kFaultPlace, status.has_fault_location ? packed(status.fault_location) : 0);
  tell_error(status.configuration_error);
  tell_stations(status);
  tell_images(status);
}

void ServedMaster::tell_error(const std::string& sentence) {
  for (unsigned n = 0; n < kMostErrorTexts; ++n) {
    std::uint64_t octets = 0;
    for (std::size_t at = 0; at < kTextOctets && n * kTextOctets + at < sentence.size(); ++at) {
      octets |= std::uint64_t{static_cast<std::uint8_t>(sentence[n * kTextOctets + at])} << 8 * at;
    }
    keep(kErrorText + n, octets);
  }
}

// The number of them when all are known, so that what the bench has is a ring at any time.
void ServedMaster::tell_stations(const MasterStatus& status) {
  const auto count = static_cast<unsigned>(status.stations.size());
  if (count < told_[kStationCount]) keep(kStationCount, count);
  for (unsigned n = 0; n < count; ++n) {
    const auto is_among = [n](const std::vector<int>& places) {
      return std::ranges::find(places, static_cast<int>(n)) != places.end();
    };
    keep(kFoundStation + n, packed_station(status.stations[n]));
    keep(kStationMessages + n,
         (is_among(status.peripheral_faults) ? 1U : 0U) | (is_among(status.reconfigurations) ? 2U : 0U));
  }
  keep(kStationCount, count);
}

void ServedMaster::tell_images(const MasterStatus& status) {
  unsigned words = 0;
  for (const FoundStation& station : status.stations) words += station.words;
  // Those that are there no more are 0.
  told_words_ = std::max(told_words_, words);
  for (unsigned word = 0; word < told_words_; ++word) {
    keep(kInputImage + word, station().input(word));
    keep(kOutputImage + word, station().output(word));
  }
}

}  // namespace fieldproof::interbus
