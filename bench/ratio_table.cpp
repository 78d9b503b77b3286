#include "bench/ratio_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <map>
#include <vector>

#include "bench/rows.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::bench {
namespace {

struct Measured {
  Row row;
  Batch batch;
  double best = 0;  // units per second
  double worst = 0;
};

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void take_turn(Measured& measured, double seconds) {
  const auto time = measured.row.waits ? &clock_seconds : &processor_seconds;
  measured.batch();  // warms caches and predictors after the others' turns
  const double start = time();
  std::uint64_t units = 0;
  double now = start;
  do {
    units += measured.batch();
    now = time();
  } while (now - start < seconds);
  const double rate = static_cast<double>(units) / (now - start);
  measured.best = std::max(measured.best, rate);
  measured.worst = measured.worst == 0 ? rate : std::min(measured.worst, rate);
}

// A chain of dependent multiplications: only the clock of the processor decides how fast it is.
Row calibration_row() {
  return {"calibration", "dependent multiplications", "steps", "", 0, [] {
            return [state = std::uint64_t{1}]() mutable {
              constexpr std::uint64_t kSteps = 200'000;
              for (std::uint64_t step = 0; step < kSteps; ++step) {
                state = state * 0x5851F42D4C957F2D + 0x14057B7EF767814F;
              }
              return kSteps + (state == 0 ? 1U : 0U);
            };
          }};
}

std::vector<Measured> selected(const RatioOptions& options) {
  std::vector<Measured> table = {{calibration_row(), {}, 0, 0}};
  for (Row& row : all_rows()) {
    if (row.group.find(options.only) != std::string::npos) table.push_back({std::move(row), {}, 0, 0});
  }
  if (table.size() == 1) {
    throw kernel::Error(kernel::ErrorKind::usage, "no group of benchmarks contains \"" + options.only +
                                                      "\"; run without --only to see all groups.");
  }
  for (Measured& measured : table) measured.batch = measured.row.make();
  return table;
}

std::string rate_of(double rate, const std::string& unit) {
  constexpr const char* kPrefixes[] = {"", "k", "M", "G", "T", "P"};
  unsigned prefix = 0;
  for (; rate >= 1000 && prefix < 5; ++prefix) rate /= 1000;
  return fmt::format("{:.3g} {} {}/s", rate, kPrefixes[prefix], unit);
}

// The fastest peer of a row, nullptr where there is none (a peer's package may be absent).
const Measured* peer_of(const Measured& measured, const std::vector<Measured>& table) {
  const Measured* fastest = nullptr;
  for (const Measured& other : table) {
    if (other.row.group != measured.row.group || &other == &measured) continue;
    if (!other.row.name.starts_with(measured.row.against)) continue;
    if (fastest == nullptr || other.best > fastest->best) fastest = &other;
  }
  return fastest;
}

// Prints one line; true when the row missed its target.
bool print_line(const Measured& measured, const std::vector<Measured>& table, double slack,
                std::ostream& out) {
  const Row& row = measured.row;
  out << fmt::format("| {} | {} | {} | ", row.group, row.name, rate_of(measured.best, row.unit));
  const Measured* const peer = row.against.empty() ? nullptr : peer_of(measured, table);
  if (peer == nullptr) {
    out << (row.against.empty() ? "| |\n" : "peer not built | |\n");
    return false;
  }
  const double ratio = measured.best / peer->best;
  out << fmt::format("{:.2f} x {} | ", ratio, peer->row.name);
  if (row.target_ratio == 0) {
    out << "|\n";
    return false;
  }
  const bool missed = ratio < row.target_ratio * (1 - slack);
  out << fmt::format("{:.3g} {}|\n", row.target_ratio, missed ? "missed " : "");
  return missed;
}

}  // namespace

unsigned print_ratio_table(const RatioOptions& options, std::ostream& out) {
  std::vector<Measured> table = selected(options);
  for (unsigned round = 0; round < options.rounds; ++round) {
    for (Measured& measured : table) take_turn(measured, options.seconds_per_turn);
  }
  out << "| work | row | best rate | ratio | target |\n|---|---|---|---|---|\n";
  unsigned missed = 0;
  for (const Measured& measured : table) missed += print_line(measured, table, options.slack, out) ? 1U : 0U;
  out << fmt::format(
      "\nBest of {} rounds, rows taking turns, per second of processor time (calls of implementations: of "
      "the clock). The calibration loop's slowest "
      "round "
      "ran at {:.2f} of its best.\n",
      options.rounds, table.front().worst / table.front().best);
  return missed;
}

}  // namespace fieldproof::bench
