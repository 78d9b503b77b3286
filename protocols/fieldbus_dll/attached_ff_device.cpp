#include "protocols/fieldbus_dll/attached_ff_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr auto kEventKinds = static_cast<std::uint64_t>(FfEventKind::left) + 1;

struct NamedCode {
  const char* name;
  std::uint8_t FfCodes::* code;
};
constexpr std::array kCodes{NamedCode{"code_cd", &FfCodes::cd},   NamedCode{"code_dt1", &FfCodes::dt1},
                            NamedCode{"code_dt3", &FfCodes::dt3}, NamedCode{"code_sr", &FfCodes::sr},
                            NamedCode{"code_ct", &FfCodes::ct},   NamedCode{"code_td", &FfCodes::td},
                            NamedCode{"code_pn", &FfCodes::pn},   NamedCode{"code_pr", &FfCodes::pr},
                            NamedCode{"code_pt", &FfCodes::pt},   NamedCode{"code_rt", &FfCodes::rt},
                            NamedCode{"code_ri", &FfCodes::ri},   NamedCode{"code_cl", &FfCodes::cl},
                            NamedCode{"code_tl", &FfCodes::tl},   NamedCode{"code_idle", &FfCodes::idle}};

struct NamedNumber {
  const char* name;
  unsigned FfRules::* number;
};
constexpr std::array kNumbers{NamedNumber{"unpolled", &FfRules::unpolled},
                              NamedNumber{"scheduling_overhead_octets", &FfRules::scheduling_overhead_octets},
                              NamedNumber{"least_token_octets", &FfRules::least_token_octets},
                              NamedNumber{"token_holding_octets", &FfRules::token_holding_octets},
                              NamedNumber{"claim_delay_octets", &FfRules::claim_delay_octets},
                              NamedNumber{"misses_until_removal", &FfRules::misses_until_removal}};

struct NamedNode {
  const char* name;
  std::uint8_t FfRules::* node;
};
constexpr std::array kNodes{NamedNode{"first_node", &FfRules::first_node},
                            NamedNode{"last_node", &FfRules::last_node},
                            NamedNode{"first_unpolled", &FfRules::first_unpolled}};

FfSchedule schedule_of(const SettingsReader& told) {
  FfSchedule schedule;
  schedule.version = told.number("schedule_version", schedule.version);
  schedule.macrocycle = std::max(1U, told.number("macrocycle", schedule.macrocycle));
  for (std::size_t n = 0; n < told.count("schedule"); ++n) {
    schedule.items.push_back({told.number<std::uint32_t>(nth("schedule_at", n), 0),
                              told.number<FfAddress>(nth("schedule_address", n), 0),
                              told.priority(nth("schedule_priority", n))});
  }
  return schedule;
}

Octets request(FfAsk ask) {
  return {static_cast<std::uint8_t>(ask)};
}

}  // namespace

LinkSettings ff_settings(const FfConfiguration& configuration) {
  const FfRules& rules = configuration.rules;
  LinkSettings settings;
  tell_link(rules.link, settings);
  for (const NamedCode& one : kCodes) settings.emplace_back(one.name, rules.codes.*one.code);
  for (const NamedNode& one : kNodes) settings.emplace_back(one.name, rules.*one.node);
  for (const NamedNumber& one : kNumbers) settings.emplace_back(one.name, rules.*one.number);
  settings.insert(settings.end(), {{"target_rotation", rules.target_rotation.count()},
                                   {"time_distribution_period", rules.time_distribution_period.count()},
                                   {"steers_by_three_steps", rules.steers_by_three_steps ? 1 : 0},
                                   {"returns_with_last_data", rules.returns_with_last_data ? 1 : 0},
                                   {"node", configuration.node},
                                   {"supports_long_addresses", configuration.supports_long_addresses ? 1 : 0},
                                   {"begins_as_scheduler", configuration.begins_as_scheduler ? 1 : 0}});
  tell_list("published", configuration.published, settings);
  tell_list("subscribed", configuration.subscribed, settings);
  tell_list("live", configuration.live, settings);
  const FfSchedule& schedule = configuration.schedule;
  settings.insert(settings.end(), {{"schedule_version", schedule.version},
                                   {"macrocycle", schedule.macrocycle},
                                   {"schedule", static_cast<std::int64_t>(schedule.items.size())}});
  for (std::size_t n = 0; n < schedule.items.size(); ++n) {
    const FfScheduleItem& item = schedule.items[n];
    settings.emplace_back(nth("schedule_at", n), item.at);
    settings.emplace_back(nth("schedule_address", n), item.address);
    settings.emplace_back(nth("schedule_priority", n), static_cast<std::int64_t>(item.priority));
  }
  return settings;
}

