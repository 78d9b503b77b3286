#include "protocols/valve_bus/node_player.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/wall_clock_items.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr std::size_t kMostReports = 100'000;

}  // namespace

void NodePlayer::start(const NodeConfiguration& configuration, const iut::CaseBegin& begin) {
  node_.reset();
  rules_ = configuration.rules;
  codec_ = std::make_unique<CharacterCodec>(rules_);
  line_.set_clock(clock_);
  line_.set(rules_.bit_rate, serial_format(rules_));
  line_.forget_arrived();
  now_ = driven_until_ = kernel::kStart;
  blocks_.clear();
  reports_.clear();
  heard_ = said_ = 0;
  is_supplied_ = false;
  node_ = make_node_(configuration, begin);
  node_->wire(*this, *this);
}

void NodePlayer::begin_alone(const NodeConfiguration& configuration) {
  clock_ = iut::WallClock();
  start(configuration, {"valve_bus/node/alone", 1, {}});
  is_supplied_ = true;
  node_->set_power(true, kernel::kStart);
}

bool NodePlayer::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  bench_ = &bench;
  const auto origin =
      std::ranges::find(begin.settings, kClockOrigin, [](const auto& one) { return one.first; });
  clock_ = origin == begin.settings.end() ? iut::WallClock() : iut::WallClock(origin->second);
  start(node_configuration_of(begin), begin);
  return true;
}

void NodePlayer::end() {
  node_->end();
  node_.reset();
  bench_ = nullptr;
}

void NodePlayer::set_power(bool is_on, kernel::Time now) {
  now_ = std::max(now_, now);
  is_supplied_ = is_on;
  blocks_.clear();
  driven_until_ = now_;
  node_->set_power(is_on, now_);
  report();
}

void NodePlayer::receive(unsigned, std::span<const iut::Character>, kernel::Time) {
  FIELDPROOF_CHECK(false, "a node on a real line hears that line");
}
void NodePlayer::receive(unsigned, const line::Waveform&) {
  FIELDPROOF_CHECK(false, "a node on a real line hears that line");
}

kernel::Time NodePlayer::next_time() const {
  if (node_ == nullptr || !is_supplied_) return kernel::kNever;
  kernel::Time next = std::max(node_->next_time(), now_);
  if (!blocks_.empty()) next = std::min(next, blocks_.front().end);
  return next;
}

void NodePlayer::on_time(kernel::Time until) {
  // A node that has something to do has looked at its switches before.
  const bool is_idle = blocks_.empty() && node_ != nullptr && node_->next_time() == kernel::kNever;
  if (is_idle) switches_ = static_cast<std::uint16_t>(bench_->read(kLimitSwitches, until));
  do turn(until, -1);
  while (clock_.now() < until);
  report();
}

void NodePlayer::play(int descriptor) {
  while (true) {
    turn(kernel::kNever, descriptor);
    if (descriptor >= 0 && iut::can_be_read(descriptor)) return;
  }
}

// ---- the line and the clock ----

void NodePlayer::turn(kernel::Time until, int descriptor) {
  const kernel::Time next = std::min(next_time(), until);
  while (const auto arrival = line_.read(next, descriptor)) {
    hear(*arrival);
    if (next_time() < next) break;
  }
  advance(clock_.now());
}

// Characters that were read together followed each other, and the last one was over by then.
void NodePlayer::hear(const iut::Arrival& arrival) {
  if (node_ == nullptr || !is_supplied_) return;
  const kernel::Duration character = character_time(rules_);
  const auto length = static_cast<std::int64_t>(arrival.octets.size()) * character;
  // What has been done stays: a node does not hear what lies before that.
  kernel::Time start = std::max(arrival.stamp.latest - length, now_ - character);
  for (const std::uint8_t octet : arrival.octets) {
    line::Waveform wave;
    wave.rate = rules_.bit_rate;
    wave.start = start;
    codec_->append(wave.levels, std::span(&octet, 1));
    const kernel::Time end = wave.end();
    advance(end - kernel::kPicosecond);
    now_ = std::max(now_, end);
    node_->receive(0, wave);
    start = end;
  }
  heard_ += arrival.octets.size();
  if (reports_.size() < kMostReports) reports_.push_back(Write{kHeardOctets, heard_, now_});
}

void NodePlayer::advance(kernel::Time until) {
  while (node_ != nullptr && is_supplied_) {
    const kernel::Time node_at = std::max(node_->next_time(), now_);
    const kernel::Time block_at = blocks_.empty() ? kernel::kNever : blocks_.front().end;
    if (std::min(node_at, block_at) > until) return;
    if (block_at < node_at) {
      const Block block = std::move(blocks_.front());
      blocks_.pop_front();
      say(block);
    } else {
      now_ = node_at;
      node_->on_time(node_at);
    }
  }
}

void NodePlayer::say(const Block& block) {
  std::vector<std::uint8_t> octets;
  for (const std::uint16_t character : block.transmission.characters)
    octets.push_back(static_cast<std::uint8_t>(character));
  if (octets.empty()) return;
  const iut::Stamp written = line_.write(octets);
  said_ += octets.size();
  if (reports_.size() >= kMostReports) return;
  reports_.push_back(block.transmission);
  reports_.push_back(Write{kSaidOctets, said_, written.latest});
}

void NodePlayer::report() {
  for (; !reports_.empty(); reports_.pop_front()) {
    if (const auto* write = std::get_if<Write>(&reports_.front())) {
      bench_->write(write->item, write->value, write->when);
    } else {
      bench_->transmit(std::get<iut::Transmission>(reports_.front()));
    }
  }
}

// ---- the node ----

void NodePlayer::drive(line::Waveform& wave) {
  const auto follows = [](kernel::Time start, kernel::Time end) {
    return std::chrono::abs(start - end) <= kernel::kNanosecond;
  };
  const bool is_driving = follows(wave.start, driven_until_);
  if (!is_driving) driver_on_ = wave.start;
  codec_->hear(wave, [&](const HeardCharacter& heard) {
    const bool goes_on = is_driving && !blocks_.empty() && follows(heard.start, blocks_.back().end);
    if (!goes_on) {
      blocks_.push_back({{0, driver_on_, heard.start, {}, {}}, {}});
      driver_on_ = wave.start;  // what comes behind it without a pause has a driver that is on already
    }
    blocks_.back().transmission.characters.push_back(heard.data);
    blocks_.back().end = heard.busy_until;
  });
  driven_until_ = wave.end();
  const bool has_sent = !blocks_.empty() && blocks_.back().end > driver_on_;
  if (has_sent) blocks_.back().transmission.driver_off = driven_until_;
}

void NodePlayer::drive_valves(std::uint16_t valves, kernel::Time when) {
  if (reports_.size() < kMostReports) reports_.push_back(Write{kValves, valves, std::max(when, now_)});
}

}  // namespace fieldproof::valve_bus
