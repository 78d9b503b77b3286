#include "harness/fault/rule_channel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/fault/cases.hpp"

namespace fieldproof::fault {
namespace {

bool changes_levels(const Effect& effect) {
  return std::holds_alternative<Flip>(effect) || std::holds_alternative<Force>(effect);
}

bool claims_its_part(const Effect& effect) {
  return !changes_levels(effect) && !std::holds_alternative<Mute>(effect);
}

bool is_same_unit(const Span& a, const Span& b, Scope scope) {
  return a.frame == b.frame && a.frame_kind == b.frame_kind && (scope == Scope::frame || a.unit == b.unit);
}

std::uint64_t conditions_in(const When& when) {
  std::uint64_t count = 1;
  for (const auto* inner : {&when.all_of, &when.any_of, &when.none_of}) {
    for (const When& condition : *inner) count += conditions_in(condition);
  }
  return count;
}

// Steps of work beside a question, from what they cost.
constexpr std::uint64_t kStepsOfAHit = 192;
constexpr std::uint64_t kStepsOfAnArrival = 512;
constexpr std::uint64_t kStepsOfALevel = 8;  // that was not sent: whoever hears it decodes it

// How many levels arrive because of an effect on this part.
std::uint64_t levels_made_of(Piece part, const Effect& effect) {
  if (const Repeat* repeat = std::get_if<Repeat>(&effect)) return repeat->count * std::uint64_t{part.count};
  if (const Insert* insert = std::get_if<Insert>(&effect)) return insert->levels.size();
  return 0;
}

std::string description(const RuleState& state, const Span& span, Piece part) {
  const Rule& rule = *state.rule;
  return fmt::format("{} levels {}..{}: {} of {} {}, unit {} (rule {}{}{})", word_of(rule.effect), part.first,
                     part.end() - 1, span.field, span.frame_kind, span.frame, span.unit, state.number,
                     rule.name.empty() ? "" : " ", rule.name);
}

}  // namespace

RuleChannel::RuleChannel(trace::Trace& trace, trace::Channel place, std::unique_ptr<FieldMap> fields,
                         PlanWork& work)
    : trace_(trace),
      place_(place),
      work_(work),
      fields_(fields != nullptr ? std::move(fields) : std::make_unique<TransmissionFields>()) {}

void RuleChannel::add(RuleState& state, std::string_view receiver, const kernel::Random& random) {
  auto next_after = state.afters.cbegin();
  Condition condition(state.rule->when, receiver, next_after);
  if (!condition.can_hold_here()) return;
  opens_ = std::min(opens_, state.rule->when.from);
  closes_ = std::max(closes_, state.rule->when.to);
  rules_.push_back({&state, std::move(condition), random, conditions_in(state.rule->when)});
}

bool RuleChannel::pass(const line::Waveform& sent, line::Waveforms& arrivals) {
  claims_.clear();
  is_edited_ = false;
  forget_before(sent.start);
  if (sent.start < closes_) {
    if (can_answer(sent)) {
      spans_.clear();
      fields_->locate(sent, spans_);
      if (spans_.empty()) spans_.push_back({"", 0, 0, "", 0, static_cast<std::uint32_t>(sent.levels.size())});
      for (BoundRule& bound : rules_) ask(bound, sent);
    } else {
      fields_->follow(sent);
    }
  }
  if (claims_.empty() && !is_edited_ && mutes_.empty() && promised_.empty()) return false;
  const std::size_t first = arrivals.size();
  write(is_edited_ ? edited_ : sent, arrivals);
  settle(sent, arrivals, first);
  return true;
}

// An upper bound, because the exact end costs a division.
kernel::Time RuleChannel::ends_before(const line::Waveform& sent) {
  constexpr std::int64_t kFar = 1'000'000'000'000'000'000;
  if (sent.levels.size() > 1'000'000 || sent.start.time_since_epoch().count() > kFar) return kernel::kNever;
  if (sent.rate != known_rate_) {
    known_rate_ = sent.rate;
    longest_level_ = kernel::Duration{kernel::kSecond.count() / sent.rate + 1};
  }
  return sent.start + longest_level_ * static_cast<std::int64_t>(sent.levels.size());
}

bool RuleChannel::can_answer(const line::Waveform& sent) {
  const kernel::Time end = ends_before(sent);
  if (end <= opens_) return false;
  bool is_any_left = false;
  for (const BoundRule& bound : rules_) {
    if (bound.state->is_spent()) continue;
    if (bound.condition.can_hold_between(sent.start, end)) return true;
    is_any_left = true;
  }
  if (!is_any_left) closes_ = kernel::Time{-kernel::Duration::max()};
  return false;
}

void RuleChannel::ask(BoundRule& bound, const line::Waveform& sent) {
  const Rule& rule = *bound.state->rule;
  asked_ = {};
  work_.spend(spans_.size());
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const Span& span = spans_[i];
    if (!bound.condition.may_mean(span)) continue;
    if (rule.scope != Scope::level) {
      ask_about(bound, span, part_of(rule, i, sent), sent);
      continue;
    }
    const std::uint64_t last = std::min<std::uint64_t>(rule.when.bit.last, span.count - 1);
    for (std::uint64_t bit = rule.when.bit.first;; bit += rule.when.bit.every) {
      ask_about(bound, span, {span.first + bit, 1}, sent);
      if (rule.when.bit.every > last - bit) break;
    }
  }
}

