#include "fuzz/search/coverage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace fieldproof::fuzz {
namespace {

constexpr std::size_t kOwnCounters = std::size_t{1} << 16U;

// In a function: code may report before the objects of this file are made.
struct Record {
  std::array<std::uint8_t, kOwnCounters> own{};          // of guards and of call sites
  std::vector<std::span<std::uint8_t>> inline_counters;  // in the code itself
  std::vector<std::uint8_t> known;                       // bits of the classes that were seen, by counter
  std::uint32_t guards = 0;
  bool is_used = false;
};

Record& record() {
  static Record one;
  return one;
}

void count(std::size_t place) {
  Record& all = record();
  all.is_used = true;
  std::uint8_t& counter = all.own[place % kOwnCounters];
  if (counter != std::numeric_limits<std::uint8_t>::max()) ++counter;
}

// 1, 2, 3, 4.. 8.. 16.. 32.. 128..: a bit each.
std::uint8_t class_of(std::uint8_t count) {
  constexpr std::array<unsigned, 8> kLeast{1, 2, 3, 4, 8, 16, 32, 128};
  const auto above = std::ranges::upper_bound(kLeast, static_cast<unsigned>(count));
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(above - kLeast.begin() - 1));
}

}  // namespace

bool has_coverage() {
  return record().is_used || !record().inline_counters.empty();
}

void begin_coverage() {
  Record& all = record();
  all.own.fill(0);
  for (const auto& counters : all.inline_counters) std::ranges::fill(counters, std::uint8_t{0});
}

std::size_t take_new_coverage() {
  Record& all = record();
  std::size_t place = 0;
  std::size_t found = 0;
  const auto take = [&](std::span<const std::uint8_t> counters) {
    all.known.resize(std::max(all.known.size(), place + counters.size()));
    for (const std::uint8_t counter : counters) {
      std::uint8_t& known = all.known[place++];
      if (counter == 0 || (known & class_of(counter)) != 0) continue;
      known = static_cast<std::uint8_t>(known | class_of(counter));
      ++found;
    }
  };
  take(all.own);
  for (const auto& counters : all.inline_counters) take(counters);
  return found;
}

}  // namespace fieldproof::fuzz

// What instrumented code calls. The names are the compilers'.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {

void __sanitizer_cov_trace_pc_guard_init(std::uint32_t* start, std::uint32_t* stop);
void __sanitizer_cov_trace_pc_guard(std::uint32_t* guard);
void __sanitizer_cov_8bit_counters_init(std::uint8_t* start, std::uint8_t* stop);
void __sanitizer_cov_pcs_init(const std::uintptr_t* start, const std::uintptr_t* stop);
void __sanitizer_cov_trace_pc();

void __sanitizer_cov_trace_pc_guard_init(std::uint32_t* start, std::uint32_t* stop) {
  for (std::uint32_t* guard = start; guard != stop; ++guard) {
    if (*guard == 0) *guard = ++fieldproof::fuzz::record().guards;
  }
}

void __sanitizer_cov_trace_pc_guard(std::uint32_t* guard) {
  fieldproof::fuzz::count(*guard);
}

void __sanitizer_cov_8bit_counters_init(std::uint8_t* start, std::uint8_t* stop) {
  auto& all = fieldproof::fuzz::record().inline_counters;
  const bool is_known = std::ranges::any_of(all, [&](const auto& one) { return one.data() == start; });
  if (start != stop && !is_known) all.emplace_back(start, stop);
}

void __sanitizer_cov_pcs_init(const std::uintptr_t*, const std::uintptr_t*) {}

void __sanitizer_cov_trace_pc() {
  fieldproof::fuzz::count(reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)));
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier)
