#include "harness/trace/recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

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

// Once something was left out nothing follows it, so that a recording has no hole.
bool BoundedRecorder::has_room(std::size_t levels) {
  if (recording_.records.size() >= most_records_ || levels > most_levels_ - levels_) recording_.is_cut = true;
  return !recording_.is_cut;
}

void BoundedRecorder::add(Record record) {
  recording_.records.push_back(std::move(record));
  // Channels are added while a bench runs; they are known by the time something happens on them.
  for (std::size_t n = recording_.channels.size(); n < trace_.channel_count(); ++n) {
    recording_.channels.push_back(trace_.channel_name(static_cast<Channel>(n)));
  }
}

// Without the room that the levels of a sender's buffer have for more.
line::Waveform BoundedRecorder::kept(const line::Waveform& wave) {
  levels_ += wave.levels.size();
  return {wave.start, wave.rate, wave.levels.slice(0, wave.levels.size())};
}

void BoundedRecorder::on_driven(Channel channel, const line::Waveform& wave) {
  if (!has_room(wave.levels.size())) return;
  driven_[{channel, wave.start}] = recording_.records.size();
  add(Transmission{channel, kept(wave), std::nullopt});
}

void BoundedRecorder::on_fault(Channel channel, kernel::Time time, std::string_view what) {
  if (has_room(0)) add(Fault{channel, time, std::string(what)});
}

void BoundedRecorder::on_observation(Channel channel, kernel::Time time, std::string_view what,
                                     std::uint64_t value) {
  if (has_room(0)) add(Observation{channel, time, std::string(what), value});
}

void BoundedRecorder::on_changed(Channel receiver, kernel::Time driven_at, const line::Waveform& sent,
                                 std::span<const line::Waveform> arrivals) {
  if (arrivals.size() == 1 && is_equal(arrivals.front(), sent)) return;
  const auto found = driven_.find({receiver, driven_at});
  const bool is_of_a_link = found != driven_.end();
  if (!is_of_a_link && (recording_.is_cut || recording_.changes.size() >= most_records_)) return;
  std::size_t levels = sent.levels.size();
  for (const line::Waveform& arrival : arrivals) levels += arrival.levels.size();
  if (levels > most_levels_ - levels_) {
    recording_.is_cut = true;
    return;
  }
  if (is_of_a_link) {
    std::get<Transmission>(recording_.records[found->second]).change = recording_.changes.size();
  }
  Change change{receiver, kept(sent), {}};
  for (const line::Waveform& arrival : arrivals) change.arrivals.push_back(kept(arrival));
  recording_.changes.push_back(std::move(change));
}

}  // namespace fieldproof::trace
