// For tests of captures: a case that is run and leaves its recording, the recording in words, and what a
// program of others reads in the capture, to be held against each other.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/probe/program_fixture.hpp"
#include "reports/wireshark/third_party_reader.hpp"

namespace fieldproof::cli {

inline std::size_t count_of(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// What tshark prints of a field that stands in a packet several times.
inline std::size_t entries_of(const std::string& list) {
  return list.empty() ? 0 : count_of(list, ",") + 1;
}

inline bool is_true(const std::string& field) {
  return field == "1" || field == "True";
}

inline std::size_t false_entries_of(const std::string& list) {
  return count_of(list, "0") + count_of(list, "False");
}

// A line of trace.txt.
struct TraceLine {
  std::string channel;
  std::string text;

  bool is_fault() const { return text.starts_with("fault: "); }
  bool is_observation() const { return !is_fault() && text.find(" = ") != std::string::npos; }
  bool is_transmission() const { return !is_fault() && !is_observation(); }
  // "05" of "05  [01010000011]": what its protocol tells of it.
  std::string words() const { return text.substr(0, text.find("  ")); }
};

class CaptureFixture : public ProgramFixture {
 protected:
  // Runs a case; gives the folder of what it left.
  std::filesystem::path run(const std::string& id, std::vector<std::string> options) const {
    std::vector<std::string> arguments = {"run", id, "--volume", "quick", "--record", "all", "--out", "run"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    call(arguments);
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "run" / "cases"))
      return entry.path();
    return {};
  }

  static std::vector<TraceLine> lines_in(const std::filesystem::path& file) {
    std::vector<TraceLine> all;
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t channel = line.find("  ") + 2;
      if (line.compare(channel, 5, "step ") == 0) continue;  // of a case that is a chart; on no channel
      const std::size_t text = line.find("  ", channel);
      all.push_back({line.substr(channel, text - channel), line.substr(text + 2)});
    }
    return all;
  }
};

}  // namespace fieldproof::cli
