// What a file cannot say by its shape alone: names, lengths, limits and the copy task.

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "harness/field/facts.hpp"
#include "protocols/interbus/network.hpp"

namespace fieldproof::interbus {

namespace {

constexpr std::uint16_t kIdCodeMask = 0x1FFF;
constexpr unsigned kBitsPerWord = 16;

// " (rule max_stations: Park 2004, ...)".
std::string source_of(std::string_view name, const Rules& rules) {
  for (const field::Fact& fact : field::facts_of(kRulesTable, rules)) {
    if (fact.is_about(name)) return fmt::format(" (rule {}: {})", name, fact.source);
  }
  return "";
}

// Walks the stations in ring order, keeps what later rules need, and stops at the first violation.
class Checker {
 public:
  explicit Checker(const NetworkDescription& network) : network_(network), rules_(network.rules) {}

  std::optional<Violation> run() {
    check_line(network_.stations, "/stations", false, 1);
    for (std::size_t n = 0; n < network_.copy.size() && !violation_; ++n) {
      check_copy(network_.copy[n], fmt::format("/copy/{}", n));
    }
    return std::move(violation_);
  }

 private:
  void refuse(std::string pointer, std::string sentence) {
    if (!violation_) violation_ = Violation{std::move(pointer), std::move(sentence)};
  }

  void check_line(const std::vector<StationDescription>& stations, const std::string& pointer, bool is_branch,
                  unsigned level) {
    if (level > rules_.max_levels && !stations.empty()) {
      return refuse(
          pointer, fmt::format("this is network level {}; at most {} levels may branch off each other", level,
                               rules_.max_levels));
    }
    for (std::size_t n = 0; n < stations.size() && !violation_; ++n) {
      const std::string place = fmt::format("{}/{}", pointer, n);
      check_bus(stations[n], place, is_branch, stations.front().is_local);
      check_station(stations[n], place);
      check_cable(stations[n], place);
      if (!violation_) check_line(stations[n].branch, place + "/branch", true, level + 1);
    }
  }

  void check_bus(const StationDescription& station, const std::string& place, bool is_branch,
                 bool is_local_line) {
    if (station.is_local && !is_branch) {
      return refuse(place + "/bus",
                    "a local bus begins after the second outgoing interface of a station; write this station "
                    "into the branch of its bus coupler");
    }
    if (station.is_local != is_local_line) {
      refuse(place + "/bus",
             fmt::format("a branch is either a local or a remote bus; this one began as a {} bus",
                         is_local_line ? "local" : "remote"));
    }
  }

  void check_station(const StationDescription& station, const std::string& place) {
    if (station.name.empty()) return refuse(place + "/name", "a station needs a name; write one");
    if ((station.id_code & ~kIdCodeMask) != 0) {
      return refuse(place + "/id_code",
                    fmt::format("{:04X}h sets bits 13..15, which carry messages; write at most 0x1FFF",
                                station.id_code));
    }
    const auto words = words_of_id_code(station.id_code, rules_);
    if (!words) {
      return refuse(place + "/id_code",
                    fmt::format("{:04X}h has the undefined length code {:02X}h in bits 8..12; "
                                "write a code of the length table, for example 01h for one word",
                                station.id_code, unsigned{station.id_code} >> 8));
    }
    if (!stations_.emplace(station.name, Known{&station, *words}).second) {
      return refuse(
          place + "/name",
          fmt::format("\"{}\" is the name of another station too; write a name of its own", station.name));
    }
    if (stations_.size() > rules_.max_stations) {
      return refuse(place,
                    fmt::format("this is station {} of the ring; at most {} are possible{}", stations_.size(),
                                rules_.max_stations, source_of("max_stations", rules_)));
    }
    points_ += std::size_t{*words} * kBitsPerWord;
    if (points_ > rules_.max_io_points) {
      refuse(place, fmt::format("up to here the registers have {} bit; at most {} I/O points are possible{}",
                                points_, rules_.max_io_points, source_of("max_io_points", rules_)));
    }
  }

  void check_cable(const StationDescription& station, const std::string& place) {
    if (!std::isfinite(station.cable_m) || station.cable_m < 0) {
      return refuse(place + "/cable", "a cable has a length of 0 m or more");
    }
    if (station.is_local && station.cable_m > 0) {
      return refuse(place + "/cable", "a local bus has no cable; remove the length");
    }
    if (station.cable_m > rules_.max_distance_m) {
      return refuse(place + "/cable",
                    fmt::format("{} m is too long at {} bit/s; between two remote-bus stations "
                                "there may be {} m",
                                station.cable_m, rules_.bit_rate, rules_.max_distance_m));
    }
    cable_m_ += station.cable_m;
    if (cable_m_ > rules_.max_cable_m) {
      refuse(place + "/cable",
             fmt::format("up to here the remote bus is {} m long; at most {} m are possible", cable_m_,
                         rules_.max_cable_m));
    }
  }

  void check_copy(const CopyRule& rule, const std::string& place) {
    check_end(rule.from, rule.input_word, place, {"from", "input_word", "inputs", 0x2});
    check_end(rule.to, rule.output_word, place, {"to", "output_word", "outputs", 0x1});
    if (!violation_ && !written_.emplace(rule.to, rule.output_word).second) {
      refuse(place + "/to",
             fmt::format("output word {} of \"{}\" is written by an earlier copy; write each once",
                         rule.output_word, rule.to));
    }
  }

  struct End {
    std::string_view name_key;
    std::string_view word_key;
    std::string_view kind;
    unsigned direction_bit;
  };

  void check_end(const std::string& name, unsigned word, const std::string& place, const End& end) {
    const auto found = stations_.find(name);
    if (found == stations_.end()) {
      return refuse(fmt::format("{}/{}", place, end.name_key),
                    fmt::format("no station has the name \"{}\"; write the name of a station", name));
    }
    const auto& [station, words] = found->second;
    if ((station->id_code & end.direction_bit) == 0) {
      return refuse(
          fmt::format("{}/{}", place, end.name_key),
          fmt::format("station \"{}\" has no {} (direction bits of its ID code {:04X}h); name one that has",
                      name, end.kind, station->id_code));
    }
    if (word >= words) {
      refuse(fmt::format("{}/{}", place, end.word_key),
             fmt::format("station \"{}\" has no word {}; its register has {} (counted from 0)", name, word,
                         words == 1 ? std::string("1 word") : fmt::format("{} words", words)));
    }
  }

  struct Known {
    const StationDescription* station;
    unsigned words;
  };

  const NetworkDescription& network_;
  const Rules& rules_;
  std::map<std::string, Known> stations_;
  std::set<std::pair<std::string, unsigned>> written_;
  std::size_t points_ = 0;
  double cable_m_ = 0;
  std::optional<Violation> violation_;
};

}  // namespace

std::optional<Violation> check(const NetworkDescription& network) {
  return Checker(network).run();
}

}  // namespace fieldproof::interbus
