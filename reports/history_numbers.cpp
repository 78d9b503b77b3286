#include "reports/history_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "harness/kernel/error.hpp"

namespace fieldproof::reports {
namespace {

namespace fs = std::filesystem;

void add_measurements(const Run& run, std::vector<Number>& numbers) {
  for (const judge::CaseResult& result : run.cases) {
    std::map<std::string, std::size_t> seen;
    for (const judge::Measurement& one : result.measurements) {
      const std::size_t nth = ++seen[one.name];
      const std::string again = nth > 1 ? fmt::format(" ({})", nth) : "";
      numbers.push_back({fmt::format("{}: {}{}", result.id, one.name, again), one.unit, one.value});
    }
  }
}

void add_thresholds(const nlohmann::json& document, std::vector<Number>& numbers) {
  const auto thresholds = document.find("thresholds");
  if (thresholds == document.end()) return;
  for (const auto& [member, words] :
       {std::pair("a_up_to_volts", "A up to"), std::pair("b_from_volts", "B from"),
        std::pair("c_seen_from_volts", "C seen from"), std::pair("d_seen_from_volts", "D seen from")}) {
    const auto volts = thresholds->find(member);
    if (volts == thresholds->end() || !volts->is_number()) continue;
    numbers.push_back({fmt::format("bursts, {}, profile {}: {}", document.at("network").get<std::string>(),
                                   document.at("profile").get<std::string>(), words),
                       "V", volts->get<double>()});
  }
}

void add_means(const nlohmann::json& document, std::vector<Number>& numbers) {
  for (const nlohmann::json& series : document.at("series")) {
    for (const nlohmann::json& one : series.at("distributions")) {
      const auto quiet = one.at("phases").find("quiet");
      if (quiet == one.at("phases").end() || !quiet->contains("mean") || !quiet->at("mean").is_number())
        continue;
      numbers.push_back(
          {fmt::format("{}, {}: mean {}", document.at("network").get<std::string>(),
                       series.at("name").get<std::string>(), one.at("quantity").get<std::string>()),
           one.at("unit").get<std::string>(), quiet->at("mean").get<double>()});
    }
  }
}

bool is_of_the_run(const std::string& name) {
  constexpr std::array kOwn = {"results.json", "manifest.json", "timings.json", "configuration.json"};
  return std::ranges::find(kOwn, name) != kOwn.end();
}

std::vector<fs::path> documents_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
    std::error_code unknown;
    const fs::path& path = at->path();
    if (path.extension() == ".json" && at->is_regular_file(unknown) &&
        !is_of_the_run(path.filename().string()))
      files.push_back(path);
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<Number> numbers_of(const fs::path& folder, const Run& run, std::span<const DocumentKind> kinds) {
  std::vector<Number> numbers;
  add_measurements(run, numbers);
  for (const fs::path& file : documents_in(folder)) {
    try {
      const auto document = nlohmann::json::parse(page_document(file, kinds).json, nullptr, true, true);
      const auto schema = document.at("schema").get<std::string>();
      if (schema == "fieldproof/emc/1") add_thresholds(document, numbers);
      if (schema == "fieldproof/measurement/1") add_means(document, numbers);
    } catch (const kernel::Error&) {
      // A PICS, a network, or anything else that a user keeps there.
    }
  }
  return numbers;
}

}  // namespace fieldproof::reports
