#include "protocols/fieldbus_dll/attached_isa_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr auto kIsaEventKinds = static_cast<std::uint64_t>(IsaEventKind::scheduler_taken) + 1;

struct NamedIsaCode {
  const char* name;
  std::uint8_t IsaCodes::* code;
};
constexpr std::array kIsaCodes{NamedIsaCode{"code_cd", &IsaCodes::cd}, NamedIsaCode{"code_dt", &IsaCodes::dt},
                               NamedIsaCode{"code_du", &IsaCodes::du}, NamedIsaCode{"code_et", &IsaCodes::et},
                               NamedIsaCode{"code_es", &IsaCodes::es}, NamedIsaCode{"code_ee", &IsaCodes::ee},
                               NamedIsaCode{"code_tl", &IsaCodes::tl}};

struct NamedTimer {
  const char* name;
  unsigned IsaRules::* octets;
};
constexpr std::array kTimers{NamedTimer{"reply_wait_octets", &IsaRules::reply_wait_octets},
                             NamedTimer{"reply_forming_octets", &IsaRules::reply_forming_octets},
                             NamedTimer{"supervision_margin_octets", &IsaRules::supervision_margin_octets}};

struct NamedAddress {
  const char* name;
  std::uint8_t IsaRules::* address;
};
constexpr std::array kAddresses{NamedAddress{"first_address", &IsaRules::first_address},
                                NamedAddress{"last_address", &IsaRules::last_address},
                                NamedAddress{"everybody", &IsaRules::everybody}};

IsaSchedule isa_schedule_of(const SettingsReader& told) {
  IsaSchedule schedule;
  schedule.version = told.number("schedule_version", schedule.version);
  schedule.period = kernel::Duration{told.number<std::int64_t>("schedule_period", 0)};
  for (std::size_t n = 0; n < told.count("schedule"); ++n) {
    const bool is_et = told.truth(nth("schedule_is_et", n), false);
    schedule.items.push_back({kernel::Duration{told.number<std::int64_t>(nth("schedule_at", n), 0)},
                              is_et ? IsaType::et : IsaType::es,
                              told.number<std::uint8_t>(nth("schedule_node", n), 0),
                              told.priority(nth("schedule_priority", n)),
                              told.number<std::uint16_t>(nth("schedule_duration", n), 0)});
  }
  return schedule;
}

}  // namespace

LinkSettings isa_settings(const IsaConfiguration& configuration) {
  const IsaRules& rules = configuration.rules;
  LinkSettings settings;
  tell_link(rules.link, settings);
  for (const NamedIsaCode& one : kIsaCodes) settings.emplace_back(one.name, rules.codes.*one.code);
  for (const NamedAddress& one : kAddresses) settings.emplace_back(one.name, rules.*one.address);
  for (const NamedTimer& one : kTimers) settings.emplace_back(one.name, rules.*one.octets);
  const IsaSchedule& schedule = configuration.schedule;
  settings.insert(settings.end(), {{"address", configuration.address},
                                   {"begins_as_scheduler", configuration.begins_as_scheduler ? 1 : 0},
                                   {"schedule_version", schedule.version},
                                   {"schedule_period", schedule.period.count()},
                                   {"schedule", static_cast<std::int64_t>(schedule.items.size())}});
  for (std::size_t n = 0; n < schedule.items.size(); ++n) {
    const IsaScheduleItem& item = schedule.items[n];
    settings.insert(settings.end(), {{nth("schedule_at", n), item.at.count()},
                                     {nth("schedule_is_et", n), item.type == IsaType::et ? 1 : 0},
                                     {nth("schedule_node", n), item.node},
                                     {nth("schedule_priority", n), static_cast<std::int64_t>(item.least)},
                                     {nth("schedule_duration", n), item.duration}});
  }
  return settings;
}

