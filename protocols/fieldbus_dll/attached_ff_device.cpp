#include "protocols/fieldbus_dll/attached_ff_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr auto kEventKinds = static_cast<std::uint64_t>(FfEventKind::left) + 1;

Octets request(FfAsk ask) {
  return {static_cast<std::uint8_t>(ask)};
}

}  // namespace

// ---- an implementation outside ----

AttachedFfDevice::AttachedFfDevice(iut::Attachment attachment, const FfConfiguration& configuration,
                                   const std::string& case_id, std::uint64_t seed)
    : rules_(configuration.rules), attached_(std::move(attachment)), link_(attached_, rules_.link) {
  attached_.begin({case_id, seed, ff_settings(configuration)}, *this);
}

void AttachedFfDevice::wire(segment::Port& line, FfUser& user) {
  link_.wire(line);
  user_ = &user;
}

bool AttachedFfDevice::submit(const FfRequest& wanted, kernel::Time now) {
  Octets octets = request(FfAsk::submit);
  octets.push_back(static_cast<std::uint8_t>(wanted.priority));
  put_number(octets, wanted.destination, 4);
  octets.insert(octets.end(), wanted.data.begin(), wanted.data.end());
  return link_.ask(octets, now);
}

bool AttachedFfDevice::write(FfAddress address, const Octets& data, kernel::Time now) {
  Octets octets = request(FfAsk::write);
  put_number(octets, address, 4);
  octets.insert(octets.end(), data.begin(), data.end());
  return link_.ask(octets, now);
}

bool AttachedFfDevice::order_transfer(std::uint8_t node, kernel::Time now) {
  Octets octets = request(FfAsk::order_transfer);
  octets.push_back(node);
  return link_.ask(octets, now);
}

void AttachedFfDevice::send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) {
  if (port != kUserPort) {
    link_.send(port, start, characters);
    return;
  }
  attached_.expect_in_order(start, "reports something to its user");
  const Octets octets = AttachedLink::told_octets(characters);
  const auto what = static_cast<FfIndication>(octets.empty() ? 0 : octets.front());
  if (what != FfIndication::data && what != FfIndication::published)
    iut::refuse_impossible("reports to its user what is neither 01 and a DT1 nor 02 and a DT3");
  const FfType type = what == FfIndication::data ? FfType::dt1 : FfType::dt3;
  const auto dlpdu = ff_dlpdu_of(std::span(octets).subspan(1), rules_);
  if (!dlpdu || dlpdu->type != type) {
    AttachedLink::refuse_delivery(what == FfIndication::data ? "DT1" : "DT3", octets, rules_.link);
  } else if (what == FfIndication::data) {
    user_->on_data(*dlpdu, start);
  } else {
    user_->on_published(*dlpdu, start);
  }
}

void AttachedFfDevice::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  attached_.expect_in_order(when, "reports an event to its user");
  if (item == kRefused) {
    link_.refuse();
  } else if (item != kEvent) {
    iut::refuse_impossible(fmt::format("writes item {}, which a station of FF-P does not have", item));
  } else if ((value & 0xFF) >= kEventKinds || value >> 16 != 0) {
    iut::refuse_impossible(fmt::format(
        "reports {:X}h as an event; there are kinds 0 to {} of nodes up to 255", value, kEventKinds - 1));
  } else {
    user_->on_event({static_cast<FfEventKind>(value & 0xFF), static_cast<std::uint8_t>(value >> 8)}, when);
  }
}

std::uint64_t AttachedFfDevice::read(iut::Item item, kernel::Time) {
  iut::refuse_impossible(fmt::format("reads item {}; a station of FF-P has nothing to read", item));
}

// ---- a station of ours ----

bool ServedFfDevice::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  const FfConfiguration configuration = ff_configuration_of(begin);
  rules_ = configuration.rules;
  play(make_(configuration), bench);
  station().wire(port(kLinePort), *this);
  return true;
}

void ServedFfDevice::set_power(bool is_on, kernel::Time now) {
  act(now, [&] {
    if (!is_on) {
      station().stop(now);
    } else if (!station().start(now)) {
      refuse(now);
    }
  });
}

bool ServedFfDevice::asked(const Octets& wanted, kernel::Time now) {
  constexpr std::size_t kAddress = 4;
  const auto octets = std::span(wanted);
  const auto rest = [&](std::size_t from) {
    const auto behind = octets.subspan(from);
    return Octets(behind.begin(), behind.end());
  };
  switch (static_cast<FfAsk>(octets[0])) {
    case FfAsk::submit: {
      if (octets.size() < 2 + kAddress) break;
      const auto address = static_cast<FfAddress>(number_at(octets, 2, kAddress));
      return station().submit({static_cast<Priority>(octets[1]), address, rest(2 + kAddress)}, now);
    }
    case FfAsk::write:
      if (octets.size() < 1 + kAddress) break;
      return station().write(static_cast<FfAddress>(number_at(octets, 1, kAddress)), rest(1 + kAddress), now);
    case FfAsk::order_transfer:
      if (octets.size() != 2) break;
      return station().order_transfer(octets[1], now);
  }
  return station().ask(wanted, now);
}

void ServedFfDevice::tell(FfIndication what, const FfDlpdu& dlpdu, kernel::Time when) {
  Octets octets{static_cast<std::uint8_t>(what)};
  const Octets of_dlpdu = octets_of(dlpdu, rules_);
  octets.insert(octets.end(), of_dlpdu.begin(), of_dlpdu.end());
  report_to_user(octets, when);
}

}  // namespace fieldproof::fieldbus_dll
