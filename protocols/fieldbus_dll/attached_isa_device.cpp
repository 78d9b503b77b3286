#include "protocols/fieldbus_dll/attached_isa_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr auto kIsaEventKinds = static_cast<std::uint64_t>(IsaEventKind::scheduler_taken) + 1;

}  // namespace

// ---- an implementation outside ----

AttachedIsaDevice::AttachedIsaDevice(iut::Attachment attachment, const IsaConfiguration& configuration,
                                     const std::string& case_id, std::uint64_t seed)
    : rules_(configuration.rules), attached_(std::move(attachment)), link_(attached_, rules_.link) {
  attached_.begin({case_id, seed, isa_settings(configuration)}, *this);
}

void AttachedIsaDevice::wire(segment::Port& line, IsaUser& user) {
  link_.wire(line);
  user_ = &user;
}

bool AttachedIsaDevice::submit(const IsaRequest& wanted, kernel::Time now) {
  Octets octets{static_cast<std::uint8_t>(IsaAsk::submit), static_cast<std::uint8_t>(wanted.service),
                static_cast<std::uint8_t>(wanted.priority), wanted.destination};
  octets.insert(octets.end(), wanted.data.begin(), wanted.data.end());
  return link_.ask(octets, now);
}

bool AttachedIsaDevice::order_transfer(std::uint8_t node, kernel::Time now) {
  return link_.ask({static_cast<std::uint8_t>(IsaAsk::order_transfer), node}, now);
}

void AttachedIsaDevice::send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) {
  if (port != kUserPort) {
    link_.send(port, start, characters);
    return;
  }
  attached_.expect_in_order(start, "reports something to its user");
  const Octets octets = AttachedLink::told_octets(characters);
  const auto dlpdu = octets.empty() ? std::nullopt : isa_dlpdu_of(std::span(octets).subspan(1), rules_);
  if (octets.empty() || octets.front() != kIsaData)
    iut::refuse_impossible("reports to its user what is not 01 and a DU or DT");
  const bool is_data = dlpdu && (dlpdu->type == IsaType::du || dlpdu->type == IsaType::dt);
  if (!is_data) AttachedLink::refuse_delivery("DU or DT", octets, rules_.link);
  user_->on_data(*dlpdu, start);
}

void AttachedIsaDevice::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  attached_.expect_in_order(when, "reports an event to its user");
  if (item == kRefused) {
    link_.refuse();
  } else if (item != kEvent) {
    iut::refuse_impossible(fmt::format("writes item {}, which a station of ISA-D does not have", item));
  } else if ((value & 0xFF) >= kIsaEventKinds || value >> 16 != 0) {
    iut::refuse_impossible(fmt::format(
        "reports {:X}h as an event; there are kinds 0 to {} of nodes up to 255", value, kIsaEventKinds - 1));
  } else {
    user_->on_event({static_cast<IsaEventKind>(value & 0xFF), static_cast<std::uint8_t>(value >> 8)}, when);
  }
}

std::uint64_t AttachedIsaDevice::read(iut::Item item, kernel::Time when) {
  if (item < kReplyComing + 1 || item > kReplyComing + 3) {
    iut::refuse_impossible(fmt::format("reads item {}; a station of ISA-D has {} to {}", item,
                                       kReplyComing + 1, kReplyComing + 3));
  }
  attached_.expect_ahead(when, "asks its user for a reply");
  return user_->is_reply_coming(static_cast<Priority>(item - kReplyComing), when) ? 1 : 0;
}

// ---- a station of ours ----

bool ServedIsaDevice::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  const IsaConfiguration configuration = isa_configuration_of(begin);
  rules_ = configuration.rules;
  play(make_(configuration), bench);
  station().wire(port(kLinePort), *this);
  return true;
}

void ServedIsaDevice::set_power(bool is_on, kernel::Time now) {
  act(now, [&] {
    if (!is_on) {
      station().stop(now);
    } else if (!station().start(now)) {
      refuse(now);
    }
  });
}

bool ServedIsaDevice::asked(const Octets& wanted, kernel::Time now) {
  constexpr std::size_t kHead = 4;
  if (wanted[0] == static_cast<std::uint8_t>(IsaAsk::order_transfer) && wanted.size() == 2)
    return station().order_transfer(wanted[1], now);
  if (wanted[0] != static_cast<std::uint8_t>(IsaAsk::submit) || wanted.size() < kHead)
    return station().ask(wanted, now);
  const auto data = std::span(wanted).subspan(kHead);
  return station().submit({static_cast<IsaService>(wanted[1]), static_cast<Priority>(wanted[2]), wanted[3],
                           Octets(data.begin(), data.end())},
                          now);
}

void ServedIsaDevice::on_data(const IsaDlpdu& dlpdu, kernel::Time when) {
  Octets octets{kIsaData};
  const Octets of_dlpdu = octets_of(dlpdu, rules_);
  octets.insert(octets.end(), of_dlpdu.begin(), of_dlpdu.end());
  report_to_user(octets, when);
}

bool ServedIsaDevice::is_reply_coming(Priority least, kernel::Time when) {
  const auto item = static_cast<iut::Item>(kReplyComing + static_cast<unsigned>(least));
  return bench().read(item, not_past(when)) != 0;
}

}  // namespace fieldproof::fieldbus_dll
