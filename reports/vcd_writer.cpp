#include "reports/vcd_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bitset>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::reports {
namespace {

// The identifier of a variable in the dump: digits to the base of the printable characters.
std::string code_of(std::size_t variable) {
  constexpr std::size_t kBase = '~' - '!' + 1;
  std::string code;
  do {
    code += static_cast<char>('!' + variable % kBase);
    variable /= kBase;
  } while (variable > 0);
  return code;
}

std::string plain(std::string_view name) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@/#-";
  std::string text;
  for (const char c : name) text += kPlain.find(c) == std::string_view::npos ? '_' : c;
  return text.empty() ? "_" : text;
}

// In a comment nothing may look like its end.
std::string in_a_comment(std::string_view text) {
  std::string line = kernel::escaped_line(text);
  std::ranges::replace(line, '$', '_');
  return line;
}

enum class Kind : std::uint8_t { wire, counter, vector };

struct Variable {
  std::string name;
  Kind kind = Kind::wire;
};

class DumpWriter {
 public:
  explicit DumpWriter(const trace::Recording& recording) : recording_(recording) {
    find_delays();
    for (const trace::Record& record : recording.records) {
      std::visit([this](const auto& one) { add(one); }, record);
    }
    for (const trace::Change& change : recording.changes) {
      for (const line::Waveform& arrival : change.arrivals) add_levels(received(change.channel), arrival, {});
    }
    std::ranges::stable_sort(changes_, {}, &ValueChange::time);
  }

  std::string write(std::string_view application, std::string_view title) {
    std::string dump = fmt::format("$version {} $end\n$comment {} $end\n$timescale 1 ps $end\n",
                                   in_a_comment(application), in_a_comment(title));
    dump += "$scope module fieldproof $end\n";
    for (std::size_t n = 0; n < variables_.size(); ++n) dump += declaration(n);
    dump += "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n";
    std::map<std::size_t, std::uint64_t> begin = take_changes(0);
    for (std::size_t n = 0; n < variables_.size(); ++n) {
      const auto known = begin.find(n);
      const std::uint64_t idle = variables_[n].kind == Kind::wire ? 1 : 0;
      set(dump, n, known == begin.end() ? idle : known->second, true);
    }
    dump += "$end\n";
    write_changes(dump);
    return dump;
  }

 private:
  struct ValueChange {
    std::int64_t time;
    std::size_t variable;
    std::uint64_t value;
  };

  // Where a line has a delay, any change on it tells how long it is.
  void find_delays() {
    for (const trace::Record& record : recording_.records) {
      const auto* one = std::get_if<trace::Transmission>(&record);
      if (one == nullptr || !one->change) continue;
      delays_.emplace(one->channel, recording_.changes[*one->change].sent.start - one->wave.start);
    }
  }

  std::size_t variable(const std::string& key, const std::string& name, Kind kind) {
    const auto [known, is_new] = numbers_.emplace(key, variables_.size());
    if (is_new) {
      std::string unique = plain(name);
      for (int n = 2; !names_.insert(unique).second; ++n) unique = fmt::format("{}_{}", plain(name), n);
      variables_.push_back({unique, kind});
    }
    return known->second;
  }

  const std::string& name_of(trace::Channel channel) const { return recording_.channels.at(channel); }
  std::size_t driven(trace::Channel channel) {
    return variable(fmt::format("{} driven", channel), name_of(channel), Kind::wire);
  }
  std::size_t received(trace::Channel channel) {
    return variable(fmt::format("{} received", channel), name_of(channel) + "/received", Kind::wire);
  }

  void add(const trace::Transmission& transmission) {
    const trace::Channel channel = transmission.channel;
    add_levels(driven(channel), transmission.wave, {});
    const auto delay = delays_.find(channel);
    if (transmission.change || delay == delays_.end()) return;
    add_levels(received(channel), transmission.wave, delay->second);
  }

  void add(const trace::Fault& fault) {
    const std::size_t counter =
        variable(fmt::format("{} faults", fault.channel), name_of(fault.channel) + "/faults", Kind::counter);
    changes_.push_back({instant(fault.time), counter, 0});  // counted when they stand in order
  }

  void add(const trace::Observation& observation) {
    const trace::Channel channel = observation.channel;
    const std::size_t vector = variable(fmt::format("{} observed {}", channel, observation.what),
                                        name_of(channel) + "/" + observation.what, Kind::vector);
    changes_.push_back({instant(observation.time), vector, observation.value});
  }

  static std::int64_t instant(kernel::Time time) {
    return std::max<std::int64_t>(time.time_since_epoch().count(), 0);
  }

  void add_levels(std::size_t wire, const line::Waveform& wave, kernel::Duration delay) {
    bool level = true;
    for (std::size_t n = 0; n < wave.levels.size(); ++n) {
      if (n > 0 && wave.levels[n] == level) continue;
      level = wave.levels[n];
      changes_.push_back({instant(wave.time_of(n) + delay), wire, level ? 1U : 0U});
    }
    if (!level) changes_.push_back({instant(wave.end() + delay), wire, 1});
  }

  std::string declaration(std::size_t number) const {
    const Variable& one = variables_[number];
    const char* type = one.kind == Kind::wire      ? "wire 1"
                       : one.kind == Kind::counter ? "integer 32"
                                                   : "wire 64";
    return fmt::format("$var {} {} {} $end\n", type, code_of(number), one.name);
  }

  // Nothing is written for a value that a variable has already.
  void set(std::string& dump, std::size_t number, std::uint64_t value, bool is_first = false) {
    values_.resize(variables_.size());
    if (!is_first && values_[number] == value) return;
    values_[number] = value;
    if (variables_[number].kind == Kind::wire) {
      dump += fmt::format("{}{}\n", value, code_of(number));
    } else {
      dump += fmt::format("b{:b} {}\n", value, code_of(number));
    }
  }

  // The last value of each variable that changes at `time`; the next changes are after it.
  std::map<std::size_t, std::uint64_t> take_changes(std::int64_t time) {
    std::map<std::size_t, std::uint64_t> last;
    for (; next_ < changes_.size() && changes_[next_].time == time; ++next_) {
      const ValueChange& change = changes_[next_];
      const bool counts = variables_[change.variable].kind == Kind::counter;
      last[change.variable] = counts ? ++counts_[change.variable] : change.value;
    }
    return last;
  }

  void write_changes(std::string& dump) {
    while (next_ < changes_.size()) {
      const std::int64_t time = changes_[next_].time;
      std::string block;
      for (const auto& [number, value] : take_changes(time)) set(block, number, value);
      if (!block.empty()) dump += fmt::format("#{}\n{}", time, block);
    }
  }

  const trace::Recording& recording_;
  std::map<trace::Channel, kernel::Duration> delays_;  // of lines on which something was changed
  std::map<std::string, std::size_t> numbers_;
  std::set<std::string> names_;
  std::vector<Variable> variables_;
  std::vector<ValueChange> changes_;
  std::size_t next_ = 0;  // of the changes that are not written
  std::vector<std::uint64_t> values_;
  std::map<std::size_t, std::uint64_t> counts_;
};

}  // namespace

std::string vcd(const trace::Recording& recording, std::string_view application, std::string_view title) {
  return DumpWriter(recording).write(application, title);
}

}  // namespace fieldproof::reports