IsaConfiguration isa_configuration_of(const iut::CaseBegin& begin) {
  const SettingsReader told(begin);
  IsaConfiguration configuration;
  IsaRules& rules = configuration.rules;
  rules.link = link_of(begin);
  for (const NamedIsaCode& one : kIsaCodes)
    rules.codes.*one.code = told.number(one.name, rules.codes.*one.code);
  for (const NamedAddress& one : kAddresses) rules.*one.address = told.number(one.name, rules.*one.address);
  for (const NamedTimer& one : kTimers) rules.*one.octets = told.number(one.name, rules.*one.octets);
  configuration.address = told.number("address", configuration.address);
  configuration.begins_as_scheduler = told.truth("begins_as_scheduler", configuration.begins_as_scheduler);
  configuration.schedule = isa_schedule_of(told);
  return configuration;
}

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

void AttachedIsaDevice::order_transfer(std::uint8_t node, kernel::Time now) {
  link_.ask({static_cast<std::uint8_t>(IsaAsk::order_transfer), node}, now);
}

void AttachedIsaDevice::transmit(const iut::Transmission& transmission) {
  if (transmission.port != kUserPort) {
    link_.transmit(transmission);
    return;
  }
  attached_.expect_in_order(transmission.start, "tells its user something");
  const Octets octets = AttachedLink::told_octets(transmission);
  const auto dlpdu = octets.empty() ? std::nullopt : isa_dlpdu_of(std::span(octets).subspan(1), rules_);
  const bool is_data = dlpdu && (dlpdu->type == IsaType::du || dlpdu->type == IsaType::dt);
  if (!is_data || octets.front() != kIsaData)
    iut::refuse_impossible("tells its user what is not 01 and a DU or DT");
  user_->on_data(*dlpdu, transmission.start);
}

void AttachedIsaDevice::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  attached_.expect_in_order(when, "tells its user an event");
  if (item == kRefused) {
    link_.refuse();
  } else if (item != kEvent) {
    iut::refuse_impossible(fmt::format("writes item {}, which a station of ISA-D does not have", item));
  } else if ((value & 0xFF) >= kIsaEventKinds || value >> 16 != 0) {
    iut::refuse_impossible(fmt::format("tells {:X}h as an event; there are kinds 0 to {} of nodes up to 255",
                                       value, kIsaEventKinds - 1));
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
  if (!is_on) return;
  act(now, [&] { station().start(now); });
}

bool ServedIsaDevice::asked(const Octets& wanted, kernel::Time now) {
  constexpr std::size_t kHead = 4;
  if (wanted[0] == static_cast<std::uint8_t>(IsaAsk::order_transfer) && wanted.size() == 2) {
    station().order_transfer(wanted[1], now);
    return true;
  }
  const bool is_submit = wanted[0] == static_cast<std::uint8_t>(IsaAsk::submit) && wanted.size() >= kHead &&
                         wanted[1] <= static_cast<std::uint8_t>(IsaService::reply_data) && wanted[2] >= 1 &&
                         wanted[2] <= 3;
  if (!is_submit) return false;
  const auto data = std::span(wanted).subspan(kHead);
  return station().submit({static_cast<IsaService>(wanted[1]), static_cast<Priority>(wanted[2]), wanted[3],
                           Octets(data.begin(), data.end())},
                          now);
}

void ServedIsaDevice::on_data(const IsaDlpdu& dlpdu, kernel::Time when) {
  Octets octets{kIsaData};
  const Octets of_dlpdu = octets_of(dlpdu, rules_);
  octets.insert(octets.end(), of_dlpdu.begin(), of_dlpdu.end());
  tell_user(octets, when);
}

bool ServedIsaDevice::is_reply_coming(Priority least, kernel::Time when) {
  const auto item = static_cast<iut::Item>(kReplyComing + static_cast<unsigned>(least));
  return bench().read(item, not_past(when)) != 0;
}

}  // namespace fieldproof::fieldbus_dll