FfConfiguration ff_configuration_of(const iut::CaseBegin& begin) {
  const SettingsReader told(begin);
  FfConfiguration configuration;
  FfRules& rules = configuration.rules;
  rules.link = link_of(begin);
  for (const NamedCode& one : kCodes) rules.codes.*one.code = told.number(one.name, rules.codes.*one.code);
  for (const NamedNode& one : kNodes) rules.*one.node = told.number(one.name, rules.*one.node);
  for (const NamedNumber& one : kNumbers) rules.*one.number = told.number(one.name, rules.*one.number);
  rules.target_rotation = kernel::Duration{told.number("target_rotation", rules.target_rotation.count())};
  rules.time_distribution_period =
      kernel::Duration{told.number("time_distribution_period", rules.time_distribution_period.count())};
  rules.steers_by_three_steps = told.truth("steers_by_three_steps", rules.steers_by_three_steps);
  rules.returns_with_last_data = told.truth("returns_with_last_data", rules.returns_with_last_data);
  configuration.node = told.number("node", configuration.node);
  configuration.supports_long_addresses =
      told.truth("supports_long_addresses", configuration.supports_long_addresses);
  configuration.begins_as_scheduler = told.truth("begins_as_scheduler", configuration.begins_as_scheduler);
  configuration.published = told.list<FfAddress>("published");
  configuration.subscribed = told.list<FfAddress>("subscribed");
  configuration.live = told.list<std::uint8_t>("live");
  configuration.schedule = schedule_of(told);
  return configuration;
}

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

void AttachedFfDevice::order_transfer(std::uint8_t node, kernel::Time now) {
  Octets octets = request(FfAsk::order_transfer);
  octets.push_back(node);
  link_.ask(octets, now);
}

void AttachedFfDevice::transmit(const iut::Transmission& transmission) {
  if (transmission.port != kUserPort) {
    link_.transmit(transmission);
    return;
  }
  attached_.expect_in_order(transmission.start, "tells its user something");
  const Octets octets = AttachedLink::told_octets(transmission);
  const std::uint8_t what = octets.empty() ? std::uint8_t{0} : octets.front();
  const auto dlpdu = octets.empty() ? std::nullopt : ff_dlpdu_of(std::span(octets).subspan(1), rules_);
  if (what == static_cast<std::uint8_t>(FfIndication::data) && dlpdu && dlpdu->type == FfType::dt1) {
    user_->on_data(*dlpdu, transmission.start);
  } else if (what == static_cast<std::uint8_t>(FfIndication::published) && dlpdu &&
             dlpdu->type == FfType::dt3) {
    user_->on_published(*dlpdu, transmission.start);
  } else {
    iut::refuse_impossible("tells its user what is neither 01 and a DT1 nor 02 and a DT3");
  }
}

void AttachedFfDevice::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  attached_.expect_in_order(when, "tells its user an event");
  if (item == kRefused) {
    link_.refuse();
  } else if (item != kEvent) {
    iut::refuse_impossible(fmt::format("writes item {}, which a station of FF-P does not have", item));
  } else if ((value & 0xFF) >= kEventKinds || value >> 16 != 0) {
    iut::refuse_impossible(fmt::format("tells {:X}h as an event; there are kinds 0 to {} of nodes up to 255",
                                       value, kEventKinds - 1));
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
  if (!is_on) return;
  act(now, [&] {
    if (!station().start(now)) refuse(now);
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
      if (octets.size() < 2 + kAddress || octets[1] < 1 || octets[1] > 3) return false;
      const auto address = static_cast<FfAddress>(number_at(octets, 2, kAddress));
      return station().submit({static_cast<Priority>(octets[1]), address, rest(2 + kAddress)}, now);
    }
    case FfAsk::write:
      if (octets.size() < 1 + kAddress) return false;
      return station().write(static_cast<FfAddress>(number_at(octets, 1, kAddress)), rest(1 + kAddress), now);
    case FfAsk::order_transfer:
      if (octets.size() != 2) return false;
      station().order_transfer(octets[1], now);
      return true;
  }
  return false;
}

void ServedFfDevice::tell(FfIndication what, const FfDlpdu& dlpdu, kernel::Time when) {
  Octets octets{static_cast<std::uint8_t>(what)};
  const Octets of_dlpdu = octets_of(dlpdu, rules_);
  octets.insert(octets.end(), of_dlpdu.begin(), of_dlpdu.end());
  tell_user(octets, when);
}

}  // namespace fieldproof::fieldbus_dll
