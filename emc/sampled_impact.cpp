#include "emc/sampled_impact.hpp"

#include <algorithm>

namespace fieldproof::emc {

void SampledImpact::judge(const line::Levels& levels, const std::vector<Span>& heard, const TickGrid& grid) {
  heard_ = &heard;
  grid_ = grid;
  flipped_.clear();
  units_.clear();
  is_unclear_ = framing_ == nullptr;
  if (is_unclear_ || heard.empty()) return;
  // The bits after the last wrong time matter as far as a glitch in it may pass for a start.
  const auto from = static_cast<std::size_t>(grid_.level_of(heard.front().from));
  const auto until = static_cast<std::size_t>(grid_.level_of(heard.back().to - 1)) + 2;
  is_unclear_ = !framing_->find(levels, from, until, units_);
  auto unit = units_.begin();
  Place place{0, heard.front().from};
  while (!is_unclear_ && place.span < heard.size()) {
    const auto bit = static_cast<std::size_t>(grid_.level_of(place.at));
    while (unit != units_.end() && unit->end() <= bit) ++unit;
    const bool is_in_unit = unit != units_.end() && unit->first <= bit;
    const std::int64_t behind_decision =
        place.at - grid_.begin_of(static_cast<std::int64_t>(bit)) - last_sample();
    if (is_in_unit && (unit->role_of(bit) != BitRole::stop || behind_decision <= 0)) {
      judge_in_unit(*unit, place);
    } else {
      const auto next = is_in_unit ? unit + 1 : unit;
      const std::size_t idle_until = next == units_.end() ? levels.size() : next->first;
      judge_on_idle_line(grid_.begin_of(static_cast<std::int64_t>(idle_until)), place);
    }
  }
}

void SampledImpact::judge_in_unit(const FramedUnit& unit, Place& place) {
  const std::int64_t bit = grid_.level_of(place.at);
  const BitRole role = unit.role_of(static_cast<std::size_t>(bit));
  const bool is_edge_moved = role == BitRole::start && place.at == grid_.begin_of(bit);
  const bool is_wrong = is_sampled_wrong(bit, place.span);
  is_unclear_ = is_edge_moved || (is_wrong && role != BitRole::sampled);
  if (is_wrong) flipped_.push_back(static_cast<std::size_t>(bit));
  if (role != BitRole::stop) return pass_bit(bit, place);
  // The receiver looks for an edge after its last sample of a stop bit; what is wrong at that instant and
  // does not decide the bit may be one.
  const std::int64_t decided = grid_.begin_of(bit) + last_sample();
  while (place.span < heard_->size() && (*heard_)[place.span].from <= decided) {
    is_unclear_ = is_unclear_ || (*heard_)[place.span].to > decided;
    ++place.span;
  }
  if (place.span < heard_->size()) place.at = (*heard_)[place.span].from;
}

// Goes on after the bit.
void SampledImpact::pass_bit(std::int64_t bit, Place& place) const {
  const std::int64_t end = grid_.begin_of(bit + 1);
  while (place.span < heard_->size() && (*heard_)[place.span].to <= end) ++place.span;
  if (place.span < heard_->size()) place.at = std::max(end, (*heard_)[place.span].from);
}

// `place.at` is a falling edge of a quiet line.
void SampledImpact::judge_on_idle_line(std::int64_t idle_until, Place& place) {
  const std::int64_t quiet_from = place.at + first_sample();
  const std::int64_t decided = place.at + last_sample();
  is_unclear_ = !validates_start_ || decided >= idle_until;
  while (!is_unclear_ && place.span < heard_->size() && (*heard_)[place.span].from <= decided) {
    is_unclear_ = (*heard_)[place.span].to > quiet_from;
    ++place.span;
  }
  if (place.span < heard_->size()) place.at = (*heard_)[place.span].from;
}

bool SampledImpact::is_sampled_wrong(std::int64_t bit, std::size_t first_span) const {
  const std::int64_t middle = grid_.begin_of(bit) + sixteenths(8);
  const std::int64_t apart = sixteenths(1);
  bool before = false;
  bool at = false;
  bool behind = false;
  for (std::size_t n = first_span; n < heard_->size() && (*heard_)[n].from <= middle + apart; ++n) {
    before |= (*heard_)[n].has(middle - apart);
    at |= (*heard_)[n].has(middle);
    behind |= (*heard_)[n].has(middle + apart);
  }
  if (sampling_.kind == line::Sampling::Kind::mid_bit) return at;
  return (before && at) || (at && behind) || (before && behind);
}

}  // namespace fieldproof::emc
