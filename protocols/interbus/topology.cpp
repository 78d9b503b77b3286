#include "protocols/interbus/topology.hpp"

#include <fmt/format.h>

#include <utility>

namespace fieldproof::interbus {

namespace {
constexpr unsigned kPointsPerWord = 16;
}  // namespace

Topology::Topology(const Rules& rules, const TopologyDecisions& decisions)
    : rules_(rules),
      decisions_(decisions),
      both_off_(static_cast<std::uint16_t>(rules.control_remote_off | rules.control_local_off)) {}

void Topology::restart() {
  stations_.clear();
  control_.clear();
  levels_.clear();
  open_.clear();
  probe_ = {-1, false};
  step_ = Step::first;
  words_ = 0;
  is_finished_ = false;
  error_.clear();
}

int Topology::probed_station() const {
  return probe_.station;
}

std::uint16_t Topology::off_bit(bool on_branch) const {
  return on_branch ? rules_.control_local_off : rules_.control_remote_off;
}

void Topology::fail(std::string sentence) {
  error_ = std::move(sentence);
  is_finished_ = true;
}

void Topology::on_ids(std::span<const std::uint16_t> ids) {
  if (is_finished_) return;
  const std::size_t most = stations_.size() + 1;
  if (ids.size() < stations_.size() || ids.size() > most) {
    return fail(fmt::format("the ring has {} stations where {} to {} are possible", ids.size(),
                            stations_.size(), most));
  }
  // What is switched on answers one cycle later; at once when this is the same again after a bad cycle, which
  // the stations had obeyed.
  if (step_ == Step::switching && ids.size() < most) {
    step_ = Step::observing;
  } else {
    observe(ids);
  }
}

void Topology::observe(std::span<const std::uint16_t> ids) {
  if (ids.size() > stations_.size()) {
    add_station(ids.back());
  } else if (probe_.station >= 0) {
    // Nothing after it: the station closes the ring again.
    control_[static_cast<std::size_t>(probe_.station)] |= off_bit(probe_.on_branch);
  }
  if (!is_finished_) next_probe();
}

void Topology::add_station(std::uint16_t id) {
  FoundStation found;
  found.id_code = id & kCodeMask;
  found.before = probe_.station;
  found.on_branch = probe_.on_branch;
  const int index = static_cast<int>(stations_.size());
  const unsigned level =
      probe_.station < 0 ? 1 : levels_[static_cast<std::size_t>(probe_.station)] + (probe_.on_branch ? 1 : 0);
  const auto words = decisions_.words_of(found.id_code);
  if (!words) {
    return fail(fmt::format("station {} has the ID code {:04X}h with the undefined length code {:02X}h",
                            index, found.id_code, found.id_code >> 8));
  }
  if (stations_.size() == rules_.max_stations) {
    return fail(fmt::format("there are more than {} stations", rules_.max_stations));
  }
  if (level > rules_.max_levels) {
    return fail(fmt::format("station {} lies on level {}, more than {}", index, level, rules_.max_levels));
  }
  if ((words_ + *words) * kPointsPerWord > rules_.max_io_points) {
    return fail(
        fmt::format("with station {} there are more than {} I/O points", index, rules_.max_io_points));
  }
  found.words = *words;
  words_ += *words;
  stations_.push_back(found);
  control_.push_back(both_off_);
  levels_.push_back(level);
  open_.push_back({index, false});
  if (decisions_.searches_branches()) open_.push_back({index, true});
}

void Topology::next_probe() {
  if (open_.empty()) {
    is_finished_ = true;
    return;
  }
  probe_ = open_.back();
  open_.pop_back();
  control_[static_cast<std::size_t>(probe_.station)] &=
      static_cast<std::uint16_t>(~off_bit(probe_.on_branch));
  step_ = Step::switching;
}

}  // namespace fieldproof::interbus
