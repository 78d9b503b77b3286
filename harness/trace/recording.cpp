#include "harness/trace/recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace fieldproof::trace {
namespace {

constexpr std::size_t kMostLevelsNamed = 8;

bool is_equal(const line::Waveform& a, const line::Waveform& b) {
  return a.start == b.start && a.rate == b.rate && a.levels == b.levels;
}

std::string changed_levels(const line::Levels& sent, const line::Levels& arrived) {
  std::vector<std::size_t> named;
  std::size_t count = 0;
  for (std::size_t n = 0; n < sent.size(); ++n) {
    if (sent[n] == arrived[n]) continue;
    if (++count <= kMostLevelsNamed) named.push_back(n);
  }
  const std::string more =
      count > kMostLevelsNamed ? fmt::format(" and {} more", count - kMostLevelsNamed) : "";
  return fmt::format("level{} {}{} changed", count == 1 ? "" : "s", fmt::join(named, ", "), more);
}

}  // namespace

Channel channel_of(const Record& record) {
  return std::visit([](const auto& one) { return one.channel; }, record);
}

kernel::Time time_of(const Record& record) {
  if (const auto* transmission = std::get_if<Transmission>(&record)) return transmission->wave.start;
  if (const auto* fault = std::get_if<Fault>(&record)) return fault->time;
  return std::get<Observation>(record).time;
}

std::string describe(const Change& change) {
  const line::Waveform& sent = change.sent;
  if (change.arrivals.empty()) return "lost on the way";
  if (change.arrivals.size() > 1) return fmt::format("arrives as {} transmissions", change.arrivals.size());
  const line::Waveform& arrival = change.arrivals.front();
  if (arrival.rate != sent.rate) {
    return fmt::format("arrives with {} levels/s instead of {}", arrival.rate, sent.rate);
  }
  if (arrival.levels.size() != sent.levels.size()) {
    return fmt::format("arrives with {} levels instead of {}", arrival.levels.size(), sent.levels.size());
  }
  std::string text;
  if (arrival.start != sent.start) {
    text = fmt::format("{} late", kernel::describe(arrival.start - sent.start));
    if (arrival.levels == sent.levels) return text;
    text += ", ";
  }
  return text + changed_levels(sent.levels, arrival.levels);
}

FaultIndex::FaultIndex(const Recording& recording) {
  for (const Record& record : recording.records) {
    if (const auto* fault = std::get_if<Fault>(&record)) faults_[fault->channel].push_back(fault);
  }
  for (auto& [channel, faults] : faults_) {
    std::ranges::stable_sort(faults, {}, [](const Fault* fault) { return fault->time; });
  }
}

std::vector<const Fault*> FaultIndex::of(const Change& change) const {
  const auto found = faults_.find(change.channel);
  if (found == faults_.end()) return {};
  const auto time = [](const Fault* fault) { return fault->time; };
  const auto first = std::ranges::lower_bound(found->second, change.sent.start, {}, time);
  const auto end = std::ranges::lower_bound(found->second, change.sent.end(), {}, time);
  return {first, end};
}

void BoundedRecorder::forget_older() {
  is_cut_ = is_cut_ || !older_.records.empty() || !older_.steps.empty();
  older_ = std::exchange(newer_, {});
}

bool BoundedRecorder::make_room(std::size_t levels) {
  if (newer_.records.size() >= part_records_ || levels > part_levels_ - newer_.levels) forget_older();
  if (levels <= part_levels_) return true;
  // What is too long itself leaves a hole: nothing before it is kept.
  older_ = {};
  is_cut_ = true;
  return false;
}

void BoundedRecorder::add(Record record) {
  newer_.records.push_back(std::move(record));
  // Channels are added while a bench runs; they are known by the time something happens on them.
  for (std::size_t n = channels_.size(); n < trace_.channel_count(); ++n) {
    channels_.push_back(trace_.channel_name(static_cast<Channel>(n)));
  }
}

// Without the room that the levels of a sender's buffer have for more.
line::Waveform BoundedRecorder::Part::kept(const line::Waveform& wave) {
  levels += wave.levels.size();
  return {wave.start, wave.rate, wave.levels.slice(0, wave.levels.size())};
}

void BoundedRecorder::on_driven(Channel channel, const line::Waveform& wave) {
  if (!make_room(wave.levels.size())) return;
  newer_.driven[{channel, wave.start}] = newer_.records.size();
  add(Transmission{channel, newer_.kept(wave), std::nullopt});
}

void BoundedRecorder::on_fault(Channel channel, kernel::Time time, std::string_view what) {
  if (make_room(0)) add(Fault{channel, time, std::string(what)});
}

void BoundedRecorder::on_observation(Channel channel, kernel::Time time, std::string_view what,
                                     std::uint64_t value) {
  if (make_room(0)) add(Observation{channel, time, std::string(what), value});
}

void BoundedRecorder::on_changed(Channel receiver, kernel::Time driven_at, const line::Waveform& sent,
                                 std::span<const line::Waveform> arrivals) {
  if (arrivals.size() == 1 && is_equal(arrivals.front(), sent)) return;
  const std::pair key{receiver, driven_at};
  Part& part = !newer_.driven.contains(key) && older_.driven.contains(key) ? older_ : newer_;
  std::size_t levels = sent.levels.size();
  for (const line::Waveform& arrival : arrivals) levels += arrival.levels.size();
  if (part.changes.size() >= part_records_ || levels > part_levels_ - std::min(part.levels, part_levels_)) {
    is_cut_ = true;
    return;
  }
  if (const auto found = part.driven.find(key); found != part.driven.end()) {
    std::get<Transmission>(part.records[found->second]).change = part.changes.size();
  }
  Change change{receiver, part.kept(sent), {}};
  for (const line::Waveform& arrival : arrivals) change.arrivals.push_back(part.kept(arrival));
  part.changes.push_back(std::move(change));
}

void BoundedRecorder::on_step(kernel::Time time, std::string_view text) {
  if (newer_.steps.size() >= part_records_) forget_older();
  newer_.steps.push_back({time, std::string(text)});
}

Recording BoundedRecorder::take() {
  Recording recording;
  recording.is_cut = std::exchange(is_cut_, false);
  recording.channels = std::exchange(channels_, {});
  for (Part* const part : {&older_, &newer_}) {
    const std::size_t changes = recording.changes.size();
    for (Record& record : part->records) {
      auto* const transmission = std::get_if<Transmission>(&record);
      if (transmission != nullptr && transmission->change) *transmission->change += changes;
      recording.records.push_back(std::move(record));
    }
    std::ranges::move(part->changes, std::back_inserter(recording.changes));
    std::ranges::move(part->steps, std::back_inserter(recording.steps));
    *part = {};
  }
  return recording;
}

}  // namespace fieldproof::trace
