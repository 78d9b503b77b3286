// One program, two ways to look at the same rows: `fieldproof_bench ratios` prints the table of ratios,
// without it Google Benchmark runs with its own options.
#include <benchmark/benchmark.h>

#include <charconv>
#include <iostream>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/ratio_table.hpp"
#include "bench/rows.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::bench {
namespace {

std::vector<Row>& table() {
  static std::vector<Row> rows;
  return rows;
}

template <typename Number>
Number number_of(std::string_view option, std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !(number > Number{0})) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        "\"" + std::string(text) + "\" is no number above zero for " + std::string(option) + ".");
  }
  return number;
}

int print_ratios(std::span<char*> arguments) {
  RatioOptions options;
  bool is_gate = false;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string_view option = arguments[k];
    if (option == "--gate") {
      is_gate = true;
      continue;
    }
    if (k + 1 == arguments.size() || (option != "--rounds" && option != "--seconds" && option != "--only")) {
      throw kernel::Error(
          kernel::ErrorKind::usage,
          "\"" + std::string(option) +
              "\" is not understood; ratios takes --rounds N, --seconds S (of a turn), --only "
              "TEXT (in the group's name) and --gate (exit code 1 when a target is missed).");
    }
    const std::string_view value = arguments[++k];
    if (option == "--rounds") options.rounds = number_of<unsigned>(option, value);
    if (option == "--seconds") options.seconds_per_turn = number_of<double>(option, value);
    if (option == "--only") options.only = value;
  }
  const unsigned missed = print_ratio_table(options, std::cout);
  return is_gate && missed > 0 ? 1 : 0;
}

int run_google_benchmark(int count, char** arguments) {
  for (const Row& row : all_rows()) {
    benchmark::RegisterBenchmark((row.group + "/" + row.name).c_str(),
                                 [make = row.make](benchmark::State& state) {
                                   const Batch batch = make();
                                   std::uint64_t units = 0;
                                   for (auto _ : state) units += batch();
                                   state.SetItemsProcessed(static_cast<std::int64_t>(units));
                                 });
  }
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 64;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace

Rows::Rows(std::vector<Row> rows) {
  table().insert(table().end(), std::make_move_iterator(rows.begin()), std::make_move_iterator(rows.end()));
}

std::vector<Row> all_rows() {
  std::multimap<std::string, Row> by_group;  // keeps the order of equal keys
  for (const Row& row : table()) by_group.emplace(row.group, row);
  std::vector<Row> rows;
  for (auto& [group, row] : by_group) rows.push_back(std::move(row));
  return rows;
}

}  // namespace fieldproof::bench

int main(int count, char** arguments) {
  try {
    if (count > 1 && std::string_view(arguments[1]) == "ratios") {
      return fieldproof::bench::print_ratios({arguments + 2, arguments + count});
    }
    return fieldproof::bench::run_google_benchmark(count, arguments);
  } catch (const fieldproof::kernel::Error& error) {
    std::cerr << error.what() << '\n';
    return error.exit_code();
  }
}