Piece RuleChannel::part_of(const Rule& rule, std::size_t at, const line::Waveform& sent) const {
  const Span& span = spans_[at];
  if (rule.scope == Scope::transmission) return {0, sent.levels.size()};
  if (rule.scope == Scope::field) {
    const std::uint64_t first = rule.when.bit.first;
    const std::uint64_t last = std::min<std::uint64_t>(rule.when.bit.last, span.count - 1);
    return {span.first + first, last - first + 1};
  }
  std::size_t front = at;
  std::size_t back = at;
  while (front > 0 && is_same_unit(spans_[front - 1], span, rule.scope)) --front;
  while (back + 1 < spans_.size() && is_same_unit(spans_[back + 1], span, rule.scope)) ++back;
  return {spans_[front].first, spans_[back].first + spans_[back].count - spans_[front].first};
}

void RuleChannel::ask_about(BoundRule& bound, const Span& span, Piece part, const line::Waveform& sent) {
  const Rule& rule = *bound.state->rule;
  if (bound.state->is_spent() || part == asked_) return;
  work_.spend(bound.weight);
  const Piece whole = part;
  const bool narrows = changes_levels(rule.effect);
  if (narrows && (rule.when.from > sent.start || rule.when.to != kernel::kNever)) {
    const std::size_t first = std::max(part.first, sent.first_level_at(rule.when.from));
    const std::size_t end = std::min(part.end(), sent.first_level_at(rule.when.to));
    part = {first, end > first ? end - first : 0};
  }
  if (part.count == 0 || (claims_its_part(rule.effect) && is_claimed(part))) return;
  const Candidate candidate{span, part, rule.scope == Scope::level, sent.time_of(part.first)};
  if (!bound.condition.holds(candidate, !narrows, bound.random)) return;
  asked_ = whole;
  if (rule.when.chance < 1.0 && !bound.random.chance(rule.when.chance)) return;
  enter(bound, span, part, sent);
}

// Claims do not touch each other, so only the first one that ends after the begin of the part can touch it.
bool RuleChannel::is_claimed(Piece part) const {
  const auto next = std::partition_point(claims_.begin(), claims_.end(),
                                         [&](const Claim& claim) { return claim.part.end() <= part.first; });
  return next != claims_.end() && next->part.touches(part);
}

void RuleChannel::enter(BoundRule& bound, const Span& span, Piece part, const line::Waveform& sent) {
  RuleState& state = *bound.state;
  ++state.hits;
  work_.spend(kStepsOfAHit + part.count);
  const kernel::Time start = sent.time_of(part.first);
  trace_.fault(place_, start, description(state, span, part));
  const Rule& rule = *state.rule;
  if (changes_levels(rule.effect)) {
    change_levels(rule, part, sent);
  } else if (const Mute* mute = std::get_if<Mute>(&rule.effect)) {
    if (mute->duration > kernel::Duration{}) this->mute({start, start + mute->duration});
  } else {
    const auto behind = std::partition_point(
        claims_.begin(), claims_.end(), [&](const Claim& claim) { return claim.part.first <= part.first; });
    claims_.insert(behind, {part, &rule.effect});
  }
}

// Mutes that meet become one, so that a rule that answers again and again leaves a single one.
void RuleChannel::mute(Interval interval) {
  const auto first = std::partition_point(mutes_.begin(), mutes_.end(),
                                          [&](const Interval& mute) { return mute.to < interval.from; });
  auto end = first;
  for (; end != mutes_.end() && end->from <= interval.to; ++end) {
    interval.from = std::min(interval.from, end->from);
    interval.to = std::max(interval.to, end->to);
  }
  mutes_.insert(mutes_.erase(first, end), interval);
}

