#include "protocols/fieldbus_dll/take_over_run.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "harness/kernel/random.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::array<std::uint8_t, 3> kMasters{0x10, 0x11, 0x14};
constexpr std::array<std::uint8_t, 3> kPublishers{0x20, 0x21, 0x22};
constexpr std::uint8_t kSelectorOfTakeOver = 0x20;
constexpr std::uint32_t kMacrocycle = 16'000;  // ticks: 500 ms
constexpr kernel::Duration kMacrocycleTime = kMacrocycle * kTick;

// By then every node is live and every master knows it.
constexpr kernel::Duration kBegin = 3 * kernel::kSecond;

FfSchedule schedule() {
  FfSchedule all{.version = 1, .macrocycle = kMacrocycle, .items = {}};
  for (std::uint32_t n = 0; n < 6; ++n)
    all.items.push_back(
        {n * 2'600 + 100, address_of(kPublishers[n % 3], kSelectorOfTakeOver), Priority::normal});
  return all;
}

FfRules ff_rules_at(std::int64_t bit_rate) {
  FfRules rules;
  rules.link.bit_rate = bit_rate;
  return rules;
}

FfConfiguration configuration_of(std::uint8_t node, const FfRules& rules) {
  FfConfiguration configuration;
  configuration.rules = rules;
  configuration.node = node;
  configuration.published = {address_of(node, kSelectorOfTakeOver)};
  configuration.schedule = schedule();
  configuration.begins_as_scheduler = node == kMasters.front();
  return configuration;
}

// What one station drives.
struct Driven {
  FfType type;
  FfAddress address;  // CD: whose data; DT3: of these
  std::uint8_t node;
  kernel::Time begin;
  kernel::Time end;
};

FfAddress of_publisher(const FfDlpdu& dlpdu) {
  return dlpdu.type == FfType::dt3 ? dlpdu.source : dlpdu.destination;
}

struct Due {
  kernel::Time time;
  FfAddress address;
};

// All that is due in a span, by the schedule.
std::vector<Due> due_in(kernel::Time from, kernel::Time to) {
  std::vector<Due> all;
  for (kernel::Time cycle = kernel::kStart; cycle < to; cycle += kMacrocycleTime) {
    for (const FfScheduleItem& item : schedule().items) {
      const kernel::Time due = cycle + std::int64_t{item.at} * kTick;
      if (due >= from && due < to) all.push_back({due, item.address});
    }
  }
  return all;
}

const Driven* cd_for(const std::vector<Driven>& driven, const Due& due, const FfRules& rules) {
  // Link time is told in ticks, and an item may be late by V(MSO) and, where octets are short, by a tick.
  const kernel::Duration late = octets(rules.link, rules.scheduling_overhead_octets) + kTick;
  const auto found = std::ranges::find_if(driven, [&](const Driven& one) {
    return one.type == FfType::cd && one.address == due.address && one.begin >= due.time - kTick &&
           one.begin <= due.time + late;
  });
  return found == driven.end() ? nullptr : &*found;
}

bool is_answered(const std::vector<Driven>& driven, const Driven& cd, const FfRules& rules) {
  const kernel::Time until = cd.end + response_delay(rules.link);
  return std::ranges::any_of(driven, [&](const Driven& one) {
    return one.type == FfType::dt3 && one.address == cd.address && one.begin > cd.end && one.begin <= until;
  });
}

}  // namespace

kernel::Duration take_over_silence(std::int64_t bit_rate) {
  const FfRules rules = ff_rules_at(bit_rate);
  return octets(rules.link,
                std::int64_t{kMasters[1]} * rules.link.slot_time_octets + rules.claim_delay_octets);
}

TakeOver run_take_over(const TakeOverSetting& setting) {
  const FfRules rules = ff_rules_at(setting.bit_rate);
  kernel::Random random(setting.seed);
  FfLink link(rules, random.split("link"), setting.disturb);
  std::vector<Driven> driven;
  link.on_driven([&driven](const FfDriven& one) {
    driven.push_back({one.dlpdu.type, of_publisher(one.dlpdu), one.node, one.begin, one.end});
  });
  FfSilentUser user;
  for (const std::uint8_t node : kMasters) link.add_master(configuration_of(node, rules), user);
  for (const std::uint8_t node : kPublishers) {
    link.add_device(configuration_of(node, rules), user);
    link.write(node, address_of(node, kSelectorOfTakeOver), {1, 2});
  }
  const kernel::Time death = kernel::kStart + kBegin +
                             kernel::Duration{static_cast<std::int64_t>(
                                 random.below(static_cast<std::uint64_t>(kMacrocycleTime.count())))};
  link.run_to(death);
  link.kill(kMasters.front());
  const kernel::Time end = death + 3 * kMacrocycleTime;
  link.run_to(end);

  TakeOver found;
  kernel::Time last_activity = kernel::kStart;
  kernel::Time claimed = kernel::kNever;
  std::set<std::uint8_t> schedulers{kMasters.front()};
  for (const Driven& one : driven) {
    if (one.type == FfType::cl) {
      if (++found.claims == 1) {
        found.claimer = one.node;
        found.silence = one.begin - last_activity;
        claimed = one.begin;
        schedulers = {one.node};
      }
    }
    if (is_of_scheduler(one.type) && !schedulers.contains(one.node)) ++found.foreign_frames;
    last_activity = std::max(last_activity, one.end);
  }
  if (found.claimer == 0) return found;
  // CL, V(MID) and TD, and what must be kept free before an item.
  constexpr std::int64_t kUntilReady = 7 + 8 + 12 + 8 + 16;
  const kernel::Time ready = claimed + octets(rules.link, kUntilReady);
  found.due_meanwhile = static_cast<unsigned>(due_in(death, ready).size());
  for (const Due& due : due_in(death, end - kMacrocycleTime / 2)) {
    const Driven* const cd = cd_for(driven, due, rules);
    if (cd == nullptr) {
      ++found.not_compelled;
    } else if (!is_answered(driven, *cd, rules)) {
      ++found.not_published;
    }
  }
  return found;
}

}  // namespace fieldproof::fieldbus_dll
