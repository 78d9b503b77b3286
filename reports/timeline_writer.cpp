#include "reports/timeline_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;
using kernel::as_utf8;

constexpr std::string_view kTimelineSchema = "fieldproof/timeline/1";
constexpr std::size_t kMostOfAKind = 3000;
constexpr std::size_t kMostBefore = 2500;
// Faults that follow one another at most so late belong to one burst: pulses of 2.5 kHz do, cycles do not.
constexpr kernel::Duration kWithinABurst = 500 * kernel::kMicrosecond;

std::string ps(kernel::Time time) {
  return std::to_string(time.time_since_epoch().count());
}

// Records [from, to) of a recording.
struct Part {
  std::size_t from = 0;
  std::size_t to = 0;
};

std::optional<kernel::Time> first_finding(const judge::CaseResult& result) {
  std::optional<kernel::Time> first;
  for (const judge::Finding& finding : result.findings) {
    if (!first || finding.time < *first) first = finding.time;
  }
  return first;
}

Part around(std::optional<kernel::Time> time, const std::vector<trace::Record>& records) {
  const auto is_behind = [&](const trace::Record& record) { return trace::time_of(record) > *time; };
  const auto pivot = time ? std::ranges::find_if(records, is_behind) : records.end();
  Part part;
  part.from = part.to = static_cast<std::size_t>(pivot - records.begin());
  std::array<std::size_t, std::variant_size_v<trace::Record>> counts{};
  while (part.from > 0 && counts.at(records[part.from - 1].index()) < kMostBefore) {
    ++counts.at(records[--part.from].index());
  }
  while (part.to < records.size() && counts.at(records[part.to].index()) < kMostOfAKind) {
    ++counts.at(records[part.to++].index());
  }
  return part;
}

// A fault as it is told: one of the trace, or a change of a transmission that no fault of the trace explains.
struct ToldFault {
  trace::Channel channel;
  kernel::Time time;
  std::string text;
};

class TimelineWriter {
 public:
  TimelineWriter(const trace::Recording& recording, const trace::Dissector& dissector)
      : recording_(recording), dissector_(dissector), faults_of_(recording) {}

  Json write(const judge::CaseResult& result) {
    const Part part = around(first_finding(result), recording_.records);
    for (std::size_t n = part.from; n < part.to; ++n) {
      std::visit([this](const auto& record) { add(record); }, recording_.records[n]);
    }
    Json json;
    json["schema"] = kTimelineSchema;
    json["case"] = as_utf8(result.id);
    json["is_cut"] = recording_.is_cut || part.from > 0 || part.to < recording_.records.size();
    json["channels"] = Json::array();
    for (const std::string& name : recording_.channels) json["channels"].push_back({{"name", as_utf8(name)}});
    json["transmissions"] = in_order(transmissions_);
    json["faults"] = faults_json();
    json["observations"] = in_order(observations_);
    json["findings"] = findings_json(result);
    json["windows"] = windows_json();
    json["steps"] = steps_json();
    return json;
  }

 private:
  using Timed = std::pair<kernel::Time, Json>;

  static Json in_order(std::vector<Timed>& entries) {
    std::ranges::stable_sort(entries, {}, &Timed::first);
    Json list = Json::array();
    for (Timed& entry : entries) list.push_back(std::move(entry.second));
    return list;
  }

  void add(const trace::Transmission& transmission) {
    const line::Waveform& wave = transmission.wave;
    std::unique_ptr<trace::Teller>& teller = tellers_[transmission.channel];
    if (teller == nullptr) teller = dissector_.teller();
    transmissions_.emplace_back(wave.start, Json{{"channel", transmission.channel},
                                                 {"start_ps", ps(wave.start)},
                                                 {"end_ps", ps(wave.end())},
                                                 {"text", as_utf8(teller->tell(wave).text)},
                                                 {"levels", wave.levels.size()},
                                                 {"is_changed", transmission.change.has_value()}});
    if (!transmission.change) return;
    const trace::Change& change = recording_.changes[*transmission.change];
    if (faults_of_.of(change).empty()) {
      faults_.push_back({change.channel, change.sent.start, trace::describe(change)});
    }
  }

  void add(const trace::Fault& fault) { faults_.push_back({fault.channel, fault.time, fault.text}); }

  void add(const trace::Observation& observation) {
    observations_.emplace_back(observation.time, Json{{"channel", observation.channel},
                                                      {"time_ps", ps(observation.time)},
                                                      {"what", as_utf8(observation.what)},
                                                      {"value", fmt::format("{:#x}", observation.value)}});
  }

  Json faults_json() {
    std::ranges::stable_sort(faults_, {}, &ToldFault::time);
    Json list = Json::array();
    for (const ToldFault& fault : faults_) {
      list.push_back(
          {{"channel", fault.channel}, {"time_ps", ps(fault.time)}, {"text", as_utf8(fault.text)}});
    }
    return list;
  }

  static Json findings_json(const judge::CaseResult& result) {
    Json list = Json::array();
    for (const judge::Finding& finding : result.findings) {
      list.push_back({{"time_ps", ps(finding.time)},
                      {"reason", as_utf8(finding.reason)},
                      {"requirement", as_utf8(finding.requirement)},
                      {"expected", as_utf8(fmt::format("{}", fmt::join(finding.expected, " or ")))},
                      {"actual", as_utf8(finding.actual)}});
    }
    return list;
  }

  // Bursts: faults, in order of time, that follow one another closely.
  Json windows_json() const {
    Json list = Json::array();
    for (std::size_t n = 0; n < faults_.size();) {
      std::size_t end = n + 1;
      while (end < faults_.size() && faults_[end].time - faults_[end - 1].time <= kWithinABurst) ++end;
      if (end - n > 1) {
        list.push_back(
            {{"kind", "burst"}, {"from_ps", ps(faults_[n].time)}, {"to_ps", ps(faults_[end - 1].time)}});
      }
      n = end;
    }
    return list;
  }

  // The last ones, when there are more than a reader could use.
  Json steps_json() const {
    Json list = Json::array();
    const auto& steps = recording_.steps;
    for (std::size_t n = steps.size() - std::min(steps.size(), kMostOfAKind); n < steps.size(); ++n) {
      list.push_back({{"time_ps", ps(steps[n].time)}, {"text", as_utf8(steps[n].text)}});
    }
    return list;
  }

  const trace::Recording& recording_;
  const trace::Dissector& dissector_;
  trace::FaultIndex faults_of_;
  std::map<trace::Channel, std::unique_ptr<trace::Teller>> tellers_;
  std::vector<Timed> transmissions_;
  std::vector<Timed> observations_;
  std::vector<ToldFault> faults_;
};

}  // namespace

std::string timeline_json(const judge::CaseResult& result, const trace::Recording& recording,
                          const trace::Dissector& dissector) {
  return TimelineWriter(recording, dissector).write(result).dump() + "\n";
}

}  // namespace fieldproof::reports