void RuleChannel::change_levels(const Rule& rule, Piece part, const line::Waveform& sent) {
  line::Levels& levels = levels_to_change(sent);
  if (const Flip* flip = std::get_if<Flip>(&rule.effect)) {
    for (const std::uint32_t level : flip->levels) {
      if (part.first + level < levels.size()) levels.flip(part.first + level);
    }
    if (flip->levels.empty()) {
      for (std::size_t n = part.first; n < part.end(); ++n) levels.flip(n);
    }
    return;
  }
  const Force& force = std::get<Force>(rule.effect);
  std::size_t end = part.end();
  if (force.count != 0) end = std::min(part.first + force.count, levels.size());
  if (force.duration != kernel::Duration{}) {
    end = sent.first_level_at(sent.time_of(part.first) + force.duration);
  }
  for (std::size_t n = part.first; n < end; ++n) levels.set(n, force.level);
}

line::Levels& RuleChannel::levels_to_change(const line::Waveform& sent) {
  if (!is_edited_) edited_ = sent;
  is_edited_ = true;
  return edited_.levels;
}

void RuleChannel::write(const line::Waveform& sent, line::Waveforms& arrivals) {
  ArrivalWriter writer(sent, arrivals);
  std::size_t written = 0;
  for (const Claim& claim : claims_) {
    const Piece part = claim.part;
    writer.write({written, part.first - written});
    written = part.end();
    work_.spend(kStepsOfALevel * levels_made_of(claim.part, *claim.effect));
    if (const Delay* delay = std::get_if<Delay>(claim.effect)) writer.write(part, delay->duration);
    if (const Repeat* repeat = std::get_if<Repeat>(claim.effect)) {
      writer.write(part);
      for (std::uint32_t n = 0; n < repeat->count; ++n) {
        writer.shift(repeat->gap);
        writer.shift(static_cast<std::int64_t>(part.count));
        writer.write(part);
      }
    }
    if (const Insert* insert = std::get_if<Insert>(claim.effect)) {
      if (insert->is_behind) writer.write(part);
      const Piece all{0, insert->levels.size()};
      writer.write(insert->levels, all, insert->is_behind ? part.end() : part.first);
      writer.shift(static_cast<std::int64_t>(all.count));
      if (!insert->is_behind) writer.write(part);
    }
  }
  writer.write({written, sent.levels.size() - written});
  writer.finish();
}

void RuleChannel::forget_before(kernel::Time time) {
  const auto is_over = [&](const Interval& interval) { return interval.to <= time; };
  std::erase_if(mutes_, is_over);
  std::erase_if(promised_, is_over);
}

// Holds the new arrivals against the mutes and against what was promised by earlier transmissions.
void RuleChannel::settle(const line::Waveform& sent, line::Waveforms& arrivals, std::size_t first) {
  if (!mutes_.empty()) silence(arrivals, first);
  work_.spend((arrivals.size() - first) * (kStepsOfAnArrival + promised_.size()));
  const kernel::Time end = sent.end();
  const std::size_t known = promised_.size();
  for (std::size_t i = first; i < arrivals.size(); ++i) {
    line::Waveform& arrival = arrivals[i];
    for (std::size_t k = 0; k < known; ++k) {
      const Interval earlier = promised_[k];
      if (arrival.start < earlier.from) {
        cut_back(arrival, earlier.from);
      } else if (arrival.start < earlier.to) {
        cut_front(arrival, earlier.to);
      }
    }
    if (!arrival.levels.empty() && arrival.end() > end) promised_.push_back({arrival.start, arrival.end()});
  }
  std::sort(promised_.begin(), promised_.end(),
            [](const Interval& a, const Interval& b) { return a.from < b.from; });
  arrivals.drop_empty();
}

void RuleChannel::silence(line::Waveforms& arrivals, std::size_t first) const {
  for (const Interval& mute : mutes_) {
    const std::size_t count = arrivals.size();
    for (std::size_t i = first; i < count; ++i) {
      if (arrivals[i].start >= mute.to || arrivals[i].end() <= mute.from) continue;
      line::Waveform behind = arrivals[i];
      cut_front(behind, mute.to);
      cut_back(arrivals[i], mute.from);
      if (!behind.levels.empty()) arrivals.take(behind);
    }
  }
  order_by_start(arrivals, first);
}

}  // namespace fieldproof::fault
