#include "protocols/valve_bus/attached_host.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::valve_bus {
namespace {

constexpr std::size_t kMostOctets = 4096;  // of the PC at once
constexpr std::uint64_t kErrorKinds = static_cast<std::uint64_t>(HostErrorKind::part_of_command) + 1;
// Of counters, in the order in which HostCounters has them.
constexpr std::array kCounterItems{kTimeouts, kRejected, kLate, kRetries};
constexpr unsigned kIds = 256;

std::array<std::uint64_t, 4> listed(const HostCounters& counters) {
  return {counters.timeouts, counters.rejected, counters.late, counters.retries};
}

std::uint8_t octet_of(std::uint64_t value, unsigned place) {
  return static_cast<std::uint8_t>(value >> 8 * place);
}

}  // namespace

AttachedHost::AttachedHost(iut::Attachment attachment, const HostConfiguration& configuration,
                           const std::string& case_id, std::uint64_t seed)
    : rules_(configuration.rules),
      dip_(configuration.dip),
      attached_(std::move(attachment)),
      line_(attached_, uart(rules_)) {
  attached_.begin({case_id, seed, host_settings(configuration)}, *this);
}

void AttachedHost::wire(segment::Port& line, HostApplication& application) {
  line_.wire(line);
  application_ = &application;
}

void AttachedHost::set_power(bool is_on, kernel::Time now) {
  const auto rates = dip_bit_rates();
  rules_.bit_rate = rates[dip_ % rates.size()];
  line_.begin(uart(rules_), now);
  attached_.set_power(is_on, now);
  line_.after_call(now);
}

void AttachedHost::write(std::span<const std::uint8_t> octets, kernel::Time now) {
  std::vector<iut::Character> characters;
  for (; !octets.empty(); octets = octets.subspan(characters.size())) {
    characters.clear();
    for (const std::uint8_t octet : octets.first(std::min(octets.size(), kMostOctets))) {
      characters.push_back({now, now, octet});
    }
    attached_.call(now, [&](iut::Device& device) { device.receive(kPcPort, characters, now); });
  }
  line_.after_call(now);
}

HostCounters AttachedHost::counters(std::uint8_t id) const {
  return {counters_[0].at(id), counters_[1].at(id), counters_[2].at(id), counters_[3].at(id)};
}

void AttachedHost::tell_response(std::uint64_t value, kernel::Time when) {
  if (value > 0x01FF'FFFF)
    iut::refuse_impossible(fmt::format("reports {:X}h to the PC as a response", value));
  application_->on_response(
      {octet_of(value, 0), octet_of(value, 1), octet_of(value, 2), octet_of(value, 3) != 0}, when);
}

void AttachedHost::tell_error(std::uint64_t value, kernel::Time when) {
  if (value >> 8 >= kErrorKinds) {
    iut::refuse_impossible(
        fmt::format("reports to the PC an error of kind {}; there are 0 to {}", value >> 8, kErrorKinds - 1));
  }
  application_->on_error({octet_of(value, 0), static_cast<HostErrorKind>(value >> 8)}, when);
}

void AttachedHost::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  attached_.expect_in_order(when, "reports something to its PC");
  const unsigned kind = item / kIds - 1U;
  if (item == kResponse) {
    tell_response(value, when);
  } else if (item == kError) {
    tell_error(value, when);
  } else if (item == kFifoRoom) {
    fifo_room_ = value;
  } else if (item == kOverflow) {
    if (value > 1)
      iut::refuse_impossible(fmt::format("writes {} to item {}, which is 1 after an overflow", value, item));
    has_overflowed_ = value == 1;
  } else if (item >= kIds && kind < kCounterItems.size()) {
    counters_.at(kind).at(item % kIds) = value;
  } else {
    iut::refuse_impossible(fmt::format("writes item {}, which a host does not have", item));
  }
}

std::uint64_t AttachedHost::read(iut::Item item, kernel::Time when) {
  if (item != kDip) {
    iut::refuse_impossible(fmt::format("reads item {}; a host has its switches, item {}", item, kDip));
  }
  attached_.expect_ahead(when, "reads its switches");
  return dip_;
}

// ---- a host of ours ----

bool ServedHost::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  is_on_ = false;
  fifo_room_ = has_overflowed_ = 0;
  counters_ = {};
  const HostConfiguration configuration = host_configuration_of(begin);
  dip_ = configuration.dip;
  play(make_(configuration), bench);
  station().wire(port(0), *this);
  return true;
}

void ServedHost::set_power(bool is_on, kernel::Time now) {
  is_on_ = is_on;
  act(now, [&] { station().set_power(is_on, now); });
}

void ServedHost::receive(unsigned, std::span<const iut::Character> characters, kernel::Time now) {
  std::vector<std::uint8_t> octets;
  for (const iut::Character& one : characters) octets.push_back(static_cast<std::uint8_t>(one.data));
  act(now, [&] { station().write(octets, now); });
}

void ServedHost::keep(iut::Item item, std::uint64_t value, std::uint64_t& told) {
  if (value == told) return;
  bench().write(item, value, now());
  told = value;
}

void ServedHost::before_call() {
  if (!is_on_) return;
  const std::uint64_t dip = bench().read(kDip, now());
  if (dip == dip_) return;
  dip_ = dip;
  station().set_dip(static_cast<unsigned>(dip));
}

// What the PC may look at is kept up to date after each call.
void ServedHost::after_call() {
  if (!is_on_) return;
  keep(kFifoRoom, station().fifo_room(), fifo_room_);
  keep(kOverflow, station().has_overflowed() ? 1 : 0, has_overflowed_);
  for (unsigned id = 0; id < kIds; ++id) {
    const auto counters = listed(station().counters(static_cast<std::uint8_t>(id)));
    for (std::size_t kind = 0; kind < counters.size(); ++kind) {
      keep(static_cast<iut::Item>(kCounterItems[kind] + id), counters[kind], counters_[kind][id]);
    }
  }
}

void ServedHost::on_response(const HostResponse& response, kernel::Time when) {
  const std::uint64_t value = response.id | std::uint64_t{response.data0} << 8 |
                              std::uint64_t{response.data1} << 16 |
                              (response.is_old ? std::uint64_t{1} << 24 : 0);
  bench().write(kResponse, value, not_past(when));
}

void ServedHost::on_error(const HostError& error, kernel::Time when) {
  bench().write(kError, error.id | static_cast<std::uint64_t>(error.kind) << 8, not_past(when));
}

}  // namespace fieldproof::valve_bus
