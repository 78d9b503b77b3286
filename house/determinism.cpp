#include <algorithm>
#include <array>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "house/rules.hpp"

namespace fieldproof::house {
namespace {

// Folders in which simulated time runs: one seed and one commit must replay everything.
bool is_virtual_time(std::string_view path) {
  static constexpr std::array folders{"harness/", "protocols/", "conformance/", "emc/", "fuzz/"};
  return std::any_of(folders.begin(), folders.end(),
                     [&](const char* folder) { return path.starts_with(folder); });
}

struct Ban {
  std::regex pattern;
  std::string reason;
};

const std::vector<Ban>& bans() {
  static const std::vector<Ban> list{
      {std::regex(R"(\b\w+_distribution\b)"),
       "each standard library draws its own numbers; use harness/kernel/random."},
      {std::regex(R"(\bunordered_(multi)?(map|set)\b)"),
       "its order is that of a library; use an ordered container."},
      {std::regex(R"(\b(system|steady|high_resolution|utc|file)_clock\b)"),
       "the wall clock has no part in a run."},
      {std::regex(R"(\brandom_device\b|\bstd::s?rand\b)"), "chance comes from the seed of the run."},
      {std::regex(R"(\bstd::(shuffle|sample|hash)\b)"), "its result is not specified by the standard."},
      {std::regex(R"(\b(gettimeofday|clock_gettime|localtime|gmtime)\b)"),
       "the wall clock has no part in a run."},
  };
  return list;
}

struct Exception {
  std::string_view path;
  std::string_view word;
  std::string_view reason;
};

constexpr std::array exceptions{
    Exception{"conformance/runner.cpp", "steady_clock",
              "the report tells how long a case took on this machine; no verdict and no fingerprint sees it"},
    Exception{"conformance/hostile_test.cpp", "steady_clock",
              "an implementation that hangs is given up in time of the machine"},
    Exception{"harness/iut/peer.hpp", "steady_clock",
              "an implementation outside may hang; how long it may is time of the machine"},
    Exception{"harness/iut/wall_clock.hpp", "steady_clock",
              "a real line is in time of the machine; nothing of it is replayed, and no other source asks "
              "the clock"},
    Exception{"harness/iut/process.cpp", "steady_clock", "a process ends in time of the machine"},
};

bool is_excepted(std::string_view path, std::string_view word) {
  return std::any_of(exceptions.begin(), exceptions.end(), [&](const Exception& exception) {
    return exception.path == path && exception.word == word;
  });
}

void check_line(const File& file, int number, const std::string& line, Complaints& complaints) {
  for (const Ban& ban : bans()) {
    std::smatch match;
    if (std::regex_search(line, match, ban.pattern) && !is_excepted(file.path, match.str())) {
      complaints.push_back({file.path, number, match.str() + ": " + ban.reason});
    }
  }
}

}  // namespace

Complaints check_determinism(const std::vector<File>& files) {
  Complaints complaints;
  for (const File& file : files) {
    if (!is_source(file) || !is_virtual_time(file.path)) continue;
    int number = 0;
    for (const std::string& line : lines_of(code_of(file.text))) check_line(file, ++number, line, complaints);
  }
  return complaints;
}

Complaints check_determinism_exceptions(const std::vector<File>& files) {
  Complaints complaints;
  for (const Exception& exception : exceptions) {
    const bool is_needed = std::any_of(files.begin(), files.end(), [&](const File& file) {
      return file.path == exception.path && code_of(file.text).find(exception.word) != std::string::npos;
    });
    if (!is_needed) {
      complaints.push_back({std::string(exception.path), 0,
                            std::string(exception.word) + " is excepted (" + std::string(exception.reason) +
                                ") and not used; delete the exception."});
    }
  }
  return complaints;
}

}  // namespace fieldproof::house
