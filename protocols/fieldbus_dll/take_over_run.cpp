#include "protocols/fieldbus_dll/take_over_run.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include "harness/fault/channel.hpp"
#include "harness/kernel/random.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::array<std::uint8_t, 3> kMasters{0x10, 0x11, 0x14};
constexpr std::array<std::uint8_t, 3> kPublishers{0x20, 0x21, 0x22};
constexpr std::uint8_t kSelector = 0x20;
constexpr std::uint32_t kMacrocycle = 16'000;  // ticks: 500 ms
constexpr kernel::Duration kMacrocycleTime = kMacrocycle * kTick;

// By then every node is live and every master knows it.
constexpr kernel::Duration kBegin = 3 * kernel::kSecond;

FfSchedule schedule() {
  FfSchedule all{.version = 1, .macrocycle = kMacrocycle, .items = {}};
  for (std::uint32_t n = 0; n < 6; ++n)
    all.items.push_back({n * 2'600 + 100, address_of(kPublishers[n % 3], kSelector), Priority::normal});
  return all;
}

FfConfiguration configuration_of(std::uint8_t node) {
  FfConfiguration configuration;
  configuration.node = node;
  configuration.published = {address_of(node, kSelector)};
  configuration.schedule = schedule();
  configuration.begins_as_scheduler = node == kMasters.front();
  return configuration;
}

class Lossy final : public fault::Channel {
 public:
  Lossy(double probability, const kernel::Random& random) : probability_(probability), random_(random) {}
  bool pass(const line::Waveform&, line::Waveforms&) override { return random_.chance(probability_); }

 private:
  double probability_;
  kernel::Random random_;
};

// Nothing that is driven from some instant on reaches the line.
class MortalPort final : public segment::Port {
 public:
  explicit MortalPort(segment::Port& line) : line_(line) {}
  void die() { is_dead_ = true; }
  void drive(line::Waveform& wave) override {
    if (is_dead_) {
      wave.levels.clear();
    } else {
      line_.drive(wave);
    }
  }

 private:
  segment::Port& line_;
  bool is_dead_ = false;
};

class SilentUser final : public FfUser {
 public:
  void on_data(const FfDlpdu&, kernel::Time) override {}
  void on_published(const FfDlpdu&, kernel::Time) override {}
  void on_event(const FfEvent&, kernel::Time) override {}
};

// What one station drives.
struct Driven {
  FfDlpdu dlpdu;
  std::uint8_t node;
  kernel::Time begin;
  kernel::Time end;
};

class Ear final : public segment::Tap {
 public:
  Ear(std::uint8_t node, std::vector<Driven>& all) : node_(node), all_(all) {}
  void on_wave(const line::Waveform& wave) override {
    for (const Arrived& arrived : LineEnd(rules_.link).receive(wave)) {
      if (const auto dlpdu = ff_dlpdu_of(arrived.octets, rules_))
        all_.push_back({*dlpdu, node_, wave.start, wave.end()});
    }
  }

 private:
  std::uint8_t node_;
  std::vector<Driven>& all_;
  FfRules rules_;
};

class Link {
 public:
  explicit Link(const TakeOverSetting& setting)
      : random_(setting.seed), line_(segment_, "line", segment::ContentionRule::noise, random_) {
    for (const std::uint8_t node : kMasters)
      add(masters_.emplace_back(configuration_of(node)), node, setting);
    for (const std::uint8_t node : kPublishers)
      add(publishers_.emplace_back(configuration_of(node)), node, setting);
    for (FfStation& station : publishers_)
      station.write(address_of(station.node(), kSelector), {1, 2}, segment_.now());
    for (std::size_t n = 0; n < kMasters.size() + kPublishers.size(); ++n) segment_.refresh(n);
  }

  kernel::Random& random() { return random_; }
  void run_to(kernel::Time time) { segment_.run_until(time); }
  void kill_scheduler() { ports_.front().die(); }
  const std::vector<Driven>& driven() const { return driven_; }

 private:
  void add(FfStation& station, std::uint8_t node, const TakeOverSetting& setting) {
    const std::size_t seat = segment_.attach(station, "station");
    const std::string name = "station/in" + std::to_string(seat);
    segment::MediumPort& place = line_.attach(name, seat, 0, {});
    place.sense_activity();
    if (setting.frame_loss > 0)
      place.set_channel(&channels_.emplace_back(setting.frame_loss, random_.split(name)));
    place.tap_driven(ears_.emplace_back(node, driven_));
    station.wire(ports_.emplace_back(place), user_);
    station.start(segment_.now());
  }

  kernel::Random random_;
  segment::Segment segment_;
  segment::Medium line_;
  SilentUser user_;
  std::deque<FfLas> masters_;
  std::deque<FfStation> publishers_;
  std::deque<MortalPort> ports_;
  std::deque<Lossy> channels_;
  std::deque<Ear> ears_;
  std::vector<Driven> driven_;
};

// All that is due in a span, by the schedule.
std::vector<kernel::Time> due_in(kernel::Time from, kernel::Time to) {
  std::vector<kernel::Time> all;
  for (kernel::Time cycle = kernel::kStart; cycle < to; cycle += kMacrocycleTime) {
    for (const FfScheduleItem& item : schedule().items) {
      const kernel::Time due = cycle + std::int64_t{item.at} * kTick;
      if (due >= from && due < to) all.push_back(due);
    }
  }
  return all;
}

bool is_compelled(const std::vector<Driven>& driven, kernel::Time due) {
  // Link time is told in ticks, and an item may be late by V(MSO).
  const kernel::Duration late = octets(FfRules{}.link, FfRules{}.scheduling_overhead_octets);
  return std::ranges::any_of(driven, [&](const Driven& one) {
    return one.dlpdu.type == FfType::cd && one.begin >= due - kTick && one.begin <= due + late;
  });
}

}  // namespace

kernel::Duration take_over_silence() {
  const FfRules rules;
  return octets(rules.link,
                std::int64_t{kMasters[1]} * rules.link.slot_time_octets + rules.claim_delay_octets);
}

TakeOver run_take_over(const TakeOverSetting& setting) {
  Link link(setting);
  const kernel::Time death = kernel::kStart + kBegin +
                             kernel::Duration{static_cast<std::int64_t>(
                                 link.random().below(static_cast<std::uint64_t>(kMacrocycleTime.count())))};
  link.run_to(death);
  link.kill_scheduler();
  const kernel::Time end = death + 3 * kMacrocycleTime;
  link.run_to(end);

  TakeOver found;
  kernel::Time last_activity = kernel::kStart;
  kernel::Time claimed = kernel::kNever;
  std::set<std::uint8_t> schedulers{kMasters.front()};
  for (const Driven& one : link.driven()) {
    if (one.dlpdu.type == FfType::cl) {
      if (++found.claims == 1) {
        found.claimer = one.node;
        found.silence = one.begin - last_activity;
        claimed = one.begin;
        schedulers = {one.node};
      }
    }
    if (is_of_scheduler(one.dlpdu.type) && !schedulers.contains(one.node)) ++found.foreign_frames;
    last_activity = std::max(last_activity, one.end);
  }
  if (found.claimer == 0) return found;
  // CL, V(MID) and TD, and what must be kept free before an item.
  constexpr std::int64_t kUntilReady = 7 + 8 + 12 + 8 + 16;
  const kernel::Time ready = claimed + octets(FfRules{}.link, kUntilReady);
  found.due_meanwhile = static_cast<unsigned>(due_in(death, ready).size());
  for (const kernel::Time due : due_in(death, end - kMacrocycleTime / 2)) {
    if (!is_compelled(link.driven(), due)) ++found.not_compelled;
  }
  return found;
}

}  // namespace fieldproof::fieldbus_dll
