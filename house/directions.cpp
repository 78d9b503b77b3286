#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "house/rules.hpp"

namespace fieldproof::house {
namespace {

using Names = std::set<std::string, std::less<>>;

// Who may include whom, all of it written out. A folder may always include itself.
const std::map<std::string, Names, std::less<>>& directions() {
  static const Names bench_ground{"kernel",  "line",  "config",  "trace", "fault",
                                  "segment", "judge", "measure", "iut"};
  static const auto with = [](Names names, const Names& more) {
    names.insert(more.begin(), more.end());
    return names;
  };
  static const std::map<std::string, Names, std::less<>> table{
      {"kernel", {}},
      {"line", {"kernel"}},
      {"config", {"kernel"}},
      {"trace", {"line", "kernel"}},
      {"fault", {"trace", "line", "kernel", "config"}},
      {"segment", {"fault", "trace", "line", "kernel", "config"}},
      {"judge", {"trace", "line", "kernel", "config"}},
      {"measure", {"trace", "line", "kernel"}},
      {"iut", {"segment", "fault", "trace", "line", "kernel", "config"}},
      {"protocols", bench_ground},
      {"reports", bench_ground},
      {"conformance", with({"protocols"}, bench_ground)},
      {"emc", with({"protocols"}, bench_ground)},
      {"fuzz", with({"protocols"}, bench_ground)},
      {"cli", with({"protocols", "reports", "conformance", "emc"}, bench_ground)},
      {"bench", with({"protocols", "reports", "conformance", "emc", "examples"}, bench_ground)},
      {"house", {}},
      {"examples", {"iut"}},  // the header of plug-ins
  };
  return table;
}

struct Place {
  std::string name;      // "line" for harness/line, "protocols" for protocols/interbus
  std::string protocol;  // "interbus"; empty outside protocols
};

Place place_of(const std::string& path) {
  const std::size_t first = path.find('/');
  const std::size_t second = path.find('/', first + 1);
  const std::string top = path.substr(0, first);
  const std::string below = first == std::string::npos || second == std::string::npos
                                ? std::string()
                                : path.substr(first + 1, second - first - 1);
  if (top == "harness") return {below, ""};
  if (top == "protocols") return {top, below};
  return {top, ""};
}

std::string complaint_about(const Place& from, const Place& to) {
  const auto row = directions().find(from.name);
  if (row == directions().end())
    return "the folder \"" + from.name + "\" has no row in the directions of the house.";
  if (from.name == "protocols" && to.name == "protocols" && from.protocol != to.protocol) {
    return "protocols do not know each other.";
  }
  if (from.name == to.name || row->second.contains(to.name)) return {};
  return from.name + " may not include " + to.name + ".";
}

}  // namespace

Complaints check_include_directions(const std::vector<File>& files) {
  Complaints complaints;
  for (const File& file : files) {
    if (!is_source(file)) continue;
    const Place from = place_of(file.path);
    for (const Include& include : includes_of(file)) {
      if (!include.is_quoted) continue;
      const std::string sentence = complaint_about(from, place_of(include.target));
      if (!sentence.empty())
        complaints.push_back({file.path, include.line, include.target + ": " + sentence});
    }
  }
  return complaints;
}

}  // namespace fieldproof::house
